//! What a number can be: the trait [`Scalar`] that all dynamics is written over, and [`Interval`], a validated
//! number that is right on stable Rust on any platform.
#![doc = include_str!("../README.md")]

mod elementary;
mod interval;
pub mod rounding;
mod scalar;
mod taylor;

pub use elementary::Elementary;
pub use interval::{DecimalError, Interval};
pub use scalar::Scalar;
pub use taylor::{
    MapWorkspace, PolynomialMap, Powers, TaylorPolynomial, TaylorSpace, TaylorSpaceError, TaylorTerm,
};
