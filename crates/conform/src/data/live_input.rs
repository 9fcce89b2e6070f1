use std::fmt::Debug;

use reachtube_recordings::Sample;

/// Evaluates the inputs of samples that become known one by one, without allocation.
pub trait LiveInput: Debug + Send + Sync {
    /// Takes the next sample.
    fn take(&mut self, sample: &Sample);

    /// Hands the next sample with its input (m) to `judge`, if it is known: all that are left where
    /// the motion `is_over`. Returns whether it was.
    fn next(&mut self, is_over: bool, judge: &mut dyn FnMut(&Sample, &[f64])) -> bool;

    /// Returns the time by which inputs are late, s.
    fn delay(&self) -> f64;

    /// Returns the number of samples that wait for later ones.
    fn waiting(&self) -> usize;

    /// Forgets all samples.
    fn clear(&mut self);
}
