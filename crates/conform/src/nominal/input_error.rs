//! Error of the input that a model predicts along the recordings.

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::data::setup::Setup;
use crate::error::Result;

/// Sums over the samples of one case or several.
#[derive(Debug, Clone)]
pub(crate) struct InputError {
    squares: Vec<f64>,
    samples: usize,
}

impl InputError {
    /// Returns the root mean square of the input minus what the recorded motions need, m.
    pub(crate) fn of_problem(problem: &Problem) -> Result<Vec<f64>> {
        let mut all = Self::none(problem.inputs());
        for (index, suite) in problem.recordings().suites.iter().enumerate() {
            let of = |case: Case| Self::of_case(problem.setup(), &case);
            let parts = problem.recorded_cases_of(suite, index, problem.differs_by_run(), of)?;
            parts.iter().for_each(|part| all.add(part));
        }
        Ok(all.root_mean_square())
    }

    pub(crate) fn of_cases<'c>(
        setup: &Setup,
        cases: impl IntoIterator<Item = &'c Case>,
    ) -> Result<Vec<f64>> {
        let mut all = Self::none(setup.dynamics.inputs());
        for case in cases {
            all.add(&Self::of_case(setup, case)?);
        }
        Ok(all.root_mean_square())
    }

    fn none(inputs: usize) -> Self {
        Self { squares: vec![0.0; inputs], samples: 0 }
    }

    fn of_case(setup: &Setup, case: &Case) -> Result<Self> {
        let (squares, samples) = setup.drive.input_error(case)?;
        Ok(Self { squares, samples })
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
