//! Base parameters: the combinations of parameters that torque depends on.

pub(crate) mod base;
mod combination;
mod independent;
