use std::collections::BTreeSet;

use reachtube_finding::Units;
use reachtube_recordings::State;
use reachtube_scalar::number::plural;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A state or an input of a system.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Signal {
    /// The name of its column in a recording.
    pub name: String,
    /// Its unit.
    pub unit: String,
}

/// A part of a system, whose states are looked at together: a position with its velocity, and the
/// force that drives it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// Its states, by their indices.
    pub states: Vec<usize>,
    /// Its inputs, by their indices.
    pub inputs: Vec<usize>,
}

/// What the numbers of a model are.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Signals {
    /// The states, N.
    pub states: Vec<Signal>,
    /// The inputs, m.
    pub inputs: Vec<Signal>,
    /// The parts of the system.
    pub parts: Vec<Part>,
    /// What a part is called.
    pub noun: String,
    /// Whose equations nominal motions follow, where they are not the model's, as a clause.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nominal: Option<String>,
}

impl Signals {
    /// Returns the unit of a state.
    #[must_use]
    pub fn unit(&self, state: State) -> &str {
        &self.states[state.index(self.inputs.len())].unit
    }

    pub(crate) fn place(&self, parts: impl Iterator<Item = usize>) -> String {
        let parts: BTreeSet<usize> = parts.collect();
        let numbers: Vec<String> = parts.iter().map(ToString::to_string).collect();
        format!("{} {}", plural(parts.len(), &self.noun), numbers.join(", "))
    }

    /// Returns the units of one state of each part, such as all positions.
    #[must_use]
    pub fn units_of_state(&self, at: usize) -> Units {
        let of = |part: &Part| part.states.get(at).map(|state| self.states[*state].unit.as_str());
        Units::new(self.parts.iter().map(|part| of(part).unwrap_or("")))
    }

    pub(crate) fn units_of_inputs(&self) -> Units {
        Units::new(self.inputs.iter().map(|input| input.unit.as_str()))
    }
}
