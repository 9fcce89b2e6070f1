//! Recording of a demo.

use std::path::Path;

use rayon::prelude::*;
use reachtube_robot::Robot;

use super::data_folder;
use super::error::DemoError;
use super::options::DemoOptions;
use super::plan::{self, RunPlan, SuitePlan};
use super::virtual_robot::VirtualRobot;
use crate::error::Result;

/// The recorded suites by name, in the order of the index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedDemo {
    /// Motions of the training suites that calibrate the sets, by their names.
    pub calibration: Vec<String>,
    /// Suites to identify and calibrate the uncertainty sets with.
    pub training: Vec<String>,
    /// Suites of other motions, to check the model with.
    pub check: Vec<String>,
    /// Number of runs of all suites.
    pub runs: usize,
}

/// Records a virtual `robot` into `folder`, on all cores, as a data set for
/// [`DataSet::open`](reachtube_recordings::DataSet::open).
///
/// The torques are [`Torque::Compensated`](reachtube_recordings::Torque::Compensated). The
/// unmodelled effects have the size of the LWA 4P's, so another robot should be similar to it.
/// Files of an earlier demo in the folder are overwritten.
///
/// # Errors
///
/// Fails with [`DemoError`] for options that record nothing, for a folder with recordings that no
/// demo has written, and for a robot whose simulation diverges. Fails also where a file cannot be
/// written.
///
/// # Examples
///
/// ```
/// use reachtube::demo::{DemoOptions, record};
/// use reachtube::recordings::{DataSet, RunSource};
/// use reachtube_robot::Robot;
///
/// let folder = tempfile::tempdir().unwrap();
/// let few = DemoOptions { motions: 2, held_out_motions: 1, runs: 2, ..Default::default() };
/// let options = DemoOptions { duration: 1.0, ..few };
/// let recorded = record(&Robot::lwa4p(), &options, folder.path())?;
/// assert_eq!(recorded.training, ["M1a", "M1b"]);
/// assert_eq!(recorded.check, ["M2a", "M2b"]);
/// assert_eq!(DataSet::open(folder.path())?.runs().len(), 8);
/// # Ok::<(), reachtube::Error>(())
/// ```
pub fn record(robot: &Robot, options: &DemoOptions, folder: &Path) -> Result<RecordedDemo> {
    options.validate()?;
    data_folder::refuse_foreign(folder)?;
    // Everything random is drawn here, so the order of simulation does not matter.
    let suites = plan::suites(robot, options);
    // Simulation and files of the runs.
    let runs: Vec<(&SuitePlan, usize)> = suites
        .iter()
        .flat_map(|suite| (0..suite.runs.len()).map(move |run| (suite, run)))
        .collect();
    let lines = runs
        .par_iter()
        .map(|&(suite, index)| {
            let run = &suite.runs[index];
            let states = simulate(robot, suite, run, options)?;
            data_folder::write_run(folder, suite, index + 1, run, &states)
        })
        .collect::<Result<Vec<_>>>()?;
    // The index comes last, so a folder that is not finished cannot be opened.
    data_folder::write_index(folder, robot.name(), options, &lines)?;
    let (check, training): (Vec<_>, Vec<_>) = suites.iter().partition(|suite| suite.held_out);
    let names = |suites: Vec<&SuitePlan>| suites.iter().map(|suite| suite.name.clone()).collect();
    let calibrate = suites.iter().filter(|suite| suite.calibrates);
    let mut calibration: Vec<String> = calibrate.map(|suite| suite.motion.clone()).collect();
    calibration.dedup();
    Ok(RecordedDemo {
        calibration,
        training: names(training),
        check: names(check),
        runs: runs.len(),
    })
}

/// Simulates a run and returns what the sensors record, row-major K x 2n, \[rad\] and \[rad/s\].
pub(super) fn simulate(
    robot: &Robot,
    suite: &SuitePlan,
    run: &RunPlan,
    options: &DemoOptions,
) -> Result<Vec<f64>> {
    let plain = VirtualRobot::new(robot, &run.temperatures)?;
    let virtual_robot = if options.stribeck { plain.with_stribeck() } else { plain };
    let states = virtual_robot.run(run.q.clone(), run.qd.clone(), &suite.inputs);
    if states.iter().all(|x| x.is_finite()) {
        return Ok(states);
    }
    let (suite, robot) = (suite.name.clone(), robot.name().to_string());
    Err(DemoError::Diverged { suite, robot }.into())
}
