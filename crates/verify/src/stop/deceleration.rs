use reachtube_robot::Robot;

use crate::stop::path::{Path, feed_forward};

/// The time over which a controller holds a torque, s.
pub(super) const CYCLE: f64 = 0.002;

/// The most cycles of a deceleration: 10 s.
const MOST_CYCLES: f64 = 5000.0;

/// The torques under which a controller slows a robot down along a path, each held for 2 ms: the
/// first part of a stop of category 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Deceleration {
    joints: usize,
    /// Row-major, cycles x n.
    torques: Vec<f64>,
}

impl Deceleration {
    /// Plans a deceleration that leaves a path at the time `from` (s). The speed along the path
    /// falls at a constant rate to 0, in the time in which no joint would decelerate by more than
    /// its `limits` (rad/s²; m/s²) if the path were straight. The torques follow from the robot's
    /// equations with friction, at the middle of each cycle.
    ///
    /// `None` if the path ends before, or the deceleration would take longer than 10 s.
    ///
    /// # Panics
    ///
    /// Panics if path or limits are of another number of joints.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    /// use reachtube_verify::{Deceleration, Path};
    ///
    /// // At 1 rad/s and 4 rad/s² the arm needs 0.25 s, and half of that time of its path.
    /// let path = Path::straight(&[0.0; 6], &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], 0.2);
    /// let found = Deceleration::along(&Robot::lwa4p(), &path, 0.0, &[4.0; 6]).unwrap();
    /// assert!((found.duration() - 0.25).abs() < 0.002);
    /// assert!(Deceleration::along(&Robot::lwa4p(), &path, 0.1, &[4.0; 6]).is_none());
    /// ```
    #[must_use]
    pub fn along(robot: &Robot, path: &Path, from: f64, limits: &[f64]) -> Option<Self> {
        let n = robot.joint_count();
        let [_, speeds, _] = path.at(from);
        assert!(speeds.len() == n && limits.len() == n, "path and limits fit the robot");
        let slowest =
            speeds.iter().zip(limits).map(|(v, a)| v.abs() / a).fold(0.0, f64::max) / CYCLE;
        if slowest.is_nan() || slowest > MOST_CYCLES {
            return None;
        }
        let cycles = slowest.ceil();
        let duration = CYCLE * cycles;
        if from + 0.5 * duration > path.end() {
            return None;
        }
        let torque = |k: usize| {
            let time = CYCLE * (k as f64 + 0.5);
            let left = 1.0 - time / duration;
            let [q, qd, qdd] = path.at(from + time * (1.0 - 0.5 * time / duration));
            let slowed = qd.iter().map(|v| left * v).collect();
            let pairs = qdd.iter().zip(&qd);
            let braked = pairs.map(|(a, v)| left * left * a - v / duration).collect();
            feed_forward(robot, &[q, slowed, braked])
        };
        let torques = (0..cycles as usize).flat_map(torque).collect();
        Some(Self { joints: n, torques })
    }

    /// Returns the time until the robot would stand without any error, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.end_of(self.torques.len() / self.joints)
    }

    /// Returns the torques of each cycle \[N m; N\], row-major, cycles x n.
    #[must_use]
    pub fn torques(&self) -> &[f64] {
        &self.torques
    }

    pub(super) fn end_of(&self, cycles: usize) -> f64 {
        CYCLE * cycles as f64
    }

    pub(super) fn torque(&self, cycle: usize, joint: usize) -> f64 {
        self.torques[cycle * self.joints + joint]
    }
}
