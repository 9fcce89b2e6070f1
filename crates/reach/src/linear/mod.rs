//! Reachable sets of linear systems with uncertain inputs.

pub(crate) mod column_sums;
pub(crate) mod exponential;
pub(crate) mod hulls;
pub(crate) mod input_gains;
pub(crate) mod outputs;
pub(crate) mod phi1_series;
pub(crate) mod propagation;
pub(crate) mod sample_generators;
pub(crate) mod solution;
pub(crate) mod sparsity;
pub(crate) mod step;
pub(crate) mod step_bounds;
pub(crate) mod system;

pub use hulls::ReachSets;
pub use input_gains::Disturbance;
pub use outputs::OutputGains;
pub use propagation::Propagation;
pub use sample_generators::SampleGenerators;
pub use solution::{Solution, Trajectory};
pub use step::{PropagationStep, step};
pub use step_bounds::{StepBounds, StepRadii};
pub use system::LinearSystem;
