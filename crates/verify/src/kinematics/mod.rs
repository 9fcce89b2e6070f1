//! Where a point of a link is, as the joints move within a box.

pub(crate) mod chain;
pub(crate) mod linearised_point;
pub(crate) mod vector;
