//! Statements about motions that were not recorded: bounds, calibration by held-out motions, and
//! descriptions of how far the sets depend on single motions and runs.

pub(crate) mod allowance;
pub(crate) mod any_run;
pub(crate) mod bounds;
pub(crate) mod calibration;
pub(crate) mod growth;
mod held_out;
pub(crate) mod left_out;
pub(crate) mod motions;
mod outer_gauge;
pub(crate) mod point_gauge;
pub(crate) mod trends;
pub(crate) mod trust;
pub(crate) mod trust_kind;
pub(crate) mod without_motion;

pub use allowance::AllowanceNeeded;
pub use any_run::AnyRun;
pub use calibration::{Calibration, Gauge};
pub use growth::Growth;
pub use held_out::next_motion_of_held_out;
pub use trends::Trend;
pub use trust::{CONFIDENCE, Trust};
pub use trust_kind::TrustKind;
pub use without_motion::LeftOut;
