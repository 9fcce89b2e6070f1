//! The obstacles that a robot must stay clear of.

pub(crate) mod direction;
pub(crate) mod obstacle;
mod obstacle_table;
pub(crate) mod scenario;
pub(crate) mod separation;
