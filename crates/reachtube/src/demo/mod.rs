//! The virtual robot: recordings to try everything on, made in a second or two, with a robot that
//! is not quite its model.
//!
//! The experiment is that of Sec. V-B of the paper. Random point-to-point motions are planned; the
//! input u of eq. (11) along a motion is computed from the nominal model; from several points of
//! the motion (Fig. 3) a run applies it open loop, with gravity and Coulomb friction of the nominal
//! model added, and so drifts off (Fig. 2). Friction of the virtual robot depends on temperature,
//! and the joints warm up from run to run, as in Fig. 4. It has also stiction, torque ripple,
//! heavier links and motors, encoders, and starts that scatter: the constants are in
//! `demo/hidden.rs`, and in the README beside the recordings.

mod drive;
mod folder;
mod hidden;
mod motion;
mod number;
mod plan;
#[cfg(test)]
mod tests;

use std::path::Path;

use rayon::prelude::*;
use reachtube_robot::Robot;

use crate::error::{Error, Result};
use drive::Drive;
use plan::{RunPlan, SuitePlan};

/// Time between samples (250 Hz, as the paper's robot), s.
const SAMPLE_TIME: f64 = 0.004;

/// Suites of a motion are lettered.
const MOST_START_POINTS: usize = 26;

/// Durations of a motion that make sense, s.
const DURATIONS: [f64; 2] = [0.5, 60.0];

/// How much is recorded, and the seed of all that is random.
#[derive(Debug, Clone, PartialEq)]
pub struct DemoOptions {
    /// The same seed gives the same recordings.
    pub seed: u64,
    /// Point-to-point motions, those held out included.
    pub motions: usize,
    /// Of these, the last ones: kept for a check of the model.
    pub held_out_motions: usize,
    /// Points of each motion from which the open loop starts: the suites of the motion.
    pub start_points: usize,
    /// Runs of each suite.
    pub runs: usize,
    /// Duration of a motion, s. Suites last 0.9 of it, or less where they start later.
    pub duration: f64,
}

impl Default for DemoOptions {
    /// 10 motions of 3 s, 2 of them held out, each from 2 points 8 times.
    fn default() -> Self {
        Self { seed: 1, motions: 10, held_out_motions: 2, start_points: 2, runs: 8, duration: 3.0 }
    }
}

/// What was recorded: names of suites, in the order of the index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedDemo {
    /// Suites to identify the uncertainty sets with.
    pub training: Vec<String>,
    /// Suites of other motions, to check the model with.
    pub check: Vec<String>,
    /// Number of runs of all suites.
    pub runs: usize,
}

impl DemoOptions {
    fn validate(&self) -> Result<()> {
        let problem = if self.motions <= self.held_out_motions {
            format!(
                "{} motions of which {} are held out leave none to train with",
                self.motions, self.held_out_motions
            )
        } else if !(1..=MOST_START_POINTS).contains(&self.start_points) {
            format!("{} start points a motion; give 1 to {MOST_START_POINTS}", self.start_points)
        } else if self.runs == 0 {
            "0 runs a suite; give at least 1".into()
        } else if !(DURATIONS[0]..=DURATIONS[1]).contains(&self.duration) {
            format!("motions of {} s; give {} to {} s", self.duration, DURATIONS[0], DURATIONS[1])
        } else {
            return Ok(());
        };
        Err(Error::Setting(format!("demo: {problem}")))
    }
}

/// Records a virtual `robot` into `folder` as a data set for
/// [`DataSet::open`](reachtube_recordings::DataSet::open), on all cores. The torques are
/// [`Torque::Compensated`](reachtube_recordings::Torque::Compensated).
///
/// The hidden effects are of the size of the LWA 4P's; another robot should be like it. Files of an
/// earlier demo in the folder are overwritten.
///
/// # Errors
///
/// [`Error::Setting`] for options that record nothing, for a folder with recordings that are not a
/// demo's, or a robot that the simulation cannot follow; [`Error::Write`].
///
/// # Examples
///
/// ```
/// use reachtube::{recordings::DataSet, demo};
/// use reachtube_robot::Robot;
///
/// let folder = tempfile::tempdir().unwrap();
/// let options = demo::DemoOptions { motions: 2, held_out_motions: 1, runs: 2, duration: 1.0, ..Default::default() };
/// let recorded = demo::record(&Robot::lwa4p(), &options, folder.path())?;
/// assert_eq!((recorded.training, recorded.check), (vec!["M1a".into(), "M1b".into()], vec!["M2a".into(), "M2b".into()]));
/// assert_eq!(DataSet::open(folder.path())?.runs().len(), 8);
/// # Ok::<(), reachtube::Error>(())
/// ```
pub fn record(robot: &Robot, options: &DemoOptions, folder: &Path) -> Result<RecordedDemo> {
    options.validate()?;
    folder::refuse_foreign(folder)?;
    let suites = plan::suites(robot, options);
    let runs: Vec<(&SuitePlan, usize)> = suites
        .iter()
        .flat_map(|suite| (0..suite.runs.len()).map(move |run| (suite, run)))
        .collect();
    let lines = runs
        .par_iter()
        .map(|&(suite, index)| {
            let run = &suite.runs[index];
            folder::write_run(folder, suite, index + 1, run, &simulate(robot, suite, run)?)
        })
        .collect::<Result<Vec<_>>>()?;
    folder::write_index(folder, robot.name(), options.seed, &lines)?;
    let (check, training): (Vec<_>, Vec<_>) = suites.iter().partition(|suite| suite.held_out);
    let names = |suites: Vec<&SuitePlan>| suites.iter().map(|suite| suite.name.clone()).collect();
    Ok(RecordedDemo { training: names(training), check: names(check), runs: runs.len() })
}

/// What the sensors of the virtual robot show during a run, row-major K x 2n.
fn simulate(robot: &Robot, suite: &SuitePlan, run: &RunPlan) -> Result<Vec<f64>> {
    let drive = Drive::new(robot, &run.temperatures)?;
    let states = drive.run(run.q.clone(), run.qd.clone(), &suite.inputs);
    if states.iter().all(|x| x.is_finite()) {
        return Ok(states);
    }
    Err(Error::Setting(format!(
        "demo: the simulation of suite {} of {} diverged; its inertias are too small for the demo's friction, or no physical robot's: take lwa4p",
        suite.name,
        robot.name()
    )))
}
