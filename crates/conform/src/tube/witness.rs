use reachtube_recordings::State;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::problem::Problem;
use crate::data::side::Side;
use crate::tube::rows::{Edge, Row};

/// A recorded value at the edge of the reachable set or beyond it, in the words of the recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Witness {
    /// The suite.
    pub suite: String,
    /// The recording.
    pub run: String,
    /// Sample, from 0.
    pub sample: usize,
    /// Time since the first sample, s.
    pub time: f64,
    /// Part, from 1.
    pub part: usize,
    /// The state.
    pub state: State,
    /// The side of the set.
    pub side: Side,
    /// How far outside the reachable set, rad or rad/s; an upper bound.
    pub excess: f64,
    /// Radius of the reachable set there, rad or rad/s.
    pub radius: f64,
}

impl Witness {
    pub(crate) fn new(problem: &Problem, row: &Row, edge: &Edge) -> Self {
        let state = State::from_index(row.state, problem.inputs());
        Self {
            suite: problem.recordings().suites[row.suite].entry.name.clone(),
            run: problem.entry(edge.run as usize).file.clone(),
            sample: row.sample,
            time: row.time,
            part: state.part + 1,
            state,
            side: edge.side,
            excess: edge.excess,
            radius: row.radius,
        }
    }
}
