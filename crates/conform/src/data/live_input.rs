use std::fmt::Debug;

use reachtube_recordings::Sample;

/// Evaluates the inputs of samples one by one, without allocation.
pub trait LiveInput: Debug + Send + Sync {
    /// Computes the input at a sample into `input` (m).
    fn evaluate(&mut self, sample: &Sample, input: &mut [f64]);
}
