use reachtube_recordings::State;
use schemars::JsonSchema;
use serde::Serialize;

use crate::data::side::Side;

/// A measured value outside the reachable set of a window.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Leave {
    /// Time of the sample, s, as it was given; interpolated samples lie between.
    pub time: f64,
    /// Time of the window's first sample, s.
    pub window: f64,
    /// Part, from 1.
    pub part: usize,
    /// The state.
    pub state: State,
    /// The side of the set.
    pub side: Side,
    /// The measured value, rad or rad/s.
    pub value: f64,
    /// How far outside the reachable set, rad or rad/s; an upper bound, infinite if the nominal
    /// motion diverged.
    #[schemars(with = "Option<f64>")]
    pub excess: f64,
    /// Radius of the reachable set there with V, rad or rad/s.
    pub radius: f64,
    /// Whether the value was proved to lie outside: no disturbance of the model explains the
    /// window. Without it, the value is within rounding of the set's boundary.
    pub proved: bool,
    /// Whether it is the first value of the window outside.
    pub first: bool,
}
