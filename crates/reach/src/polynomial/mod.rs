//! Reachable sets of polynomial systems with uncertain inputs.

pub(crate) mod arguments;
pub(crate) mod automatic;
pub(crate) mod directions;
pub(crate) mod expansion;
pub(crate) mod flowpipe;
pub(crate) mod linearise;
pub(crate) mod propagator;
pub(crate) mod settings;
pub(crate) mod simulated;
pub(crate) mod system;
pub(crate) mod taylor;
pub(crate) mod uncertain_input;

pub use automatic::AutomaticFlowpipe;
pub use flowpipe::{Flowpipe, FlowpipeOutcome, Visit};
pub use settings::{FlowpipeMethod, FlowpipeSettings};
pub use system::PolynomialSystem;
pub use uncertain_input::UncertainInput;
