//! Time and distance of a robot until standstill after a stop.

mod accelerations;
pub(crate) mod along;
pub(crate) mod annex_b;
pub(crate) mod brakes;
pub(crate) mod category;
pub(crate) mod deceleration;
mod delay_span;
mod extension;
mod findings;
pub(crate) mod path;
pub(crate) mod recorded;
pub(crate) mod rule;
pub(crate) mod simulated;
#[expect(clippy::module_inception, reason = "the stop is the concept of this folder")]
pub(crate) mod stop;
pub(crate) mod study;
pub(crate) mod text;
mod velocity_bounds;
