//! Reachable sets of polynomial systems with uncertain input.

mod angles;
mod corners;
mod directions;
mod exponential;
mod flowpipe;
mod follower;
mod generators;
mod linearisation;
mod powers;
mod rounded;
mod set;
mod shift;
mod step;
mod system;
mod taylor;
mod univariate;
mod zonotope;

pub use flowpipe::{Flowpipe, FlowpipeMethod, FlowpipeOutcome, FlowpipeSettings, UncertainInput};
pub use system::PolynomialSystem;
pub use zonotope::Zonotope;
