//! Optimisation of exciting motions.

use super::evaluation::{Evaluator, Quality};
use super::evolution::{maximise, search_start};
use super::fourier::FourierTrajectory;
use super::search_space::SearchSpace;
use super::settings::ExcitationSettings;
use crate::base_parameters::base::BaseParameters;
use crate::error::RobotError;
use crate::parameter::Parameter;
use crate::robot::Robot;

/// An exciting motion and its quality.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    /// The motion.
    pub trajectory: FourierTrajectory,
    /// Quality of the motion.
    pub quality: Quality,
    /// Quality of the random motion at which the first search started.
    pub initial_quality: Quality,
}

impl Robot {
    /// Optimises a periodic motion within the limits that identifies the base parameters of the
    /// given parameters (Swevers et al. 1997).
    ///
    /// Each joint follows a Fourier series that is scaled and centred within its limits. A (1+1)
    /// evolution strategy with Rechenberg's rule for the step optimises the series, from several
    /// random starts in parallel. Only joint limits are considered: links may hit each other, the
    /// floor or cables.
    ///
    /// # Guarantee
    ///
    /// Up to rounding, positions, speeds and accelerations are within their limits at all times,
    /// not only at samples: see `FourierTrajectory::position_range`.
    ///
    /// # Errors
    ///
    /// Returns [`RobotError::Setting`] if a setting is outside its range.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::{ExcitationSettings, Parameter, ParameterKind, Robot};
    ///
    /// let text = include_str!("../../examples/double_pendulum.toml");
    /// let robot = Robot::from_toml(text, "double pendulum").unwrap();
    /// let parameters = Parameter::of_joints(2, &ParameterKind::INERTIAL);
    /// let settings = ExcitationSettings { trials: 50, ..Default::default() };
    /// let found = robot.excitation(&parameters, &settings).unwrap();
    /// assert!(found.quality.log_determinant >= found.initial_quality.log_determinant);
    /// assert_eq!(found.trajectory.samples(100.0).len(), 1001);
    /// ```
    pub fn excitation(
        &self,
        parameters: &[Parameter],
        settings: &ExcitationSettings,
    ) -> Result<Excitation, RobotError> {
        settings.check(self.joint_count())?;
        let base = BaseParameters::of_robot(self, parameters);
        let space = SearchSpace::new(self, settings);
        let search = |k: usize| {
            let mut evaluator = Evaluator::new(self, &base, settings);
            let mut value = |x: &[f64]| evaluator.value(&space, x);
            let mut start = search_start(settings.seed, k);
            maximise(space.len(), settings.trials, &mut start, &mut value)
        };
        let results = on_all_cores(settings.starts, &search);
        let best =
            results.iter().max_by(|a, b| a.value.total_cmp(&b.value).then(b.search.cmp(&a.search)));
        let best = best.expect("the settings have at least one start");
        let mut evaluator = Evaluator::new(self, &base, settings);
        let mut quality = |x: &[f64]| evaluator.quality(&space, x);
        Ok(Excitation {
            initial_quality: quality(&results[0].origin),
            quality: quality(&best.point),
            trajectory: space.trajectory(&best.point),
        })
    }
}

/// Runs independent tasks in parallel and returns their results in order, which does not depend on
/// the number of threads.
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
