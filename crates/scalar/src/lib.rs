//! What a number can be: the trait [`Scalar`] that all dynamics is written over; [`Interval`], a
//! validated number that is right on stable Rust on any platform; [`TaylorPolynomial`] and
//! [`TaylorModel`], functions in place of numbers; and [`Lanes`], several numbers at once.
#![doc = include_str!("../README.md")]

mod elementary;
mod interval;
mod lanes;
pub mod rounding;
mod scalar;
mod taylor;
mod taylor_model;

pub use elementary::Elementary;
pub use interval::{DecimalError, Interval};
pub use lanes::{Lanes, Lanewise};
pub use scalar::Scalar;
pub use taylor::{
    MapWorkspace, PolynomialMap, Powers, TaylorPolynomial, TaylorSpace, TaylorSpaceError,
    TaylorTerm,
};
pub use taylor_model::{TaylorBox, TaylorModel};
