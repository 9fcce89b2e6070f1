//! The notions of enclosure: their names, their words, and the states that are judged together.
//! `claim/` proves them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::signals::Part;

/// In which directions recordings must lie in the reachable set (docs/method.md, correction C).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Notion {
    /// Each state by itself: in the interval hull of the set, the paper's notion.
    #[default]
    Hull,
    /// Position and velocity of each part together: in the set's projection on its phase plane.
    PhasePlane,
    /// All states together: in the set itself.
    Exact,
}

impl Notion {
    /// The name of each notion, as in files and options, and its meaning.
    pub const NAMES: &[(&str, &str)] = &[
        ("hull", "each state by itself"),
        ("phase-plane", "each position and its velocity together"),
        ("exact", "all states together"),
    ];

    /// Returns whether recorded points are judged, and not only each state by itself.
    pub(crate) fn asks_points(self) -> bool {
        self != Self::Hull
    }

    /// Returns the states of each projection in which recorded points must lie in the reachable
    /// set, for recordings of the first `rows` states of a system with these parts.
    pub(crate) fn projections(self, rows: usize, parts: &[Part]) -> Vec<Vec<usize>> {
        let of_part =
            |part: &Part| part.states.iter().copied().filter(|state| *state < rows).collect();
        match self {
            Self::Exact => vec![(0..rows).collect()],
            Self::Hull | Self::PhasePlane => parts.iter().map(of_part).collect(),
        }
    }

    /// Returns what is claimed of the recorded `states`, such as "position", in a model's `set`;
    /// `noun` is what a part is called.
    pub(crate) fn claim_words(self, states: &str, set: &str, noun: &str) -> String {
        match self {
            Self::Hull => format!(
                "the recorded {states} of every {noun} lies in the interval hull of the model's \
                 {set}"
            ),
            Self::PhasePlane => format!(
                "the recorded {states} of every {noun} together lie in the projection of the \
                 model's {set} on the {noun}'s phase plane"
            ),
            Self::Exact => {
                format!("the recorded {states} of all {noun}s together lie in the model's {set}")
            }
        }
    }

    /// Returns the notion and what it leaves open; `noun` is what a part is called.
    pub(crate) fn limit_words(self, noun: &str) -> String {
        match self {
            Self::Hull => "The notion is the hull, which bounds each state separately. A point \
                           inside the hull need not be reachable."
                .into(),
            Self::PhasePlane => format!(
                "The notion is the phase plane, which takes position and velocity of each {noun} \
                 together, and each {noun} by itself. States of several {noun}s need not be \
                 reachable together."
            ),
            Self::Exact => "The notion is exact: all states at one sample are reachable together. \
                            One motion of the model need not pass through the states of all \
                            samples."
                .into(),
        }
    }
}
