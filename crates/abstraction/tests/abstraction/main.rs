//! The three models against the dynamics that they approximate.

mod common;
mod derivatives;
mod errors;
mod files;
mod flowpipes;
mod motion;
mod orders;
mod prismatic;
mod seven_joints;
