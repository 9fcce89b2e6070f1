//! Settings of the optimisation of exciting motions.

use crate::error::RobotError;

/// The quality that is optimised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Criterion {
    /// D-optimality: the smallest confidence ellipsoid. The units of the parameters do not matter.
    #[default]
    LogDeterminant,
    /// The smallest condition number of the base regressor, with columns of unit length.
    Condition,
}

/// Settings of an exciting motion and its optimisation.
#[derive(Clone, Debug, PartialEq)]
pub struct ExcitationSettings {
    /// Period of the motion \[s\].
    pub period: f64,
    /// Number of harmonics per joint.
    pub harmonics: usize,
    /// Quality that is optimised.
    pub criterion: Criterion,
    /// Whether velocity and acceleration are 0 at the start and end of the period, which needs at
    /// least two harmonics.
    pub from_rest: bool,
    /// Fraction of the position and velocity limits that the motion may use, up to 1.
    pub margin: f64,
    /// Highest speed \[rad/s; m/s\] of joints without a velocity limit.
    pub speed: f64,
    /// Highest acceleration \[rad/s²; m/s²\]: one entry per joint, one for all joints, or empty for
    /// no limit.
    pub acceleration: Vec<f64>,
    /// Standard deviation of the torque noise \[N m; N\]: one entry per joint, or empty for 1.
    pub torque_noise: Vec<f64>,
    /// Number of searches, each of which starts at a random motion.
    pub starts: usize,
    /// Number of motions that each search evaluates.
    pub trials: usize,
    /// Seed of the random numbers; the same seed gives the same result.
    pub seed: u64,
}

impl Default for ExcitationSettings {
    /// Returns settings for a D-optimal motion of 10 s from rest, with five harmonics, within 90 %
    /// of the limits, by four searches of 1500 motions.
    fn default() -> Self {
        Self {
            period: 10.0,
            harmonics: 5,
            criterion: Criterion::LogDeterminant,
            from_rest: true,
            margin: 0.9,
            speed: 1.0,
            acceleration: Vec::new(),
            torque_noise: Vec::new(),
            starts: 4,
            trials: 1500,
            seed: 1,
        }
    }
}

impl ExcitationSettings {
    /// Checks the settings for a robot with this number of joints.
    pub(super) fn check(&self, joints: usize) -> Result<(), RobotError> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let least = if self.from_rest { 2 } else { 1 };
        let fits = |list: &[f64], one_for_all: bool| {
            list.is_empty() || list.len() == joints || (one_for_all && list.len() == 1)
        };
        // Name, whether it is wrong, value, problem, and what is allowed.
        let checks = [
            (
                "period",
                !positive(self.period),
                format!("{} s", self.period),
                "is not positive",
                "a positive time".into(),
            ),
            (
                "harmonics",
                self.harmonics < least,
                self.harmonics.to_string(),
                "is too few",
                format!("{least} or more"),
            ),
            (
                "margin",
                !positive(self.margin) || self.margin > 1.0,
                self.margin.to_string(),
                "is outside (0, 1]",
                "a positive number up to 1".into(),
            ),
            (
                "speed",
                !positive(self.speed),
                self.speed.to_string(),
                "is not positive",
                "a positive speed".into(),
            ),
            ("starts", self.starts == 0, "0".into(), "allows no search", "1 or more".into()),
            ("trials", self.trials == 0, "0".into(), "allows no search", "1 or more".into()),
            (
                "acceleration",
                !fits(&self.acceleration, true) || !self.acceleration.iter().all(|a| positive(*a)),
                format!("{:?}", self.acceleration),
                "does not fit",
                format!("no limit, one for all joints, or {joints}, all positive"),
            ),
            (
                "torque_noise",
                !fits(&self.torque_noise, false) || !self.torque_noise.iter().all(|s| positive(*s)),
                format!("{:?}", self.torque_noise),
                "does not fit",
                format!("no standard deviation or {joints}, all positive"),
            ),
        ];
        let first = checks.into_iter().find(|(_, is_wrong, ..)| *is_wrong);
        first.map_or(Ok(()), |(setting, _, value, problem, range)| {
            Err(RobotError::Setting { setting, value, problem, range })
        })
    }
}
