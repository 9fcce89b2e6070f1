use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The quantity of a joint that a state is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StateKind {
    /// The position q.
    Position,
    /// The velocity q̇.
    Velocity,
}

impl StateKind {
    fn prefix(self) -> &'static str {
        match self {
            Self::Position => "q",
            Self::Velocity => "qd",
        }
    }
}

/// One state of a robot: the position or the velocity of one joint.
///
/// States are ordered q1..qn, q̇1..q̇n. A state is written as the name of its column in a
/// recording.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::{State, StateKind};
///
/// let state = State::from_index(7, 6);
/// assert_eq!((state.part, state.kind), (1, StateKind::Velocity));
/// assert_eq!(state.to_string(), "qd2");
/// assert_eq!("qd2".parse(), Ok(state));
/// assert_eq!(state.index(6), 7);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct State {
    /// The part of the system, from 0: the joint of an arm.
    pub part: usize,
    /// Position or velocity.
    pub kind: StateKind,
}

impl State {
    /// Returns the state at `index` (from 0) of the 2n states of a robot of `joints` joints.
    #[must_use]
    pub fn from_index(index: usize, joints: usize) -> Self {
        match index.checked_sub(joints) {
            None => Self { part: index, kind: StateKind::Position },
            Some(part) => Self { part, kind: StateKind::Velocity },
        }
    }

    /// Returns the index (from 0) among the 2n states of a robot of `joints` joints.
    #[must_use]
    pub fn index(self, joints: usize) -> usize {
        match self.kind {
            StateKind::Position => self.part,
            StateKind::Velocity => joints + self.part,
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.kind.prefix(), self.part + 1)
    }
}

/// A name does not name a state.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("\"{name}\" is not a state; states are named q1, q2, ..., qd1, ...")]
pub struct StateNameError {
    /// The name.
    pub name: String,
}

impl FromStr for State {
    type Err = StateNameError;

    fn from_str(name: &str) -> Result<Self, StateNameError> {
        let (kind, digits) = match (name.strip_prefix("qd"), name.strip_prefix('q')) {
            (Some(digits), _) => (StateKind::Velocity, digits),
            (None, Some(digits)) => (StateKind::Position, digits),
            (None, None) => (StateKind::Position, ""),
        };
        let part = digits.parse::<usize>().ok().and_then(|part| part.checked_sub(1));
        let wrong = || StateNameError { name: name.into() };
        part.map(|part| Self { part, kind }).ok_or_else(wrong)
    }
}

impl JsonSchema for State {
    fn schema_name() -> Cow<'static, str> {
        "State".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "string",
            "pattern": "^qd?[1-9][0-9]*$",
            "description": "A state: q1 is the position of the first joint, qd1 its velocity."
        })
    }
}

impl Serialize for State {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for State {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_names_and_indices_correspond() {
        for index in 0..14 {
            let state = State::from_index(index, 7);
            assert_eq!(state.index(7), index);
            assert_eq!(state.to_string().parse(), Ok(state));
        }
    }

    #[test]
    fn other_names_are_refused() {
        for name in ["", "q", "qd", "q0", "qd0", "x1", "tau1", "q1.5", "q-1"] {
            assert!(name.parse::<State>().is_err(), "{name}");
        }
    }
}
