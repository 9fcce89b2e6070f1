//! `reachtube inspect`: what a data set holds.

use std::path::PathBuf;

use clap::Args;
use reachtube::recordings::{DataSet, Group, Inspection, JointSummary, inspect};

use crate::data_arguments::gap_limit;
use crate::error::Result;
use crate::numbers::number;
use crate::option_values::seconds;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::table::{plural, table};

const HELP: &str = "\
Example:
  reachtube inspect --data recordings
  reachtube inspect --data recordings --json";

/// Summarise a data set: its suites, runs, sample times, ranges and drift
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct Arguments {
    /// Folder with runs.csv and the recordings
    #[arg(long, value_name = "FOLDER")]
    pub data: PathBuf,
    /// Longest time between two samples, above 0 s [default: 1.9 times the usual sample time, 10
    /// times where sample times jitter]
    #[arg(long, value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub max_gap: Option<f64>,
}

pub fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let bar = Progress::new();
    let inspection = inspect(&DataSet::open(&args.data)?, gap_limit(args.max_gap))?;
    drop(bar);
    output::notes(&inspection.notes);
    if json {
        output::print_json(&inspection)?;
    } else {
        output::print(&summary(&inspection))?;
    }
    Ok(Outcome::Done)
}

/// The result of `inspect`.
fn summary(inspection: &Inspection) -> String {
    let (runs, joints) = (inspection.runs, inspection.joints);
    let (recordings, of) = (plural(runs, "recording"), plural(joints, "joint"));
    let mut text = format!("{}: {runs} {recordings} of {joints} {of}\n", inspection.folder);
    for group in &inspection.groups {
        text.push('\n');
        text.push_str(&group_words(group));
    }
    text.push_str(LEGEND);
    text
}

const LEGEND: &str = "
start, end: spread of the first and of the last positions over the runs, rad
drift: correlation of the last position with the order of the runs, near +1 or -1 where the robot changes, as it does warming up
sticks: samples slower than 0.01 rad/s
q - int qd: largest difference of q and the integral of qd, rad
";

fn group_words(group: &Group) -> String {
    let [fewest, most] = group.samples;
    let samples = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
    let rate = match group.step {
        _ if most == 1 => String::new(),
        Some(step) => format!(" every {step} s"),
        None => format!(" every {} to {} s", number(group.steps[0]), number(group.steps[1])),
    };
    let kind = if group.suite { "suite" } else { "no suite:" };
    let motion =
        group.motion.as_ref().map_or_else(String::new, |motion| format!(" (motion {motion})"));
    let torque = match group.same_torque {
        _ if group.runs == 1 => "",
        true => ", the same torques in all",
        false => ", torques or times differ",
    };
    let mut text = format!(
        "{kind} {}{motion}: {} {} of {samples} {}{rate}, {:.3} s{torque}\n",
        group.name,
        group.runs,
        plural(group.runs, "run"),
        plural(most, "sample"),
        group.duration
    );
    let row = |(index, joint): (usize, &JointSummary)| {
        vec![
            (index + 1).to_string(),
            format!("[{:.3}, {:.3}]", joint.position[0], joint.position[1]),
            format!("{:.3}", joint.speed),
            format!("{:.2}", joint.torque),
            number(joint.start_spread),
            joint.end_spread.map_or_else(|| "-".into(), number),
            joint.drift.map_or_else(|| "-".into(), |drift| format!("{drift:+.2}")),
            format!("{:.0} %", 100.0 * joint.sticking),
            format!("{:.1e}", joint.integral_gap),
        ]
    };
    let rows: Vec<_> = group.joints.iter().enumerate().map(row).collect();
    let header = [
        "joint",
        "q [rad]",
        "|qd| [rad/s]",
        "|tau| [N m]",
        "start",
        "end",
        "drift",
        "sticks",
        "q - int qd",
    ];
    text.push_str(&table(&header, &rows));
    text
}
