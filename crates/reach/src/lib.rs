#![doc = include_str!("../README.md")]

mod error;
mod grid;
mod linear;
mod polynomial;
mod sets;
mod system;
mod upward;

pub use error::ReachError;
pub use grid::TimeGrid;
pub use linear::{
    Disturbance, LinearSystem, OutputGains, Propagation, PropagationStep, ReachSets,
    SampleGenerators, Solution, StepBounds, StepRadii, Trajectory, step,
};
pub use polynomial::{
    AutomaticFlowpipe, Flowpipe, FlowpipeMethod, FlowpipeOutcome, FlowpipeSettings,
    PolynomialSystem, UncertainInput, Visit,
};
pub use sets::{
    GeneratorRows, Hyperrectangle, IntervalMatrix, IntervalVector, Membership, MembershipProof,
    MembershipWorkspace, Place, Zonotope,
};
pub use system::{Nonlinear, Slopes, System};
