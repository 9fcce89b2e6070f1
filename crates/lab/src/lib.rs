#![doc = include_str!("../README.md")]

pub mod campaign;
mod error;
mod motion;
mod random;
mod random_motion;
pub mod reproduce;
pub mod virtual_robot;

pub use error::{Error, Result};
