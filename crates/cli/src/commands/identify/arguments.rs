use std::path::PathBuf;

use crate::lock_arguments::LockArguments;
use clap::Args;
use reachtube::recordings::{ColumnSettings, Torque};

use crate::option_values::{Choices, choice, seconds};

const HELP: &str = "\
Examples:
  reachtube identify --robot arm.urdf --rest poses --one-joint slow --excitation a.csv b.csv \\
      --validate c.csv --out arm.toml
  reachtube identify --settings arm-identify.toml --report report
  reachtube identify --robot arm.urdf --excitation run.mcap --topic /joint_states
  reachtube identify --robot panda.toml --excitation excitation --torque link --cut-off 6

A settings file holds all of these options and more, see docs/identify.md. Options on the command
line override it.";

/// The torques from which a robot can be identified.
const TORQUES: Choices =
    &[("motor", "at the output side of the gear"), ("link", "from a joint torque sensor")];

/// Identify a robot's gravity, friction and inertia from its recordings
///
/// Recordings are CSV files, folders of them, or logs (.mcap, .db3) with joint states.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long)]
    pub robot: Option<String>,
    #[command(flatten)]
    pub lock: LockArguments,
    /// TOML file with the settings; its paths are relative to its folder
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    /// Recordings of poses at rest
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub rest: Vec<PathBuf>,
    /// Recordings in which one joint at a time moves slowly
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub one_joint: Vec<PathBuf>,
    /// Recordings of exciting motions, for the inertial parameters
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub excitation: Vec<PathBuf>,
    /// Recordings held out of every fit [default: the exciting motions]
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub validate: Vec<PathBuf>,
    /// Topics with joint states in MCAP and rosbag2; several complement each other [default: the
    /// only one that names joints of the robot]
    #[arg(long, hide_short_help = true, value_name = "NAME", num_args = 1..)]
    pub topic: Vec<String>,
    /// Cut-off frequency of the low-pass filter, below half the sample rate, Hz [default: chosen
    /// from the recordings]
    #[arg(long, value_name = "HZ")]
    pub cut_off: Option<f64>,
    /// Factors of the recorded torques, one per joint; for motor currents in N m/A [default: 1]
    #[arg(
        long,
        hide_short_help = true,
        value_name = "G,..",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    pub gains: Vec<f64>,
    /// Longest time between two samples, above 0 s; the input is held over it [default: 1.9 times
    /// the usual sample time, 10 times where sample times jitter]
    #[arg(long, hide_short_help = true, value_name = "SECONDS", value_parser = seconds)]
    pub max_gap: Option<f64>,
    /// Columns of CSV files whose names do not tell, such as q=pos_{},qd=vel_{},tau=m_{},time=t_1;
    /// also rate=100 (Hz) for logs without a time, first=0, time_unit=ms and angle=deg
    #[arg(long, hide_short_help = true, value_name = "KEY=VALUE,..")]
    pub columns: Option<ColumnSettings>,
    /// Meaning of the recorded torques [default: motor, or as in the settings file]
    #[arg(long, value_parser = choice::<Torque>(TORQUES))]
    pub torque: Option<Torque>,
    /// Write the identified robot to this TOML file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Write the URDF with the identified values to this file, with a TOML file beside it
    #[arg(long, value_name = "FILE")]
    pub urdf: Option<PathBuf>,
    /// Write an HTML page with figures to this folder
    #[arg(long, value_name = "FOLDER")]
    pub report: Option<PathBuf>,
}
