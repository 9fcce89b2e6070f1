//! Evaluation of a model on a motion that was left out of all its steps.

use crate::data::problem::Problem;
use crate::error::{Error, Result};
use crate::fit::fit::fitted_setup;
use crate::fit::group::FitSettings;
use crate::next_motion::allowance::factor_for;
use crate::next_motion::left_out::leave_out;
use crate::next_motion::motions::Motions;
use crate::next_motion::point_gauge::leave_points_out;
use crate::next_motion::without_motion::LeftOut;
use crate::progress::Progress;

/// Fits the nominal model of a linear model, if `settings` select it, and finds the sets without
/// one motion, and compares the motion with these sets: its rows, or its points where the notion
/// asks them. A fit is steered by the rows in any notion.
///
/// The robot of the problem, and the inputs that were computed with it, must not have seen the
/// motion either: identify the robot without it first. The comparison is a description, computed in
/// floating point. It bounds no probability. Returns the factor of `allowance` too, radii of X0 and
/// U, 3n, that encloses the motion once it is added to these sets; `None` if no factor does, and
/// for a notion that asks points.
///
/// # Errors
///
/// [`Error::Fit`] for a motion that is unknown, or that is the only one; as [`fit`](fn@crate::fit)
/// and [`conform`](crate::conform); [`Error::NotLinear`] for a model that is not linear.
pub fn carry_over(
    problem: &Problem,
    motion: &str,
    settings: Option<&FitSettings>,
    allowance: &[f64],
    progress: &dyn Progress,
) -> Result<(LeftOut, Option<f64>)> {
    let motions = Motions::new(problem.recordings());
    let all = motions.distinct();
    if !all.contains(&motion) || all.len() < 2 {
        return Err(Error::Fit(format!(
            "motion \"{motion}\" cannot be left out; the motions of the recordings are {}",
            all.join(", ")
        )));
    }
    let others = problem.with_suites(|suite| motions.of_suite(suite) != motion);
    let setup = match settings {
        Some(settings) => fitted_setup(&others, settings, progress)?,
        None => problem.setup().clone(),
    };
    let problem = problem.with_setup(setup);
    if problem.settings().notion.asks_points() {
        return Ok((leave_points_out(&problem, motion)?, None));
    }
    let (left_out, missing) = leave_out(&problem, motion)?;
    Ok((left_out, missing.and_then(|missing| factor_for(&missing, allowance))))
}
