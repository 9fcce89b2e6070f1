//! Identification from simulated recordings of known robots, and from real recordings.

mod faults;
mod flat;
mod frames;
mod heavy;
mod lab;
mod laws;
mod link_torque;
mod messages;
mod recorded;
mod recovery;
mod units;
mod virtual_robot;
