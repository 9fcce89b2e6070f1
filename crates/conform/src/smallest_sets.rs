use std::path::Path;

use crate::error::Result;
use crate::found::Found;
use crate::linear::smallest_sets as linear;
use crate::problem::problem::Problem;
use crate::progress::Progress;
use crate::search::smallest_sets as search;

/// Finds the smallest sets for all recordings of a problem, by one program or by a search.
///
/// # Errors
///
/// As [`conform`](crate::conform).
pub(crate) fn smallest_sets(
    problem: &Problem,
    progress: &dyn Progress,
    resume: Option<&Path>,
) -> Result<Found> {
    match problem.dynamics().linear_system() {
        Some(_) => linear::smallest_sets(problem),
        None => search::smallest_sets(problem, progress, resume),
    }
}
