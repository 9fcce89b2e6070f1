//! How well a model predicts the input along the recordings.

use crate::data::case::Case;
use crate::data::correction::InputCorrection;
use crate::data::problem::Problem;
use crate::data::setup::Setup;
use crate::error::Result;
use crate::nominal::corrector::Corrector;

/// Accelerations are differences of velocities over at least this time to both sides, s.
const SPAN: f64 = 0.02;

/// Samples of a case at most: they lie so close that more show nothing new.
const MOST_SAMPLES: usize = 200;

/// Sums over the samples of one case or several.
#[derive(Debug, Clone)]
pub(crate) struct InputError {
    squares: Vec<f64>,
    samples: usize,
}

impl InputError {
    /// Returns the root mean square of the input minus what the robot needs for the recorded
    /// motions, n, N m.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`].
    pub(crate) fn of_problem(problem: &Problem) -> Result<Vec<f64>> {
        let mut all = Self::none(problem.joints());
        for (index, suite) in problem.recordings().suites.iter().enumerate() {
            let of = |case: Case| Self::of_case(problem.setup(), &case);
            let parts = problem.recorded_cases_of(suite, index, problem.differs_by_run(), of)?;
            parts.iter().for_each(|part| all.add(part));
        }
        Ok(all.root_mean_square())
    }

    /// Returns the same for some cases with their recorded inputs.
    ///
    /// # Errors
    ///
    /// When the correction does not fit the robot.
    pub(crate) fn of_cases<'c>(
        setup: &Setup,
        cases: impl IntoIterator<Item = &'c Case>,
    ) -> Result<Vec<f64>> {
        let mut all = Self::none(setup.robot.joint_count());
        for case in cases {
            all.add(&Self::of_case(setup, case)?);
        }
        Ok(all.root_mean_square())
    }

    fn none(joints: usize) -> Self {
        Self { squares: vec![0.0; joints], samples: 0 }
    }

    /// Compares along the middle between the highest and the lowest recording of a case.
    fn of_case(setup: &Setup, case: &Case) -> Result<Self> {
        let (robot, n, times) = (&setup.robot, case.joints(), case.grid.times());
        // The robot's own viscous friction is taken whole, whatever the order of the model.
        let mut correction = setup.correction.clone().unwrap_or_else(|| InputCorrection::none(n));
        correction.joints.iter_mut().for_each(|j| (j.quadratic, j.cubic) = (0.0, 0.0));
        let mut corrector = Corrector::new(robot, &correction, &setup.settings, &case.condition)?;
        let middle =
            |k: usize, i: usize| 0.5 * (case.measured.upper(k, i) + case.measured.lower(k, i));
        let mut sums = Self::none(n);
        let reach = times.partition_point(|t| *t < SPAN).max(1);
        let stride = times.len().div_ceil(MOST_SAMPLES);
        for k in (reach..case.measured.len().saturating_sub(reach)).step_by(stride) {
            let of = |from: usize| -> Vec<f64> { (from..from + n).map(|i| middle(k, i)).collect() };
            let (q, qd) = (of(0), of(n));
            let span = times[k + reach] - times[k - reach];
            let mut u = case.inputs[k * n..(k + 1) * n].to_vec();
            corrector.take_off(&q, &qd, &mut u);
            let qdd: Vec<f64> =
                (n..2 * n).map(|i| (middle(k + reach, i) - middle(k - reach, i)) / span).collect();
            let needed = robot.motion_torque(&q, &qd, &qdd) + robot.viscous_torque(&qd);
            for ((sum, u), needed) in sums.squares.iter_mut().zip(&u).zip(&needed) {
                *sum += (u - needed).powi(2);
            }
            sums.samples += 1;
        }
        Ok(sums)
    }

    fn add(&mut self, other: &Self) {
        let pairs = self.squares.iter_mut().zip(&other.squares);
        pairs.for_each(|(sum, part)| *sum += part);
        self.samples += other.samples;
    }

    fn root_mean_square(self) -> Vec<f64> {
        let count = self.samples.max(1) as f64;
        self.squares.into_iter().map(|sum| (sum / count).sqrt()).collect()
    }
}
