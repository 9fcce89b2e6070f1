//! Taylor models: the state as a polynomial in the initial state, plus a small offset.

pub(crate) mod monomials;
pub(crate) mod offset;
pub(crate) mod propagator;
pub(crate) mod set;
pub(crate) mod step;
pub(crate) mod time_series;
pub(crate) mod transition;
