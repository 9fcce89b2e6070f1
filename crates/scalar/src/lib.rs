//! What a number can be: the trait [`Scalar`] that all dynamics is written over, and [`Interval`], a validated
//! number that is right on stable Rust on any platform.
#![doc = include_str!("../README.md")]

mod interval;
pub mod rounding;
mod scalar;

pub use interval::{DecimalError, Interval};
pub use scalar::Scalar;
