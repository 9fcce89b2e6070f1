//! The nominal motion of a case, and what is subtracted from its input along it.

mod cases;
pub(crate) mod input_error;
pub(crate) mod motion;
pub(crate) mod simulate;
pub(crate) mod steps;
pub(crate) mod transition;
