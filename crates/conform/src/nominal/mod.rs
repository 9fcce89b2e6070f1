//! The nominal motion of a case, and what is taken off its input along it.

mod cases;
pub(crate) mod corrector;
pub(crate) mod input_error;
pub(crate) mod loads;
pub(crate) mod motion;
pub(crate) mod robot_equations;
pub(crate) mod simulate;
pub(crate) mod steps;
pub(crate) mod transition;
