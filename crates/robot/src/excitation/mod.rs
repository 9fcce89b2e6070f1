//! Motions that make a robot's parameters visible.

mod criterion;
mod fourier;
mod search;
mod shape;

pub use criterion::{Criterion, Quality};
pub use fourier::{FourierTrajectory, MotionSample};

use crate::{BaseParameters, Column, Robot, RobotError};
use criterion::Judge;
use search::{climb, start};
use shape::Shape;

/// What an exciting motion is to be like.
#[derive(Clone, Debug, PartialEq)]
pub struct ExcitationSettings {
    /// Period of the motion \[s\].
    pub period: f64,
    /// Number of harmonics of each joint.
    pub harmonics: usize,
    /// What is made best.
    pub criterion: Criterion,
    /// Whether velocity and acceleration are 0 where the period begins and ends; needs two
    /// harmonics.
    pub from_rest: bool,
    /// Part of the position and velocity limits that is used.
    pub margin: f64,
    /// Highest speed of joints that have no limit \[rad/s\].
    pub speed: f64,
    /// Highest acceleration of each joint, or one for all \[rad/s²\]; none when empty.
    pub acceleration: Vec<f64>,
    /// Standard deviation of each joint's torque \[N m\]; 1 when empty.
    pub torque_noise: Vec<f64>,
    /// Number of searches, each from a random motion.
    pub starts: usize,
    /// Motions tried in each search.
    pub trials: usize,
    /// Seed of the random numbers: one seed, one result.
    pub seed: u64,
}

impl Default for ExcitationSettings {
    /// 10 s, five harmonics, D-optimal, from rest, within 90 % of the limits; four searches of 1500
    /// motions.
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

/// An exciting motion, and how good it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    /// The motion.
    pub trajectory: FourierTrajectory,
    /// How well it shows the base parameters.
    pub quality: Quality,
    /// The same of the random motion that the search began with.
    pub before: Quality,
}

impl Robot {
    /// A periodic motion within the limits that shows the base parameters of these columns best
    /// (Swevers et al. 1997).
    ///
    /// Each joint moves by a Fourier series that is scaled and centred so that it fills its limits;
    /// an evolution strategy ((1+1), Rechenberg's rule for its step) shapes the series, from
    /// several random starts at once. Links may hit each other, the floor, or their cables: only
    /// joint limits are looked at.
    ///
    /// # Guarantee
    ///
    /// Positions, speeds and accelerations are within their limits at all times, not only at
    /// samples, up to rounding: see [`FourierTrajectory::position_range`].
    ///
    /// # Errors
    ///
    /// [`RobotError::Setting`] for settings that allow no motion.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::{Column, ColumnKind, ExcitationSettings, Robot};
    ///
    /// let robot = Robot::load(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/double_pendulum.toml")).unwrap();
    /// let columns = Column::of_joints(2, &ColumnKind::INERTIAL);
    /// let settings = ExcitationSettings { trials: 50, ..Default::default() };
    /// let found = robot.excitation(&columns, &settings).unwrap();
    /// assert!(found.quality.log_determinant >= found.before.log_determinant);
    /// assert_eq!(found.trajectory.samples(100.0).len(), 1001);
    /// ```
    pub fn excitation(
        &self,
        columns: &[Column],
        settings: &ExcitationSettings,
    ) -> Result<Excitation, RobotError> {
        settings.check(self.joint_count())?;
        let base = BaseParameters::of_robot(self, columns);
        let shape = Shape::new(self, settings);
        let search = |k: usize| {
            let mut judge = Judge::new(self, &base, settings);
            let mut value = |x: &[f64]| judge.value(&shape, x);
            let mut random = start(settings.seed, k);
            climb(shape.len(), settings.trials, &mut random, &mut value)
        };
        let climbs = on_all_cores(settings.starts, &search);
        let best =
            climbs.iter().max_by(|a, b| a.value.total_cmp(&b.value).then(b.start.cmp(&a.start)));
        let best = best.expect("there is a start");
        let mut judge = Judge::new(self, &base, settings);
        let mut quality = |x: &[f64]| judge.quality(&shape, x);
        Ok(Excitation {
            before: quality(&climbs[0].origin),
            quality: quality(&best.point),
            trajectory: shape.trajectory(&best.point),
        })
    }
}

/// The results of independent tasks, in their order whatever their number of threads.
fn on_all_cores<T: Send>(count: usize, task: &(impl Fn(usize) -> T + Sync)) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(count);
    let share =
        |first: usize| (first..count).step_by(threads).map(|k| (k, task(k))).collect::<Vec<_>>();
    let mut results: Vec<_> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|first| scope.spawn(move || share(first))).collect();
        workers.into_iter().flat_map(|w| w.join().expect("a task does not panic")).collect()
    });
    results.sort_by_key(|(k, _)| *k);
    results.into_iter().map(|(_, result)| result).collect()
}

impl ExcitationSettings {
    fn check(&self, joints: usize) -> Result<(), RobotError> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let least = if self.from_rest { 2 } else { 1 };
        let fits = |list: &[f64], one: bool| {
            list.is_empty() || list.len() == joints || (one && list.len() == 1)
        };
        let wrong = [
            (!positive(self.period), format!("period = {} s; give a positive time", self.period)),
            (
                self.harmonics < least,
                format!("harmonics = {}; give {least} or more", self.harmonics),
            ),
            (
                !positive(self.margin) || self.margin > 1.0,
                format!("margin = {}; give up to 1", self.margin),
            ),
            (!positive(self.speed), format!("speed = {} rad/s; give a positive one", self.speed)),
            (self.starts == 0 || self.trials == 0, "no starts or trials; give one or more".into()),
            (
                !fits(&self.acceleration, true) || !self.acceleration.iter().all(|a| positive(*a)),
                format!(
                    "acceleration = {:?}; give none, one, or {joints} positive ones",
                    self.acceleration
                ),
            ),
            (
                !fits(&self.torque_noise, false) || !self.torque_noise.iter().all(|s| positive(*s)),
                format!(
                    "torque_noise = {:?}; give none or {joints} positive ones",
                    self.torque_noise
                ),
            ),
        ];
        let first = wrong.into_iter().find(|(is_wrong, _)| *is_wrong);
        first.map_or(Ok(()), |(_, message)| Err(RobotError::Setting(message)))
    }
}
