//! Parsers for the values of options.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use serde::de::DeserializeOwned;

/// The values of an option, each with its explanation.
pub(crate) type Choices = &'static [(&'static str, &'static str)];

/// How the disturbance may change in time.
pub(crate) const DISTURBANCES: Choices = &[
    ("constant", "constant over the recording, as in the paper"),
    ("sample", "constant over each sample"),
    ("measurable", "any measurable function of time"),
];

/// How far X0 may reach, as `--initial-limit` names it.
pub(crate) const INITIAL_LIMITS: Choices = &[
    ("none", "no limit"),
    ("positions", "positions up to the recorded starts"),
    ("states", "velocities too"),
];

/// The models of the paper (Sec. IV-B), as `--paper-model` names them.
pub(crate) const MODELS: Choices = &[
    ("1", "constant mass matrix and viscous friction, eq. (13)"),
    ("2", "also Coriolis terms, eqs. (14), (15)"),
    ("3", "the whole forward dynamics, eq. (16)"),
];

pub(crate) fn trimmed(text: &str) -> Result<String, std::convert::Infallible> {
    Ok(text.trim().into())
}

/// Parses a duration above 0 \[s\].
pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    positive(text).ok_or_else(|| "give a number of seconds above 0".into())
}

/// Parses a speed above 0 \[rad/s or m/s\].
pub(crate) fn speed(text: &str) -> Result<f64, String> {
    positive(text).ok_or_else(|| "give a speed above 0 in rad/s or m/s".into())
}

/// Parses a part of the recorded speeds, above 0 and up to 1.
pub(crate) fn part(text: &str) -> Result<f64, String> {
    let part = positive(text).filter(|part| *part <= 1.0);
    part.ok_or_else(|| "give a part of the recorded speeds, above 0 and up to 1".into())
}

/// Parses a frequency above 0 \[Hz\].
pub(crate) fn hertz(text: &str) -> Result<f64, String> {
    positive(text).ok_or_else(|| "give a frequency above 0 in Hz".into())
}

fn positive(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|value| *value > 0.0 && value.is_finite())
}

/// Parses a setting by its name in model files; each name comes with its explanation.
pub(crate) fn choice<T>(names: Choices) -> impl TypedValueParser<Value = T>
where
    T: DeserializeOwned + Clone + Send + Sync + 'static,
{
    explained(names).try_map(|name| serde_json::from_value::<T>(name.into()))
}

/// Parses a setting that is one of a few numbers; each number comes with its explanation.
pub(crate) fn numbered_choice<T>(numbers: Choices) -> impl TypedValueParser<Value = T>
where
    T: DeserializeOwned + Clone + Send + Sync + 'static,
{
    explained(numbers).try_map(|number| serde_json::from_str::<T>(&number))
}

pub(crate) fn explained(values: Choices) -> PossibleValuesParser {
    let value = |&(name, help): &(_, _)| PossibleValue::new(name).help(help);
    PossibleValuesParser::new(values.iter().map(value).collect::<Vec<_>>())
}
