//! `reachtube inspect`: what a data set holds.

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::recordings::{
    DataSet, Inspection, JointSummary, LoggedOptions, Refusal, RunGroup, Wanted, inspect,
};
use reachtube_files::ErrorKind;
use reachtube_logs::{LogFiles, inspect_logs};
use reachtube_robot::Robot;

use crate::error::{Error, Result};
use crate::lock_arguments::LockArguments;
use crate::log_files::LogArguments;
use crate::option_values::seconds;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::understood::understood;
use reachtube::finding::{Table, Units};
use reachtube::number::{four_decimals, plural};
use reachtube_robot::JointKind;

const HELP: &str = "\
Example:
  reachtube inspect --data recordings
  reachtube inspect --data recordings --json

Exit codes: 0 every recording can be used, 2 some are refused.";

/// Summarise a data set: its suites, runs, sample times, ranges and drift
#[derive(Debug, Args)]
#[command(after_help = HELP, mut_arg("lock", |lock| lock.requires("robot")))]
pub(crate) struct Arguments {
    /// Robot, for the units of its joints [default: revolute joints]
    #[arg(long)]
    pub robot: Option<String>,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Folder with runs.csv and the recordings, a log, or a folder of logs
    #[arg(long, value_name = "PATH")]
    pub data: PathBuf,
    #[command(flatten)]
    pub log: LogArguments,
    /// Longest time between two samples, above 0 s; the input is held over it [default: 1.9 times
    /// the usual sample time, 10 times where sample times jitter]
    #[arg(long, hide_short_help = true)]
    #[arg(value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub max_gap: Option<f64>,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    if is_logs(&args.data) {
        return run_logs(args, json);
    }
    let bar = Progress::of("reading recordings");
    let inspection = inspect(&DataSet::open(&args.data)?, args.max_gap.into());
    drop(bar);
    let kinds = kinds(args, inspection.joints)?;
    output::notes(&inspection.notes);
    output::show(json, &inspection, || summary(&inspection, &kinds))?;
    outcome(inspection)
}

/// Returns whether a path is a log, or a folder of logs without an index.
fn is_logs(path: &Path) -> bool {
    let has_files = || LogFiles::find(path).is_ok_and(|files| !files.is_empty());
    path.is_file() || (path.is_dir() && !path.join("runs.csv").exists() && has_files())
}

/// Summarises logs, and what was understood of each.
fn run_logs(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = args.robot.as_ref().map(|name| args.lock.load_to_identify(name)).transpose()?;
    let axes = robot.as_ref().map(reachtube::axes);
    let columns = args.log.columns.clone().unwrap_or_default();
    let options = LoggedOptions {
        robot: axes.as_deref(),
        joints: &[],
        columns: &columns,
        gains: false,
        wanted: Wanted::AnyTorques,
        gap_limit: args.max_gap.into(),
        until: None,
    };
    let bar = Progress::of("reading logs");
    let found = inspect_logs(&args.data, &options, &args.log.settings())?;
    drop(bar);
    let joints = found.inspection.joints;
    let kinds = robot.as_ref().map_or(vec![JointKind::Revolute; joints], Robot::kinds);
    output::notes(&found.inspection.notes);
    output::show(json, &found, || {
        format!("{}{}", understood(&found.logs), summary(&found.inspection, &kinds))
    })?;
    outcome(found.inspection)
}

fn outcome(inspection: Inspection) -> Result<Outcome> {
    if inspection.refused.is_empty() {
        Ok(Outcome::Done)
    } else {
        let lines: Vec<String> = inspection.refused.iter().map(Refusal::to_string).collect();
        Err(Error::Given(ErrorKind::Recordings, lines.join("\n")))
    }
}

/// Returns the kinds of the recorded joints.
fn kinds(args: &Arguments, joints: usize) -> Result<Vec<JointKind>> {
    let Some(name) = &args.robot else { return Ok(vec![JointKind::Revolute; joints]) };
    let kinds = args.lock.load_to_identify(name)?.kinds();
    if kinds.len() == joints {
        return Ok(kinds);
    }
    Err(Error::setting(format!(
        "robot {name} has {} joints, but the recordings have {joints}; name the robot that was \
         recorded",
        kinds.len()
    )))
}

/// Returns the result of `inspect`, with one table per suite.
fn summary(inspection: &Inspection, kinds: &[JointKind]) -> String {
    let Inspection { folder, runs, joints, .. } = inspection;
    let sound: usize = inspection.groups.iter().map(|group| group.runs).sum();
    let mut text = format!(
        "{folder}: {runs} {} of {joints} {}\n",
        plural(*runs, "recording"),
        plural(*joints, "joint")
    );
    if sound < *runs {
        text += &format!("{} refused, and not counted below\n", runs - sound);
    }
    for group in &inspection.groups {
        text.push_str(&format!("\n{}\n{}", heading(group), joint_table(group, kinds)));
    }
    text.push_str(LEGEND);
    text
}

const LEGEND: &str = "
start, end: spread of the first and of the last positions over the runs [as q]
drift: correlation of the last position with the order of the runs; near +1 or -1 where the robot
  changes from run to run, as it does while it warms up
temp: lowest and highest recorded temperature, if any
sticks: share of the samples slower than 0.01 rad/s or m/s
q - int qd: largest difference between q and the integral of qd [as q]
";

/// Describes the runs of a group in one line.
fn heading(group: &RunGroup) -> String {
    let kind = if group.suite { "suite" } else { "no suite:" };
    let motion =
        group.motion.as_ref().map_or_else(String::new, |motion| format!(" (motion {motion})"));
    let torque = match group.same_torque {
        _ if group.runs == 1 => "",
        true => ", same torques in every run",
        false => ", torques or sample times differ between runs",
    };
    let [first, last] = group.order;
    let order = match group.runs as u64 {
        runs if group.suite && last - first + 1 != runs => {
            format!(", order {first} to {last} with gaps")
        }
        runs if group.suite && first != 1 => format!(", order {first} to {}", first + runs - 1),
        _ => String::new(),
    };
    format!(
        "{kind} {}{motion}: {} {} of {}, {:.3} s{order}{torque}",
        group.name,
        group.runs,
        plural(group.runs, "run"),
        samples(group),
        group.duration
    )
}

/// Describes the number of samples per run and the time between them.
fn samples(group: &RunGroup) -> String {
    let [fewest, most] = group.samples;
    let count = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
    let step = match group.step {
        _ if most == 1 => String::new(),
        Some(step) => format!(" every {step} s"),
        None => format!(
            " every {} to {} s",
            four_decimals(group.steps[0]),
            four_decimals(group.steps[1])
        ),
    };
    format!("{count} {}{step}", plural(most, "sample"))
}

fn joint_table(group: &RunGroup, kinds: &[JointKind]) -> String {
    let units = [JointKind::position_unit, JointKind::velocity_unit, JointKind::force_unit];
    let units = units.map(|unit| JointKind::column(kinds, unit));
    let warm = group.joints.iter().any(|joint| joint.temperature.is_some());
    let [q, qd, tau] = [units[0].head("q"), units[1].head("|qd|"), units[2].head("|tau|")];
    let mut header = vec!["joint", &q, &qd, &tau, "start", "end", "drift", "sticks", "q - int qd"];
    header.extend(warm.then_some("temp [°C]"));
    let row = |(index, joint)| {
        let mut row = joint_row(index, joint, &units);
        row.extend(warm.then(|| temperature(joint)));
        row
    };
    let rows = group.joints.iter().enumerate().map(row);
    Table::new(header, rows.collect()).to_string()
}

fn temperature(joint: &JointSummary) -> String {
    joint.temperature.map_or_else(|| "-".into(), |[low, high]| format!("[{low:.1}, {high:.1}]"))
}

/// Returns a table row about a joint (from 0). `units` has the units of q, q̇ and τ.
fn joint_row(index: usize, joint: &JointSummary, units: &[Units; 3]) -> Vec<String> {
    let [q, qd, tau] = units;
    vec![
        (index + 1).to_string(),
        q.cell(index, format!("[{:.3}, {:.3}]", joint.position[0], joint.position[1])),
        qd.cell(index, format!("{:.3}", joint.speed)),
        tau.cell(index, format!("{:.2}", joint.torque)),
        q.cell(index, four_decimals(joint.start_spread)),
        joint.end_spread.map_or_else(|| "-".into(), |end| q.cell(index, four_decimals(end))),
        joint.drift.map_or_else(|| "-".into(), |drift| format!("{drift:+.2}")),
        format!("{:.0} %", 100.0 * joint.sticking),
        q.cell(index, format!("{:.1e}", joint.integral_gap)),
    ]
}
