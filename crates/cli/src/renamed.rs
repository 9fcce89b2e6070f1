//! Names that options had in earlier versions.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ArgMatches, Command};

use crate::error::Error;

/// A name of an option that another one replaces.
struct Renamed {
    /// The commands that had it.
    commands: &'static [&'static str],
    /// The name, without dashes.
    old: &'static str,
    /// The new name, without dashes, with its value if the old option had none.
    new: &'static str,
}

/// Every name that is gone.
const RENAMED: &[Renamed] = &[
    Renamed { commands: &["abstract", "robot show"], old: "at", new: "expansion" },
    Renamed { commands: &["abstract", "conform"], old: "model", new: "paper-model" },
    Renamed { commands: &["convert"], old: "log", new: "data" },
    Renamed { commands: &["identify"], old: "link-torque", new: "torque link" },
    Renamed { commands: &["prepare"], old: "logs", new: "data" },
];

/// Choices of `model` that its settings name, and no option.
const CHOICES: &[&str] = &[
    "cut-off",
    "identify",
    "equations",
    "expansion",
    "sensor-noise",
    "largest-ratio",
    "largest-growth",
    "largest-outside",
    "allowance",
    "pull",
];

/// Returns the new name of an option of a command, without dashes.
pub(crate) fn new_name(command: &str, old: &str) -> Option<&'static str> {
    let is_it = |renamed: &&Renamed| renamed.old == old && renamed.commands.contains(&command);
    RENAMED.iter().find(is_it).map(|renamed| renamed.new)
}

/// Returns an error of the command line; an option that has another name now is reported with that
/// name, and one that only settings have with its key. `given` is what could be parsed in spite of
/// the error.
pub(crate) fn usage_error(
    error: clap::Error,
    command: &mut Command,
    given: Option<&ArgMatches>,
) -> Error {
    let option = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(option)) if error.kind() == ErrorKind::UnknownArgument => option,
        _ => return Error::Usage(error.format(command)),
    };
    let old = option.trim_start_matches("--").split('=').next().unwrap_or_default();
    let path = given.map(command_path).unwrap_or_default();
    match (new_name(&path, old), CHOICES.contains(&old) && path == "model") {
        (Some(new), _) => Error::Renamed { old: old.into(), new },
        (None, true) => Error::InSettings { key: old.into() },
        (None, false) => Error::Usage(error.format(command)),
    }
}

/// Returns the names of the command and the one below it, as in "robot show".
fn command_path(mut given: &ArgMatches) -> String {
    let mut names = Vec::new();
    while let Some((name, below)) = given.subcommand() {
        names.push(name);
        given = below;
    }
    names.join(" ")
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use reachtube::pipeline::Choices;

    use super::{CHOICES, RENAMED};
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

    #[test]
    fn every_new_name_is_an_option_and_no_old_one_is() {
        for renamed in RENAMED {
            for path in renamed.commands {
                let root = Cli::command();
                let below = path.split(' ').fold(&root, |command, name| {
                    command.find_subcommand(name).unwrap_or_else(|| panic!("no command {path}"))
                });
                let has = |long: &str| below.get_arguments().any(|a| a.get_long() == Some(long));
                assert!(has(renamed.new.split(' ').next().unwrap()), "{path} --{}", renamed.new);
                assert!(!has(renamed.old), "{path} --{}", renamed.old);
            }
        }
    }
}
