//! How long a robot needs to stand still after a stop, and how far it moves.

mod accelerations;
pub(crate) mod along;
pub(crate) mod brakes;
#[expect(clippy::module_inception, reason = "the stop is the concept of this folder")]
pub(crate) mod stop;
mod velocity_bounds;
