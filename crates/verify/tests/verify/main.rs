//! Tests of the enclosures, by sampling and against a second source.

mod capsules;
mod common;
mod frames;
mod margin;
mod meshes;
mod occupancy;
mod schunk;
mod stop;
