use std::fmt::Debug;

use reachtube_recordings::Sample;

/// Computes the torque that a motion does not account for, without allocation.
pub trait Residual: Debug + Send + Sync {
    /// Takes a sample with its input (m); returns whether there are enough of them.
    fn take(&mut self, sample: &Sample, input: &[f64]) -> bool;

    /// Forgets all samples.
    fn clear(&mut self);

    /// Returns what was computed last.
    fn torques(&self) -> &Torques;
}

/// What a [`Residual`] computes, for each part.
#[derive(Debug, Clone, Default)]
pub struct Torques {
    /// Velocities in the middle of the time, n.
    pub speed: Vec<f64>,
    /// The torque, n, N m.
    pub torque: Vec<f64>,
    /// The motor torque times the sine and the cosine of the motor's angle, n each, N m.
    pub ripple: [Vec<f64>; 2],
    /// The torque of the weight of 1 kg at the tip, n, N m.
    pub weight: Vec<f64>,
}
