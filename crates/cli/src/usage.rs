//! The command line as it was typed, and its errors.

use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ArgMatches, Command, FromArgMatches};

use crate::cli::Cli;
use crate::error::{Error, Result};
use crate::help;

/// Choices of `model` that its settings name, and no option.
const CHOICES: &[&str] = &[
    "cut-off",
    "identify",
    "equations",
    "expansion",
    "sensor-noise",
    "input-doubling",
    "largest-ratio",
    "largest-growth",
    "largest-outside",
    "allowance",
    "pull",
];

pub(crate) fn parse(line: &[OsString]) -> Result<Cli> {
    let mut command = help::command(line);
    let parsed = command.try_get_matches_from_mut(line);
    parsed.and_then(|matches| Cli::from_arg_matches(&matches)).map_err(|error| {
        let given = command.clone().ignore_errors(true).try_get_matches_from(line);
        usage_error(error, &mut command, given.ok().as_ref())
    })
}

/// Returns an error of the command line; a choice of `model` that only its settings have is
/// reported with its key. `given` is what could be parsed in spite of the error.
fn usage_error(error: clap::Error, command: &mut Command, given: Option<&ArgMatches>) -> Error {
    let option = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(option)) if error.kind() == ErrorKind::UnknownArgument => option,
        _ => return Error::Usage(error.format(command)),
    };
    let key = option.trim_start_matches("--").split('=').next().unwrap_or_default();
    let is_model = given.and_then(ArgMatches::subcommand_name) == Some("model");
    if is_model && CHOICES.contains(&key) {
        let problem = format!(
            "--{key} is no option, but {key} is a key of the settings: write it to a file, and \
             give the file with --settings; choices.toml, which this command writes, has all keys"
        );
        return Error::Given(reachtube_files::ErrorKind::Usage, problem);
    }
    Error::Usage(error.format(command))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use reachtube::pipeline::Choices;

    use super::CHOICES;
    use crate::cli::Cli;

    #[test]
    fn every_choice_is_a_key_of_the_settings_and_no_option() {
        let root = Cli::command();
        let model = root.find_subcommand("model").unwrap();
        let unknown = Choices::from_toml("[no-such-key]").unwrap_err().to_string();
        assert!(unknown.contains("unknown field"), "{unknown}");
        for key in CHOICES {
            // No choice is an empty table, which is another error than an unknown key.
            let error = Choices::from_toml(&format!("[{key}]")).unwrap_err().to_string();
            assert!(!error.contains("unknown field"), "{key}: {error}");
            assert!(!model.get_arguments().any(|a| a.get_long() == Some(key)), "--{key}");
        }
    }
}
