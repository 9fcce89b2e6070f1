//! Robots as URDF: reading a serial chain of revolute joints, and writing identified values back.

mod chain;
mod companion;
mod describe;
mod document;
mod edit;
mod motor;
pub(crate) mod read;
mod write;
