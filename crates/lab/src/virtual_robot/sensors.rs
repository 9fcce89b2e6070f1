//! The sensors of the virtual robot: encoders, and the velocity that is computed from them.

use super::elementary::exp;
use super::parameters::VirtualRobotParameters;
use crate::motion::SAMPLE_TIME;

/// The sensors of n joints.
pub(super) struct Sensors {
    encoder_step: f64,
    /// Part of a new difference that the filter takes over in a cycle \[-\].
    gain: f64,
    /// Positions at the last cycle \[rad\], n.
    pub q: Vec<f64>,
    /// Filtered velocities at the last cycle \[rad/s\], n.
    pub qd: Vec<f64>,
}

impl Sensors {
    /// Returns the sensors of an arm that has rested at `q` \[rad\].
    pub(super) fn at_rest(parameters: &VirtualRobotParameters, q: &[f64]) -> Self {
        let encoder_step = parameters.encoder_step;
        let gain = 1.0 - exp(-SAMPLE_TIME / parameters.velocity_filter_time);
        let read = q.iter().map(|q| encoder(*q, encoder_step)).collect();
        Self { encoder_step, gain, q: read, qd: vec![0.0; q.len()] }
    }

    /// Takes a measurement at position `q` \[rad\], one cycle after the last one.
    pub(super) fn measure(&mut self, q: &[f64]) {
        for ((read, velocity), q) in self.q.iter_mut().zip(&mut self.qd).zip(q) {
            let before = std::mem::replace(read, encoder(*q, self.encoder_step));
            *velocity += self.gain * ((*read - before) / SAMPLE_TIME - *velocity);
        }
    }
}

/// Returns the position that an encoder reads at position `q`, both \[rad\].
fn encoder(q: f64, step: f64) -> f64 {
    (q / step).round() * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sensors_follow_a_ramp_with_the_lag_of_the_filter() {
        let parameters = VirtualRobotParameters::default();
        let step = parameters.encoder_step;
        let mut sensors = Sensors::at_rest(&parameters, &[1.0]);
        for k in 1..100 {
            let q = 1.0 + 0.5 * SAMPLE_TIME * f64::from(k);
            sensors.measure(&[q]);
            assert!((sensors.q[0] - q).abs() <= 0.5 * step + 1e-12);
            let steps = sensors.q[0] / step;
            assert!((steps - steps.round()).abs() < 1e-9, "{steps} steps");
            let lag = 0.5 * (-SAMPLE_TIME * f64::from(k) / 0.01).exp();
            assert!((sensors.qd[0] - 0.5 + lag).abs() <= step / SAMPLE_TIME);
        }
        // A finer encoder gives the filtered velocity alone.
        let fine = VirtualRobotParameters { encoder_step: 1e-9, ..parameters };
        let mut sensors = Sensors::at_rest(&fine, &[0.0]);
        sensors.measure(&[0.5 * SAMPLE_TIME]);
        assert!((sensors.qd[0] - 0.5 * (1.0 - (-0.4f64).exp())).abs() < 1e-6);
    }
}
