//! Tests of conformance: the sets, the proof, the notions, and what is reported about them.

mod badly_scaled;
mod common;
mod equations;
mod fit;
mod fit_friction;
mod fit_schunk;
mod fold;
mod friction;
mod growing;
mod guarantees;
mod kinematic;
mod model_file;
mod monitor;
mod next_motion;
mod nonlinear;
mod notion;
mod plausibility;
mod read_once;
mod sampled_states;
mod schunk;
mod stiction;
mod synthetic;
mod told_starts;
mod warmth;
