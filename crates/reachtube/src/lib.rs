#![doc = include_str!("../README.md")]

pub mod abstraction;
pub mod conform;
pub mod data;
pub mod demo;
mod error;
pub mod model;
pub mod reach;
pub mod report;
pub mod write;

pub use error::{Error, Result};
pub use model::Model;
