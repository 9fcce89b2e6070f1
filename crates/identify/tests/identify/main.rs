//! Identification from virtual recordings, whose robot is known, and from recorded ones.

mod recorded;
mod recovery;
mod virtual_robot;
