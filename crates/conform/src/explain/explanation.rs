use rayon::prelude::*;

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::explain::closest_motion::{Behaviour, Closeness, ClosestMotion, run_together};
use crate::explain::regulate::TOGETHER;
use crate::sets::UncertaintySets;

/// One unit of position, rad, and of velocity, rad/s, in which the largest residual is minimised.
/// They are about the uncertainty of recordings: recordings of the LWA 4P differ by up to 0.0003
/// rad between q and the integral of q̇, and q̇ by up to 0.009 rad/s from a local parabola.
const UNITS: [f64; 2] = [1e-3, 1e-2];

/// Residuals below this many units are not made smaller.
const ENOUGH: f64 = 1e-5;

/// How close a model comes to a recorded run: the largest |recorded - simulated| over all samples
/// and joints of the closest motion found, whose start lies in start + X0 and whose input lies in
/// u_m + U and is held from each sample to the next; for a constant disturbance it is u_m and one
/// disturbance in U, held throughout. The residuals are infinite where the simulation ran away.
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
    explain_some(problem, sets, |_| true)
}

/// Does what [`explain`] does for some runs, given by their indices in the source.
pub(crate) fn explain_some(
    problem: &Problem,
    sets: &UncertaintySets,
    is_chosen: impl Fn(usize) -> bool + Sync,
) -> Result<Vec<Explanation>> {
    let (model, n) = (problem.dynamics().polynomials(), problem.joints());
    let disturbance = problem.settings().disturbance;
    let units = UNITS.map(|unit| vec![unit; n]).concat();
    let closeness = Closeness { units: &units, enough: ENOUGH };
    let of_runs = |case: &Case, indices: &[usize]| {
        let recorded = indices.iter().map(|index| problem.run(*index));
        let recorded = recorded.collect::<Result<Vec<_>>>()?;
        let search = |run| ClosestMotion::new(model, case, sets, disturbance, run, closeness);
        let searches: Vec<ClosestMotion> = recorded.iter().map(|run| search(&**run)).collect();
        let explained = indices.iter().zip(run_together(&searches)).map(|(run, found)| {
            let Behaviour { position, velocity, .. } = found;
            Explanation { run: *run, position, velocity }
        });
        Ok(explained.collect::<Vec<_>>())
    };
    let of_case = |case: &Case| -> Result<Vec<Explanation>> {
        let runs: Vec<usize> = match case.run {
            Some(index) => vec![index],
            None => {
                let runs = problem.recordings().suites[case.suite].every_run()?;
                runs.iter().map(|run| run.index).collect()
            }
        };
        let chosen: Vec<usize> = runs.into_iter().filter(|index| is_chosen(*index)).collect();
        let together = chosen.par_chunks(TOGETHER).map(|indices| of_runs(case, indices));
        Ok(together.collect::<Result<Vec<_>>>()?.concat())
    };
    let parts: Vec<Vec<Explanation>> =
        problem.cases()?.par_iter().map(of_case).collect::<Result<_>>()?;
    Ok(parts.concat())
}
