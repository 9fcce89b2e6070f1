use rayon::prelude::*;

use crate::error::Result;
use crate::explain::closest_motion::{Behaviour, ClosestMotion};
use crate::problem::case::Case;
use crate::problem::problem::Problem;
use crate::sets::UncertaintySets;

/// How close a model comes to a recorded run: the largest |recorded - simulated| over all samples
/// and joints of the closest motion found, whose start lies in start + X0 and whose input lies in
/// u_m + U and is held from each sample to the next. The residuals are infinite where the
/// simulation ran away.
///
/// That motion is a witness: the run is explained within these residuals. Nothing is claimed about
/// closer motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Explanation {
    /// The run (index in the source).
    pub run: usize,
    /// The largest residual of a position, rad.
    pub position: f64,
    /// The largest residual of a velocity, rad/s.
    pub velocity: f64,
}

/// Searches for the explanation of each run of each suite, in the order of the recordings, on all
/// cores.
///
/// # Errors
///
/// As [`Problem::run`].
pub fn explain(problem: &Problem, sets: &UncertaintySets) -> Result<Vec<Explanation>> {
    let model = problem.dynamics().polynomials();
    let of = |case: &Case, index: usize| {
        let recorded = problem.run(index)?;
        let found = ClosestMotion::new(model, case, sets, &recorded).run();
        let Behaviour { position, velocity, .. } = found;
        Ok(Explanation { run: index, position, velocity })
    };
    let of_case = |case: &Case| -> Result<Vec<Explanation>> {
        match case.run {
            Some(index) => Ok(vec![of(case, index)?]),
            None => {
                let runs = &problem.recordings().suites[case.suite].runs;
                runs.par_iter().map(|run| of(case, run.index)).collect()
            }
        }
    };
    let parts: Vec<Vec<Explanation>> =
        problem.cases()?.par_iter().map(of_case).collect::<Result<_>>()?;
    Ok(parts.concat())
}
