#![doc = include_str!("../README.md")]

pub mod abstraction;
pub mod conform;
pub mod data;
pub mod demo;
mod error;
pub mod identify;
mod json;
pub mod model;
mod motion;
mod random;
pub mod reach;
pub mod report;
pub mod reproduce;
pub mod write;

pub use error::{Error, Result};
pub use model::Model;

/// Name and version of the program, as files that it writes record it.
pub const TOOL: &str = concat!("reachtube ", env!("CARGO_PKG_VERSION"));
