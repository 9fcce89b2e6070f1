use std::path::PathBuf;

use clap::Args;

use crate::option_values::seconds;

const HELP: &str = "\
Examples:
  robot-driver | reachtube monitor --model model.json
  reachtube monitor --model model.json --step 0.001 --horizon 0.2 --json < run.csv
  robot-driver | reachtube monitor --model model.json --healthy recordings
  robot-driver | reachtube monitor --model arm/model.json
      an arm under its controller: t,r1..rn,q1..qn with commanded and actual positions

Reads samples from standard input, either CSV with the header t,q1..qn,qd1..qdn,tau1..taun or one
JSON object per line: {\"t\":0.1,\"q\":[..],\"qd\":[..],\"tau\":[..]}. Prints a line at once when
a window of the motion leaves the reachable set, and a summary at the end or on Ctrl-C
(docs/monitor.md).

Exit codes: 0 no window or sample left its set, 1 one left its set or an alarm was raised, 2
error.";

/// Watch a running robot: report at once when its motion leaves the model's sets
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Model file, of a linear model or of an arm under its controller
    #[arg(long, value_name = "FILE")]
    pub model: PathBuf,
    /// Time between samples, s [default: the median of the first 16]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub step: Option<f64>,
    /// Length of a window, s [default: as long as the model's recordings were used]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub horizon: Option<f64>,
    /// Time from the beginning of one window to the next, s [default: a quarter of a window]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub every: Option<f64>,
    /// Longest time between two samples, s [default: 1.9 times --step]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub max_gap: Option<f64>,
    /// Folder of at least 2 recordings of healthy motion: raise an alarm, too, for a sudden torque,
    /// a drag or a payload outside its range in them
    #[arg(long, value_name = "FOLDER")]
    pub healthy: Option<PathBuf>,
    /// Take velocities from the filtered positions
    #[arg(long)]
    pub differentiate: bool,
    /// Print how much of the sets is used, and their drift, each time these seconds have passed
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub gauge_every: Option<f64>,
}
