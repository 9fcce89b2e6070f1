#![doc = include_str!("../README.md")]

pub mod abstraction;
pub mod conform;
pub mod data;
mod error;
pub mod report;

pub use error::{Error, Result};
