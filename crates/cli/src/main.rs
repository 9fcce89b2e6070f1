//! The command `reachtube`: arguments in, library calls, words out.

mod args;
mod commands;
mod identified;
mod numbers;
mod output;
mod progress;
mod words;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

/// Exit code for a result that is not conformant.
const NOT_CONFORMANT: u8 = 1;

/// Exit code for an error.
const ERROR: u8 = 2;

fn main() -> ExitCode {
    let arguments = args::Cli::parse();
    match commands::run(&arguments) {
        Ok(commands::Outcome::Done) => ExitCode::SUCCESS,
        Ok(commands::Outcome::NotConformant) => ExitCode::from(NOT_CONFORMANT),
        Err(error) => {
            for line in error.to_string().lines() {
                let _ = writeln!(std::io::stderr(), "error: {line}");
            }
            ExitCode::from(ERROR)
        }
    }
}
