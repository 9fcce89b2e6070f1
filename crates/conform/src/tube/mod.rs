//! Reachable sets over recordings, and what is found in them.

pub(crate) mod deviation;
pub(crate) mod direction;
pub(crate) mod flowpipes;
pub(crate) mod grids;
pub(crate) mod input_scale;
pub(crate) mod judged;
pub(crate) mod linear;
mod linearised;
pub(crate) mod place;
pub(crate) mod plant;
pub(crate) mod polynomial;
pub(crate) mod rows;
mod sensitivity;
pub(crate) mod state;
mod state_sensitivities;
pub(crate) mod strand;
#[expect(clippy::module_inception, reason = "the folder and its main type share the noun")]
pub(crate) mod tube;
pub(crate) mod witness;
mod worst_case;

pub use strand::Lost;
pub use tube::Enclosure;
pub use witness::Witness;
