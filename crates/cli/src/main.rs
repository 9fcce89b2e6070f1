//! The command `reachtube`: reads its arguments, calls the library and prints the result.

mod cli;
mod commands;
mod data_arguments;
mod error;
mod expansion;
mod file_names;
mod folded;
mod global;
mod help;
mod lock_arguments;
mod log_files;
mod opened;
mod option_values;
mod outcome;
mod output;
mod progress;
mod reference;
mod report_files;
mod schema;
mod set_files;
mod understood;
mod usage;
mod virtual_robot_arguments;

use std::process::ExitCode;

use crate::outcome::Outcome;

/// Exit code of a result that is not conformant, or not safe.
const NOT_CONFORMANT: u8 = 1;

/// Exit code of an error.
const ERROR: u8 = 2;

/// Exit code of a model that is conformant and vacuous, and of a question that is undecided.
const LEFT_OPEN: u8 = 3;

fn main() -> ExitCode {
    let json = std::env::args().any(|argument| argument == "--json");
    let outcome = usage::parse(&std::env::args_os().collect::<Vec<_>>()).and_then(|arguments| {
        arguments.global.install();
        cli::run(&arguments)
    });
    match outcome {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::NotConformant | Outcome::Unsafe) => ExitCode::from(NOT_CONFORMANT),
        Ok(Outcome::Vacuous | Outcome::Undecided) => ExitCode::from(LEFT_OPEN),
        Err(error::Error::Usage(message)) if !json || !message.use_stderr() => message.exit(),
        Err(error) if json => {
            let (text, kind) = (error.to_string(), error.kind());
            output::json_error(&output::ErrorOutput { error: &text, kind, exit_code: ERROR });
            ExitCode::from(ERROR)
        }
        Err(error) => {
            output::error(&error.to_string());
            ExitCode::from(ERROR)
        }
    }
}
