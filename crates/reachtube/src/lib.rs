#![doc = include_str!("../README.md")]

pub mod demo;
mod error;
mod motion;
pub mod number;
mod random;
#[cfg(feature = "report")]
pub mod report;
pub mod reproduce;

pub use error::{Error, Result};
pub use reachtube_abstraction as abstraction;
pub use reachtube_conform as conform;
pub use reachtube_conform::Model;
pub use reachtube_files::{TOOL, write};
pub use reachtube_identify as identify;
pub use reachtube_reach as reach;
pub use reachtube_recordings as recordings;
pub use reachtube_robot as robot;
