//! `reachtube convert`: logs cut into runs and written as a data set.

use std::path::PathBuf;

use clap::Args;
use reachtube::finding::Table;
use reachtube::number::four_decimals;
use reachtube::recordings::LogSettings;
use reachtube_logs::{
    Cut, Cutting, Intervals, Log, LogOptions, Loss, RecordedRun, Repeats, convert, find_repeats,
};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Result;
use crate::lock_arguments::LockArguments;
use crate::log_files::{TIMES, log_time, read_log};
use crate::option_values::{explained, seconds, speed};
use crate::outcome::Outcome;
use crate::output;

const HELP: &str = "\
Examples:
  reachtube convert --robot arm.urdf --data run.mcap --out recordings
      one run for each log
  reachtube convert --robot arm.urdf --data bag --intervals runs.csv --out recordings
      runs by a list of times, from the folder of a rosbag2 bag
  reachtube convert --robot lwa4p --data day.mcap --marker /run --out recordings
      runs while /run is not empty; its text is the suite
  reachtube convert --robot lwa4p --data day.mcap --repeats --out recordings
      one run for each motion between rests; motions that repeat are suites
  reachtube convert --robot lwa4p --data cut-off.mcap --recover --out recordings
      what is whole in a damaged log

Then: reachtube inspect --data recordings

docs/logs.md describes what is read and what is refused.";

/// Cut robot logs (MCAP, rosbag2) into runs, and write them as a data set
///
/// Reads sensor_msgs/msg/JointState: position, velocity and effort. Joints are matched by name.
/// Without --intervals, --marker and --repeats, each log is one run.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long)]
    pub robot: String,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Logs: MCAP files, .db3 files, or folders of rosbag2
    #[arg(long, value_name = "PATH", num_args = 1.., required = true)]
    pub data: Vec<PathBuf>,
    /// Topics with joint states in MCAP and rosbag2; several complement each other [default: the
    /// only one that names joints of the robot]
    #[arg(long, value_name = "NAME", num_args = 1..)]
    pub topic: Vec<String>,
    /// Names of the joints in MCAP and rosbag2, in the robot's order [default: the robot's names]
    #[arg(long, hide_short_help = true, value_name = "NAME,..", value_delimiter = ',')]
    pub joints: Vec<String>,
    /// CSV file with one run per line: start,end in s from the log's first sample, or
    /// start_stamp,end_stamp; suite, motion and log may follow
    #[arg(long, value_name = "FILE", conflicts_with = "marker")]
    pub intervals: Option<PathBuf>,
    /// Topic that marks runs while it is not empty, true or not 0: a String or Int32, whose value
    /// is the suite, or a Bool
    #[arg(long, value_name = "NAME")]
    pub marker: Option<String>,
    /// Make suites of runs that repeat one motion
    #[arg(long)]
    pub repeats: bool,
    /// Speed below which a joint rests, above 0 rad/s or m/s
    #[arg(long, hide_short_help = true)]
    #[arg(value_name = "SPEED", value_parser = speed, default_value = "0.01", requires = "repeats")]
    pub rest_speed: f64,
    /// Times of the samples
    #[arg(long, hide_short_help = true)]
    #[arg(value_name = "TIMES", value_parser = explained(TIMES), default_value = "header")]
    pub time: String,
    /// Read what is whole in a damaged log, and print what is lost
    #[arg(long)]
    pub recover: bool,
    /// Longest time between two samples, above 0 s; the input is held over it [default: 1.9 times
    /// the usual sample time, 10 times where sample times jitter]
    #[arg(long, hide_short_help = true, value_name = "SECONDS", value_parser = seconds)]
    pub max_gap: Option<f64>,
    /// Folder for the recordings and runs.csv
    #[arg(long, value_name = "FOLDER")]
    pub out: PathBuf,
}

/// The result of `convert`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ConvertOutput<'a> {
    /// The recordings written, in the order of runs.csv.
    recordings: &'a [RecordedRun],
    /// Suites of repeated motions that were found; null without --repeats.
    repeats: Option<&'a [Repeats]>,
    /// Parts of the logs that could not be read, with --recover.
    lost: Vec<&'a Loss>,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let options = options(args)?;
    output::claim(&args.out.join("runs.csv"))?;
    let intervals = args.intervals.as_deref().map(Intervals::read).transpose()?;
    let logs: Vec<Log> =
        args.data.iter().map(|path| read_log(path, &options)).collect::<Result<_>>()?;
    let mut cuts = match &intervals {
        Some(intervals) => intervals.runs(&logs)?,
        None if args.marker.is_some() => Cutting::Marked.runs(&logs)?,
        None if args.repeats => Cutting::Motions(args.rest_speed).runs(&logs)?,
        None => Cutting::Whole.runs(&logs)?,
    };
    let found = repeats(args, &logs, &mut cuts);
    let recorded = convert(&logs, &cuts, args.max_gap.into())?;
    output::claim_all(&recorded.files(&args.out))?;
    let written = recorded.write(&args.out)?;
    output::note(&format!(
        "wrote {} recordings and runs.csv to {}",
        written.len(),
        args.out.display()
    ));
    let lost: Vec<_> = logs.iter().flat_map(Log::losses).collect();
    let result = ConvertOutput { recordings: &written, repeats: found.as_deref(), lost };
    output::show(json, &result, || summary(&written, found.as_deref()))?;
    Ok(Outcome::Done)
}

fn options(args: &Arguments) -> Result<LogOptions> {
    let robot = args.lock.load(&args.robot)?;
    let names: Vec<String> = robot.joints().iter().map(|joint| joint.name.clone()).collect();
    let settings = LogSettings {
        topic: args.topic.clone(),
        joints: args.joints.clone(),
        marker: args.marker.clone(),
        time: log_time(Some(&args.time)),
    };
    Ok(LogOptions { recover: args.recover, ..LogOptions::new(&settings, &names)? })
}

/// Groups runs that repeat a motion, if requested.
fn repeats(args: &Arguments, logs: &[Log], cuts: &mut [Cut]) -> Option<Vec<Repeats>> {
    // Runs that were named by times or markers stay where they are.
    let align = args.intervals.is_none() && args.marker.is_none();
    let found = args.repeats.then(|| find_repeats(logs, cuts, align))?;
    let single = cuts.iter().filter(|cut| cut.suite.is_none()).count();
    if single > 0 {
        output::warn(&format!(
            "{single} of {} runs repeat no other and have no suite; assign them in runs.csv if \
                they belong to one",
            cuts.len()
        ));
    }
    Some(found)
}

fn summary(written: &[RecordedRun], found: Option<&[Repeats]>) -> String {
    let mut suites: Vec<(&str, Vec<&RecordedRun>)> = vec![];
    for run in written {
        let name = run.suite.as_deref().unwrap_or("(no suite)");
        match suites.iter_mut().find(|(known, _)| *known == name) {
            Some((_, runs)) => runs.push(run),
            None => suites.push((name, vec![run])),
        }
    }
    let row = |(name, runs): &(&str, Vec<&RecordedRun>)| {
        let durations = runs.iter().map(|run| run.duration);
        vec![
            (*name).into(),
            runs.len().to_string(),
            runs.iter().map(|run| run.samples).sum::<usize>().to_string(),
            format!("{:.3}", durations.clone().fold(f64::INFINITY, f64::min)),
            format!("{:.3}", durations.fold(0.0, f64::max)),
        ]
    };
    let header = ["suite", "runs", "samples", "shortest [s]", "longest [s]"];
    let mut text = Table::new(header, suites.iter().map(row).collect()).to_string();
    if let Some(found) = found.filter(|found| !found.is_empty()) {
        text += &format!("\n{}{LEGEND}", repeats_table(found));
    }
    text
}

const LEGEND: &str = "
correlation: lowest one of a run's velocities with the first run's; 1 for equal velocities
start: largest difference of a first position from the first run's [rad or m]
lag: largest time by which a run lags behind the first or leads
";

fn repeats_table(found: &[Repeats]) -> String {
    let row = |repeats: &Repeats| {
        vec![
            repeats.suite.clone(),
            repeats.runs.to_string(),
            format!("{:.4}", repeats.correlation),
            four_decimals(repeats.start_spread),
            format!("{:.4}", repeats.lag),
        ]
    };
    let header = ["repeated motion", "runs", "correlation", "start", "lag [s]"];
    Table::new(header, found.iter().map(row).collect()).to_string()
}
