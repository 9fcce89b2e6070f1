//! Reachable sets over recordings, and what is found in them.

pub(crate) mod deviation;
pub(crate) mod direction;
pub(crate) mod flowpipes;
pub(crate) mod grids;
pub(crate) mod hulls;
pub(crate) mod judged;
pub(crate) mod linear;
mod linearised;
pub(crate) mod plant;
pub(crate) mod polynomial;
pub(crate) mod rows;
mod sensitivity;
pub(crate) mod state;
pub(crate) mod witness;
mod worst_case;

pub use deviation::{Deviation, Nominal};
pub use grids::{Grid, Grids};
pub use hulls::{Enclosure, Lost};
pub use rows::{Edge, Row};
pub use witness::Witness;
