//! `reachtube prepare`: recordings filtered, cut into windows and written as test suites.

use std::path::PathBuf;

use clap::Args;
use reachtube::identify::prepare::{
    LogEntry, PrepareSettings, PreparedLog, RawLog, check_window, cut_off, noise_left, prepare,
    read, windows,
};
use reachtube::recordings::{ColumnSettings, Torque, any_simulated};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{Error, Result};
use crate::lock_arguments::LockArguments;
use crate::option_values::{Choices, choice, hertz, seconds};
use crate::outcome::Outcome;
use crate::output;

const HELP: &str = "\
Example:
  reachtube prepare --robot arm.toml --data repeated --repeats --window 1 --cut-off 6 \\
      --compensate --out windows

Then: reachtube inspect --data windows";

/// The torques that can be compensated.
const TORQUES: Choices = &[
    ("motor", "at the output side of the gear"),
    ("link", "from a joint torque sensor, for a robot without `armature`"),
];

/// Filter recordings, cut them into windows, and write them as test suites
///
/// Sample times are made even, and signals are filtered without delay.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long)]
    pub robot: String,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Recordings: CSV files or folders
    #[arg(long, value_name = "PATH", num_args = 1.., required = true)]
    pub data: Vec<PathBuf>,
    /// Make suites of logs whose names differ only after the last _, aligned in time
    #[arg(long)]
    pub repeats: bool,
    /// Length of the windows, above 0 s [default: whole recordings]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub window: Option<f64>,
    /// Cut-off frequency of the low-pass filter, below half the sample rate, Hz [default: chosen
    /// from the recordings]
    #[arg(long, value_name = "HZ", value_parser = hertz)]
    pub cut_off: Option<f64>,
    /// Factors of the recorded torques, one per joint; for motor currents in N m/A [default: 1]
    #[arg(long, value_name = "G,..", value_delimiter = ',', allow_hyphen_values = true)]
    pub gains: Vec<f64>,
    /// Names of the robot's joints in the order of the columns [default: the robot's order]
    #[arg(long, hide_short_help = true, value_name = "NAME,..", value_delimiter = ',')]
    pub joints: Vec<String>,
    /// Write the input u, less gravity and dry friction, for `--torque compensated`
    #[arg(long)]
    pub compensate: bool,
    /// Meaning of the recorded torques that are compensated [default: motor]
    #[arg(long, value_parser = choice::<Torque>(TORQUES), requires = "compensate")]
    pub torque: Option<Torque>,
    /// Columns of CSV files whose names do not tell, such as q=pos_{},qd=vel_{},tau=m_{},time=t_1;
    /// also rate=100 (Hz) for logs without a time, first=0, time_unit=ms and angle=deg
    #[arg(long, hide_short_help = true, value_name = "KEY=VALUE,..")]
    pub columns: Option<ColumnSettings>,
    /// Longest time between two samples, above 0 s [default: 10 times the usual sample time]
    #[arg(long, hide_short_help = true, value_name = "SECONDS", value_parser = seconds)]
    pub max_gap: Option<f64>,
    /// Folder for the windows and runs.csv
    #[arg(long, value_name = "FOLDER")]
    pub out: PathBuf,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = args.lock.load(&args.robot)?;
    if args.compensate {
        // A robot without masses has no gravity that could be subtracted.
        robot.check_physical()?;
    }
    let settings = settings(args);
    let index = args.out.join("runs.csv");
    output::claim(&index)?;
    let entries: Vec<LogEntry> = args.data.iter().cloned().map(LogEntry::from).collect();
    let raw = read(&entries, std::path::Path::new(""), &robot, &settings)?;
    args.window.map_or(Ok(()), |window| check_window(window, &raw))?;
    let cut_off = cut_off(&raw.iter().collect::<Vec<&RawLog>>(), &settings)?;
    let prepared = prepare(&raw, &settings, cut_off, args.compensate.then_some(&robot))?;
    let mut cut = windows(&prepared.logs, args.window, args.repeats);
    cut.simulated = any_simulated(raw.iter().map(|log| &*log.file));
    cut.noise = noise_left(&raw.iter().collect::<Vec<&RawLog>>(), Some(cut_off));
    let origin = |log: &RawLog| (log.name.clone(), log.run.sha256.clone());
    cut.origins = raw.iter().map(origin).collect();
    if cut.windows.is_empty() {
        return Err(nothing_left(args, &prepared.logs));
    }
    let files: Vec<PathBuf> = cut.file_names().map(|name| args.out.join(name)).collect();
    output::claim_all(&files)?;
    cut.write(&args.out)?;
    let notes: Vec<String> =
        raw.iter().flat_map(|log| [&log.notes[..], &log.moved].concat()).collect();
    output::notes(&[notes, prepared.changes, cut.changes].concat());
    output::note(&format!(
        "wrote {} recordings and runs.csv to {}",
        cut.windows.len(),
        args.out.display()
    ));
    if json {
        output::print_json(&PrepareOutput { cut_off, recordings: cut.windows.len() })?;
    }
    Ok(Outcome::Done)
}

/// The result of `prepare`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PrepareOutput {
    /// Cut-off frequency of the low-pass, Hz.
    cut_off: f64,
    /// Number of recordings that were written.
    recordings: usize,
}

/// Returns the error of windows that no recording fills.
fn nothing_left(args: &Arguments, logs: &[PreparedLog]) -> Error {
    let duration = |log: &PreparedLog| log.len().saturating_sub(1) as f64 * log.step;
    let longest = logs.iter().map(duration).fold(0.0, f64::max);
    Error::setting(match args.window {
        Some(window) => format!(
            "no recording is left: the windows are {window} s long, but the longest prepared \
             recording lasts {longest:.3} s; give a shorter --window"
        ),
        None => "no recording is left: no log has two samples or more; give longer --data".into(),
    })
}

fn settings(args: &Arguments) -> PrepareSettings {
    PrepareSettings {
        gains: args.gains.clone(),
        joints: args.joints.clone(),
        cut_off: args.cut_off,
        max_gap: args.max_gap,
        torque: args.torque,
        columns: args.columns.clone().unwrap_or_default(),
        ..PrepareSettings::default()
    }
}
