//! Robots as URDF: reading a serial chain of revolute and prismatic joints, and writing identified
//! values back.

mod chain;
pub(crate) mod collision;
mod companion;
mod describe;
mod document;
mod edit;
mod hold;
mod motor;
pub(crate) mod read;
mod write;
