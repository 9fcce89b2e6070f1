//! Recording of a campaign.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use rayon::prelude::*;
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::Serialize;

use super::folder::{Folder, index_line};
use super::job::Job;
use super::options::CampaignOptions;
use super::plan;
use crate::error::Result;
use crate::virtual_robot::{SuiteRuns, VirtualRobot};

/// What a campaign has recorded.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct RecordedCampaign {
    /// Number of test suites.
    pub suites: usize,
    /// Number of runs of all suites.
    pub runs: usize,
    /// Number of all recordings.
    pub recordings: usize,
    /// Number of recordings that an earlier start of the campaign had written.
    pub kept: usize,
    /// Size of all recordings \[bytes\].
    pub bytes: u64,
    /// Names of the suites to find the sets with.
    #[serde(skip)]
    pub training: Vec<String>,
    /// Names of the suites of other motions, to check the model with.
    #[serde(skip)]
    pub check: Vec<String>,
}

/// Records a campaign of a virtual robot with the nominal model `robot` into `folder`, on all
/// cores. `progress` receives the number of parts that are done, and of all parts.
///
/// The folder is a data set for [`DataSet::open`](reachtube_recordings::DataSet::open). The torque
/// of the test suites is [`Torque::Compensated`](reachtube_recordings::Torque::Compensated), the
/// torque of all other recordings [`Torque::Motor`](reachtube_recordings::Torque::Motor).
///
/// A campaign that was stopped may be started again with the same options: recordings that exist
/// are kept, and the result is the same as without the stop.
///
/// # Errors
///
/// Fails for options and parameters out of range, for a folder with files that this campaign has
/// not written, and where the simulation diverges.
///
/// # Examples
///
/// ```
/// use reachtube_lab::campaign::{CampaignOptions, record};
/// use reachtube_recordings::{DataSet, RunSource};
/// use reachtube_robot::Robot;
///
/// let folder = tempfile::tempdir().unwrap();
/// let few = CampaignOptions { motions: 2, held_out_motions: 1, ..CampaignOptions::small() };
/// let few = CampaignOptions { runs: 2, longest: 0.5, ..few };
/// let options = CampaignOptions { duration: Some(1.0), ..few };
/// let recorded = record(&Robot::lwa4p(), &options, folder.path(), &|_done, _total| ())?;
/// assert_eq!(recorded.training, ["M1a", "M1b"]);
/// assert_eq!(recorded.check, ["M2a", "M2b"]);
/// assert_eq!(DataSet::open(folder.path())?.runs().len(), 8);
/// # Ok::<(), reachtube_lab::Error>(())
/// ```
pub fn record(
    robot: &Robot,
    options: &CampaignOptions,
    folder: &Path,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<RecordedCampaign> {
    options.validate()?;
    let robot = VirtualRobot::new(robot, options.robot.clone())?;
    let folder = Folder::open(folder, &robot, options)?;
    let jobs = plan::jobs(&robot, options);
    let done = AtomicUsize::new(0);
    let recorded = jobs
        .par_iter()
        .map(|job| {
            let recorded = record_job(job, &robot, &folder)?;
            progress(done.fetch_add(1, Relaxed) + 1, jobs.len());
            Ok(recorded)
        })
        .collect::<Result<Vec<_>>>()?;
    let lines: Vec<String> = recorded.iter().flat_map(|job| job.lines.clone()).collect();
    folder.finish(&lines)?;
    let suites: Vec<_> = jobs.iter().filter_map(Job::as_suite).collect();
    let (check, training): (Vec<_>, Vec<_>) = suites.iter().partition(|(_, of)| of.is_held_out);
    let names =
        |suites: Vec<(&SuiteRuns, _)>| suites.iter().map(|(runs, _)| runs.name.clone()).collect();
    Ok(RecordedCampaign {
        suites: suites.len(),
        runs: suites.iter().map(|(runs, _)| runs.scatter.len()).sum(),
        recordings: lines.len(),
        kept: recorded.iter().map(|job| job.kept).sum(),
        bytes: recorded.iter().map(|job| job.bytes).sum(),
        training: names(training),
        check: names(check),
    })
}

/// The recordings of one job.
struct RecordedJob {
    /// Their lines of the index.
    lines: Vec<String>,
    /// Number of recordings that existed.
    kept: usize,
    /// Their size \[bytes\].
    bytes: u64,
}

/// Simulates a job and writes its files, or reads the files that an earlier start has written.
fn record_job(job: &Job, robot: &VirtualRobot, folder: &Folder) -> Result<RecordedJob> {
    let exists = folder.has(job);
    let texts = if exists {
        job.files.iter().map(|file| folder.read(file)).collect::<Result<Vec<_>>>()?
    } else {
        job.record(robot)?
    };
    let mut recorded = RecordedJob { lines: Vec::new(), kept: 0, bytes: 0 };
    for (index, (file, text)) in job.files.iter().zip(&texts).enumerate() {
        folder.write_new(file, text)?;
        recorded.lines.push(index_line(job, index, text));
        recorded.bytes += text.len() as u64;
    }
    recorded.kept = if exists { texts.len() } else { 0 };
    Ok(recorded)
}
