//! A recording of the virtual robot, and its file.

use std::fmt::Write as _;

use super::rounding::rounded;

/// Decimals of positions \[rad\], a fiftieth of an encoder step.
const POSITION_DECIMALS: usize = 6;

/// Decimals of velocities \[rad/s\], a hundredth of their noise.
const VELOCITY_DECIMALS: usize = 5;

/// Decimals of temperatures \[°C\], as usual sensors have.
const TEMPERATURE_DECIMALS: usize = 1;

/// The samples of a recording, as the robot logs them: rounded.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Recording {
    /// Number of joints n.
    pub joints: usize,
    /// Positions \[rad\], row-major K x n.
    pub q: Vec<f64>,
    /// Velocities \[rad/s\], row-major K x n.
    pub qd: Vec<f64>,
    /// Torques \[N m\], row-major K x n.
    pub torques: Vec<f64>,
    /// Temperatures of the joints \[°C\], row-major K x n.
    pub temperatures: Vec<f64>,
}

impl Recording {
    pub(crate) fn new(joints: usize, samples: usize) -> Self {
        let room = || Vec::with_capacity(joints * samples);
        Self { joints, q: room(), qd: room(), torques: room(), temperatures: room() }
    }

    pub(crate) fn push(&mut self, q: &[f64], qd: &[f64], torque: &[f64], temperatures: &[f64]) {
        let columns = [
            (&mut self.q, q, POSITION_DECIMALS),
            (&mut self.qd, qd, VELOCITY_DECIMALS),
            (&mut self.temperatures, temperatures, TEMPERATURE_DECIMALS),
        ];
        for (rows, values, decimals) in columns {
            rows.extend(values.iter().map(|x| rounded(*x, decimals)));
        }
        self.torques.extend_from_slice(torque);
    }

    pub(crate) fn len(&self) -> usize {
        self.q.len() / self.joints
    }

    /// Returns whether all values are finite: whether the simulation did not diverge.
    pub(crate) fn is_finite(&self) -> bool {
        [&self.q, &self.qd, &self.torques, &self.temperatures]
            .iter()
            .all(|values| values.iter().all(|x| x.is_finite()))
    }

    /// Returns the recording as CSV with every `stride`-th sample; `sample_time` \[s\] is that
    /// between all samples.
    pub(crate) fn to_csv(&self, sample_time: f64, stride: usize) -> String {
        let n = self.joints;
        let mut text = String::with_capacity(36 * n * (self.len() / stride + 1));
        text.push('t');
        for column in ["q", "qd", "tau", "temp"] {
            (1..=n).for_each(|joint| write!(text, ",{column}{joint}").expect("a string grows"));
        }
        text.push('\n');
        for k in (0..self.len()).step_by(stride) {
            write!(text, "{:.3}", k as f64 * sample_time).expect("a string grows");
            for values in [&self.q, &self.qd, &self.torques, &self.temperatures] {
                for x in &values[k * n..(k + 1) * n] {
                    write!(text, ",{x}").expect("a string grows");
                }
            }
            text.push('\n');
        }
        text
    }
}
