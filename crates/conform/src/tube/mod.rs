//! Reachable sets over recordings, and what is found in them.

pub(crate) mod judged;
pub(crate) mod linear;
pub(crate) mod plant;
pub(crate) mod polynomial;
