//! Enclosures of a point of a link while the joints move within a box.

pub(crate) mod chain;
pub(crate) mod linearised_point;
pub(crate) mod vector;
