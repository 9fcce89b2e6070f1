//! Recording of a demo.

use std::path::Path;

use rayon::prelude::*;
use reachtube_robot::Robot;

use super::data_folder;
use super::options::DemoOptions;
use super::plan::{self, SuitePlan};
use crate::error::Result;
use crate::virtual_robot::{PreRecorded, VirtualRobot, record_suite};

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
/// Fails with [`DemoError`](super::DemoError) for options that record nothing and for a folder with
/// recordings that no demo has written, and with
/// [`VirtualRobotError`](crate::virtual_robot::VirtualRobotError) for parameters out of range and
/// for a robot whose simulation diverges. Fails also where a file cannot be written.
///
/// # Examples
///
/// ```
/// use reachtube_lab::demo::{DemoOptions, record};
/// use reachtube_recordings::{DataSet, RunSource};
/// use reachtube_robot::Robot;
///
/// let folder = tempfile::tempdir().unwrap();
/// let few = DemoOptions { motions: 2, held_out_motions: 1, runs: 2, ..Default::default() };
/// let options = DemoOptions { duration: 1.0, ..few };
/// let recorded = record(&Robot::lwa4p(), &options, folder.path())?;
/// assert_eq!(recorded.training, ["M1a", "M1b"]);
/// assert_eq!(recorded.check, ["M2a", "M2b"]);
/// assert_eq!(DataSet::open(folder.path())?.runs().len(), 8);
/// # Ok::<(), reachtube_lab::Error>(())
/// ```
pub fn record(robot: &Robot, options: &DemoOptions, folder: &Path) -> Result<RecordedDemo> {
    options.validate()?;
    let robot = VirtualRobot::new(robot, options.robot.clone())?;
    data_folder::refuse_foreign(folder)?;
    // Everything random is drawn here, so the order of simulation does not matter.
    let suites = plan::suites(&robot, options);
    // Simulation and files of the suites.
    let lines = suites
        .par_iter()
        .map(|suite| {
            let recorded = PreRecorded::new(&robot, &suite.motion);
            let runs = record_suite(&robot, &suite.motion, &recorded, &suite.runs)?;
            data_folder::write_suite(folder, suite, &runs)
        })
        .collect::<Result<Vec<_>>>()?
        .concat();
    // The index comes last, so a folder that is not finished cannot be opened.
    data_folder::write_index(folder, &robot, options, &lines)?;
    let (check, training): (Vec<_>, Vec<_>) = suites.iter().partition(|suite| suite.held_out);
    let names =
        |suites: Vec<&SuitePlan>| suites.iter().map(|suite| suite.runs.name.clone()).collect();
    let calibrate = suites.iter().filter(|suite| suite.calibrates);
    let mut calibration: Vec<String> = calibrate.map(|suite| suite.motion_name.clone()).collect();
    calibration.dedup();
    Ok(RecordedDemo {
        calibration,
        training: names(training),
        check: names(check),
        runs: lines.len(),
    })
}
