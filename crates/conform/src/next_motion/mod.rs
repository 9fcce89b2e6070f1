//! Statements about motions that were not recorded: bounds, calibration by held-out motions, and
//! descriptions of how far the sets depend on single motions and runs.

pub(crate) mod bounds;
pub(crate) mod calibration;
pub(crate) mod deciding_runs;
pub(crate) mod left_out;
pub(crate) mod motions;
mod outer_gauge;
pub(crate) mod rates;
pub(crate) mod trends;
pub(crate) mod trust;
pub(crate) mod without_motion;
