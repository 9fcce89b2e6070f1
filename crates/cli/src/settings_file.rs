//! A settings file: TOML whose keys are the options of a command.
//!
//! The values become arguments in front of the ones on the command line, so that both are parsed,
//! checked and documented in one place. `identify` has settings that are no options, and reads its
//! own file.

use std::any::TypeId;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::error::{ContextKind, ContextValue};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, CommandFactory, FromArgMatches, ValueHint};
use toml::{Spanned, Value};

use crate::cli::Cli;
use crate::error::{Error, Result};
use crate::help;
use crate::renamed::{new_name, usage_error};

/// The command that takes a settings file of its options.
const COMMAND: &str = "conform";

/// The option that names the file. It is no key of the file.
const OPTION: &str = "settings";

/// Parses the command line, with the settings file that it names.
pub(crate) fn parse(line: Vec<OsString>) -> Result<Cli> {
    // Options that the file gives may be missing from the command line.
    let command = help::command(&line);
    let first = command.clone().ignore_errors(true).try_get_matches_from(&line);
    let first = first.ok();
    let given = first.as_ref().and_then(|matches| matches.subcommand_matches(COMMAND));
    let path = given.and_then(|given| given.try_get_one::<PathBuf>(OPTION).ok().flatten());
    let parsed = match given.zip(path) {
        Some((given, path)) => with_file(&line, given, path)?,
        None => command.clone().try_get_matches_from(&line),
    };
    let parsed = parsed.and_then(|matches| Cli::from_arg_matches(&matches));
    parsed.map_err(|error| usage_error(error, &mut command.clone(), first.as_ref()))
}

/// Parses the command line together with the options in the file `path` that it does not give.
/// An error of an option that the file gives names its line there; other errors are returned in the
/// inner result.
fn with_file(
    line: &[OsString],
    given: &ArgMatches,
    path: &Path,
) -> Result<Result<ArgMatches, clap::Error>> {
    let text =
        reachtube_files::read_text(path, "give a settings file as docs/reference.md describes")?;
    let file = SettingsFile::parse(path, &text)?;
    let at = line.iter().position(|argument| argument == COMMAND).unwrap_or(line.len() - 1) + 1;
    let on_line = |key: &str| given.value_source(&id(key)) == Some(ValueSource::CommandLine);
    let from_file = file.arguments(on_line)?;
    let all = line[..at].iter().cloned().chain(from_file).chain(line[at..].iter().cloned());
    let parsed = help::command(line).try_get_matches_from(all);
    match parsed.as_ref().err().and_then(|error| file.blame(error)) {
        Some(blamed) => Err(blamed),
        None => Ok(parsed),
    }
}

/// Returns the name that clap derives from the option `--key`.
fn id(key: &str) -> String {
    key.replace('-', "_")
}

/// The keys of a settings file, each with its place in the text.
struct SettingsFile<'a> {
    path: &'a Path,
    text: &'a str,
    values: BTreeMap<Spanned<String>, Spanned<Value>>,
    options: Vec<Arg>,
}

impl<'a> SettingsFile<'a> {
    fn parse(path: &'a Path, text: &'a str) -> Result<Self> {
        let values = toml::from_str(text).map_err(|error| Error::SettingsSyntax {
            path: path.into(),
            message: error.to_string(),
        })?;
        let command = Cli::command();
        let command = command.find_subcommand(COMMAND).expect("the command exists");
        let options = command.get_arguments().filter(|option| option.get_long() != Some(OPTION));
        Ok(Self { path, text, values, options: options.cloned().collect() })
    }

    /// Returns the arguments for the keys that are not on the command line.
    fn arguments(&self, on_line: impl Fn(&str) -> bool) -> Result<Vec<OsString>> {
        let mut arguments = Vec::new();
        for (key, value) in &self.values {
            let option =
                self.options.iter().find(|option| option.get_long() == Some(key.get_ref()));
            let option = option.ok_or_else(|| self.unknown(key))?;
            if !on_line(key.get_ref()) {
                let wrong = |problem| self.error(key, problem);
                arguments.extend(self.option_values(option, value.get_ref()).map_err(wrong)?);
            }
        }
        Ok(arguments)
    }

    /// Returns the arguments that give `value` to an option.
    fn option_values(&self, option: &Arg, value: &Value) -> Result<Vec<OsString>, String> {
        let name = option.get_long().unwrap_or_default();
        let with = |value: OsString| {
            let mut argument = OsString::from(format!("--{name}="));
            argument.push(value);
            argument
        };
        match value {
            Value::Boolean(given) if matches!(option.get_action(), ArgAction::SetTrue) => {
                Ok(given.then(|| format!("--{name}").into()).into_iter().collect())
            }
            Value::Array(list) => {
                let items = list.iter().map(item).collect::<Result<Vec<_>, _>>()?;
                if let Some(item) = items.iter().find(|item| item.contains(',')) {
                    return Err(format!("\"{item}\" holds a comma; give one entry for each value"));
                }
                let repeated = matches!(option.get_action(), ArgAction::Append)
                    && option.get_value_delimiter().is_none();
                let values = if repeated { items } else { vec![items.join(",")] };
                Ok(values.into_iter().map(|value| with(value.into())).collect())
            }
            _ => Ok(vec![with(self.located(option, item(value)?))]),
        }
    }

    /// Returns a path relative to the file's folder; a robot that is no file there is a name.
    fn located(&self, option: &Arg, value: String) -> OsString {
        let beside = self.path.parent().unwrap_or(Path::new("")).join(&value);
        let is_path = option.get_value_parser().type_id() == TypeId::of::<PathBuf>();
        let may_be_path = option.get_value_hint() == ValueHint::FilePath;
        if is_path || (may_be_path && beside.exists()) { beside.into() } else { value.into() }
    }

    /// Names the line of the file that an error of the arguments comes from, if it does.
    fn blame(&self, error: &clap::Error) -> Option<Error> {
        let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg) else {
            return None;
        };
        let name = option.trim_start_matches("--").split([' ', '=']).next().unwrap_or_default();
        let key = self.values.keys().find(|key| key.get_ref() == name)?;
        let text = error.render().to_string();
        let reason = text.split("\n\nUsage").next().unwrap_or(&text);
        let reason = reason.split("\n\nFor more").next().unwrap_or(reason);
        Some(self.error(key, reason.trim_start_matches("error: ").trim().into()))
    }

    fn unknown(&self, key: &Spanned<String>) -> Error {
        if let Some(new) = new_name(COMMAND, key.get_ref()) {
            return self.error(key, format!("the option is now {new}"));
        }
        let names: Vec<&str> = self.options.iter().filter_map(Arg::get_long).collect();
        self.error(key, format!("there is no such option; the options are {}", names.join(", ")))
    }

    fn error(&self, key: &Spanned<String>, problem: String) -> Error {
        let line = 1 + self.text[..key.span().start].matches('\n').count();
        let (path, key) = (self.path.into(), key.get_ref().clone());
        Error::SettingsKey { path, line, key, problem }
    }
}

/// Returns a value as it would be typed.
fn item(value: &Value) -> Result<String, String> {
    match value {
        Value::String(text) => Ok(text.clone()),
        Value::Integer(number) => Ok(number.to_string()),
        Value::Float(number) => Ok(number.to_string()),
        other => Err(format!(
            "a value of type {} does not fit; give a string, a number or a list of \
                         these",
            other.type_str()
        )),
    }
}

#[cfg(test)]
#[path = "../../reachtube/tests/hostile/mutation.rs"]
mod mutation;

#[cfg(test)]
mod tests {
    use std::path::Path;

    use clap::CommandFactory;

    use super::mutation::attack;
    use super::{COMMAND, SettingsFile};
    use crate::cli::Cli;

    const SETTINGS: &str = "robot = \"arm.toml\"\ndata = \"data\"\nsuites = [\"A\", \"B\"]\n\
                            torque = \"motor\"\nweights = [1, 0.5]\nuntil = 0.25\norder = 3\n\
                            max-gap = 1\ncentre = 'zero'\n";

    fn attack_settings(count: u64) {
        let path = Path::new("settings.toml");
        attack("conform's settings", &[SETTINGS.into()], count, |bytes| {
            let text = String::from_utf8_lossy(bytes);
            let arguments =
                SettingsFile::parse(path, &text).and_then(|file| file.arguments(|_| false));
            if let Ok(arguments) = arguments {
                let line = ["reachtube".into(), COMMAND.into()].into_iter().chain(arguments);
                let _ = Cli::command().try_get_matches_from(line);
            }
        });
    }

    #[test]
    fn a_sample_of_hostile_settings_is_read_without_harm() {
        attack_settings(1000);
    }

    #[test]
    #[ignore = "takes long; REACHTUBE_HOSTILE_INPUTS sets the number of inputs"]
    fn many_hostile_settings_are_read_without_harm() {
        let count = std::env::var("REACHTUBE_HOSTILE_INPUTS").ok();
        attack_settings(count.map_or(10_000, |count| count.parse().unwrap()));
    }
}
