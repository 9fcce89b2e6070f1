//! Options that name recordings and a model.

use std::path::PathBuf;

use clap::Args;
use reachtube::recordings::Torque;

use crate::error::{Error, Result};
use crate::option_values::{Choices, choice, seconds, trimmed};

// A comment, not a doc comment: clap would show it as the description of the command.
// Options that name recordings and the meaning of their torques.
#[derive(Debug, Args)]
#[command(next_help_heading = "Data")]
pub(crate) struct DataArguments {
    /// Folder with runs.csv, or logs for a model that `model` made
    #[arg(long, value_name = "FOLDER")]
    pub data: PathBuf,
    /// Test suites to use, separated by commas, such as A*,B? [default: all]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', value_parser = trimmed)]
    pub suites: Vec<String>,
    /// Meaning of the recorded torques
    #[arg(long, value_parser = choice::<Torque>(TORQUES))]
    pub torque: Option<Torque>,
    /// Time after the first sample up to which samples are used, above 0 s [default: all]
    #[arg(long, hide_short_help = true)]
    #[arg(value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub until: Option<f64>,
    /// Longest time between two samples, above 0 s; the input is held over it [default: 1.9 times
    /// the usual sample time, 10 times where sample times jitter]
    #[arg(long, hide_short_help = true)]
    #[arg(value_name = "SECONDS", value_parser = seconds, allow_negative_numbers = true)]
    pub max_gap: Option<f64>,
}

impl DataArguments {
    /// Refuses a limit of gaps in logs, of which none is filled.
    pub(crate) fn refuse_gap_of_logs(&self) -> Result<()> {
        self.max_gap.map_or(Ok(()), |_| {
            Err(Error::setting(
                "--max-gap is for runs whose inputs are held over a gap: no window of a log \
                 crosses one; leave it out",
            ))
        })
    }
}

pub(crate) const TORQUES: Choices = &[
    ("compensated", "the input u, without gravity and Coulomb friction"),
    ("motor", "at the output side of the gear"),
    ("link", "from a joint torque sensor"),
];

// Options that name a model and the recordings to compare it with.
#[derive(Debug, Args)]
pub(crate) struct ModelArguments {
    /// Model file that `model` or `conform` wrote
    #[arg(long, value_name = "FILE")]
    pub model: PathBuf,
    #[command(flatten)]
    pub data: DataArguments,
}
