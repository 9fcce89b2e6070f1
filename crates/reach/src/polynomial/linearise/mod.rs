//! Conservative linearisation (Althoff, Stursberg, Buss, CDC 2008).

pub(crate) mod expansion_point;
pub(crate) mod linear_part;
pub(crate) mod linearisation;
pub(crate) mod propagator;
pub(crate) mod reachable_zonotope;
pub(crate) mod rounded_exponential;
pub(crate) mod step;
