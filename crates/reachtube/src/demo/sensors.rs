//! The sensors of the virtual robot: encoders, and the velocity that is computed from them.

use super::rounding::rounded;
use super::unmodelled::{ENCODER_STEP, VELOCITY_FILTER_TIME};
use crate::motion::SAMPLE_TIME;

/// The sensors of n joints.
pub(super) struct Sensors {
    /// Positions at the last sample \[rad\], n.
    q: Vec<f64>,
    /// Filtered velocities at the last sample \[rad/s\], n.
    qd: Vec<f64>,
}

impl Sensors {
    /// Returns sensors that have followed the robot to its start, at position q \[rad\] and
    /// velocity q̇ \[rad/s\].
    pub fn new(q: &[f64], qd: &[f64]) -> Self {
        let before = q.iter().zip(qd).map(|(q, qd)| encoder(q - qd * SAMPLE_TIME));
        Self { q: before.collect(), qd: qd.to_vec() }
    }

    /// Takes a sample at position q \[rad\] and appends the 2n recorded numbers to `states`.
    pub fn record(&mut self, q: &[f64], states: &mut Vec<f64>) {
        let gain = 1.0 - (-SAMPLE_TIME / VELOCITY_FILTER_TIME).exp();
        for ((read, velocity), q) in self.q.iter_mut().zip(&mut self.qd).zip(q) {
            let before = std::mem::replace(read, encoder(*q));
            *velocity += gain * ((*read - before) / SAMPLE_TIME - *velocity);
        }
        states.extend(self.q.iter().chain(&self.qd).copied().map(rounded));
    }
}

/// Returns the position that an encoder reads at position `q`, both \[rad\].
fn encoder(q: f64) -> f64 {
    (q / ENCODER_STEP).round() * ENCODER_STEP
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sensors_follow_a_ramp() {
        let (mut sensors, mut states) = (Sensors::new(&[1.0], &[0.5]), Vec::new());
        for k in 0..100 {
            sensors.record(&[1.0 + 0.5 * SAMPLE_TIME * f64::from(k)], &mut states);
        }
        for (k, state) in states.chunks_exact(2).enumerate() {
            let error = state[0] - 1.0 - 0.5 * SAMPLE_TIME * k as f64;
            assert!(error.abs() <= 0.5 * ENCODER_STEP + 1e-6);
            assert!((state[1] - 0.5).abs() <= ENCODER_STEP / SAMPLE_TIME);
        }
    }
}
