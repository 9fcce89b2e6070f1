//! Names of output files.

use reachtube::conform::SuiteReach;
use reachtube::export::ExportCase;
use reachtube_files::distinct_names;

/// Returns one file name for each reachable set: the suite's name, with the run's where runs have
/// nominal motions of their own. The names are distinct and contain no path separators.
pub(crate) fn of_reach(reach: &[SuiteReach]) -> Vec<String> {
    distinct_names(reach.iter().map(SuiteReach::name), &["", "_tube"])
}

/// Returns one file name for each recording of a system.
pub(crate) fn of_runs(names: impl Iterator<Item = String>) -> Vec<String> {
    distinct_names(names, &[""])
}

/// Returns one folder name for each exported case.
pub(crate) fn of_cases(cases: &[ExportCase]) -> Vec<String> {
    distinct_names(cases.iter().map(|case| case.reach.name()), &[""])
}
