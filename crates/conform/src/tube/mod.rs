//! Reachable sets over recordings, and what is found in them.

pub(crate) mod direction;
pub(crate) mod judged;
pub(crate) mod linear;
mod linearised;
pub(crate) mod plant;
pub(crate) mod polynomial;
mod sensitivity;
pub(crate) mod state;
mod worst_case;
