//! The command `reachtube`: reads its arguments, calls the library and prints the result.

mod cli;
mod commands;
mod data_arguments;
mod error;
mod file_names;
mod lock_arguments;
mod opened;
mod option_values;
mod outcome;
mod output;
mod progress;
mod report_files;
mod table;
mod verdict;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

use crate::outcome::Outcome;

/// Exit code of a result that is not conformant.
const NOT_CONFORMANT: u8 = 1;

/// Exit code of an error.
const ERROR: u8 = 2;

fn main() -> ExitCode {
    let arguments = cli::Cli::parse();
    match cli::run(&arguments) {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::NotConformant) => ExitCode::from(NOT_CONFORMANT),
        Err(error) => {
            for line in error.to_string().lines() {
                let _ = writeln!(std::io::stderr(), "error: {line}");
            }
            ExitCode::from(ERROR)
        }
    }
}
