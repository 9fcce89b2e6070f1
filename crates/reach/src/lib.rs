#![doc = include_str!("../README.md")]

mod disturbance;
mod error;
mod exponential;
mod grid;
mod hyperrectangle;
mod linear;
mod matrix;
mod polynomial;
mod powers;
mod propagation;
mod reach_set;
mod samples;
mod series;
mod sums;
mod tube;
mod variation;

pub use disturbance::Disturbance;
pub use error::ReachError;
pub use exponential::{Step, step};
pub use grid::TimeGrid;
pub use hyperrectangle::Hyperrectangle;
pub use linear::LinearSystem;
pub use matrix::{IntervalMatrix, IntervalVector};
pub use polynomial::{
    Flowpipe, FlowpipeMethod, FlowpipeOutcome, FlowpipeSettings, PolynomialSystem, UncertainInput,
    Zonotope,
};
pub use propagation::Propagation;
pub use reach_set::{ReachSets, Trajectory};
pub use tube::{Tube, TubeRadii};
