use std::path::Path;

use crate::claim::claim::Claim;
use crate::data::problem::Problem;
use crate::data::settings::Notion;
use crate::error::Result;
use crate::found::Found;
use crate::linear::smallest_sets as linear;
use crate::progress::Progress;
use crate::search::{cutting_planes, smallest_sets as search, traces};

/// Finds the smallest sets for all recordings of a problem, by one program or by a search.
///
/// # Errors
///
/// As [`conform`](crate::conform).
pub(crate) fn smallest_sets(
    problem: &Problem,
    claim: &dyn Claim,
    progress: &dyn Progress,
    resume: Option<&Path>,
) -> Result<Found> {
    progress.go_on()?;
    match problem.dynamics().linear_system() {
        Some(_) if problem.settings().notion == Notion::Hull => linear::smallest_sets(problem),
        Some(_) if problem.settings().notion == Notion::Trace => {
            traces::smallest_sets(problem, claim, progress)
        }
        Some(_) => cutting_planes::smallest_sets(problem, claim, progress, Ok),
        None if problem.settings().notion == Notion::Trace => {
            traces::smallest_outer_sets(problem, claim, progress, resume)
        }
        None => search::smallest_sets(problem, claim, progress, resume),
    }
}
