//! Every row of some recordings against the reachable set of any model.

use reachtube_reach::ReachSets;
use reachtube_robot::Robot;

use super::deviation::{Grids, suite_deviations};
use super::nonlinear::{Case, Effort, check_outer, flowpipes, lost};
use super::verify::{Row, check_rows};
use super::{Dynamics, Lost, Recordings, Settings, UncertaintySets};
use crate::error::Result;
use reachtube_recordings::DataSet;

/// Hands every row of every suite to `visit`, with the index of the suite; returns where a
/// reachable set was lost.
///
/// # Guarantee
///
/// Those of [`check_rows`] and [`check_outer`].
///
/// # Errors
///
/// Defects of a run that has changed since it was read.
pub(super) fn every_row(
    dynamics: &Dynamics,
    data: &DataSet,
    robot: &Robot,
    settings: &Settings,
    sets: &UncertaintySets,
    recordings: &Recordings,
    mut visit: impl FnMut(usize, Row),
) -> Result<Vec<Lost>> {
    match dynamics {
        Dynamics::Linear(system) => {
            let grids = Grids::new(recordings, system, settings.disturbance)?;
            let reach: Vec<ReachSets> =
                grids.as_slice().iter().map(|grid| grid.reach(sets)).collect();
            for (index, suite) in recordings.suites.iter().enumerate() {
                for deviation in suite_deviations(data, robot, settings, &grids, suite)? {
                    let (grid, reach) = (&grids.as_slice()[deviation.grid], &reach[deviation.grid]);
                    check_rows(grid, reach, sets, settings.states, &deviation, |row| {
                        visit(index, row)
                    });
                }
            }
            Ok(Vec::new())
        }
        Dynamics::Polynomial(model) => {
            let cases = Case::all(data, robot, settings, recordings)?;
            let flowpipes = flowpipes(&model.polynomial_system()?, &cases, sets, Effort::Whole)?;
            for (case, flowpipe) in cases.iter().zip(&flowpipes) {
                check_outer(case, flowpipe, sets, settings.states, |row| visit(case.suite, row));
            }
            Ok(cases
                .iter()
                .zip(&flowpipes)
                .filter_map(|(case, flowpipe)| lost(case, flowpipe))
                .collect())
        }
    }
}
