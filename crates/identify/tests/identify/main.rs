//! Identification from simulated recordings of known robots, and from real recordings.

mod recorded;
mod recovery;
mod virtual_robot;
