//! Number types for reachability analysis of robots, from intervals to Taylor models.
#![doc = include_str!("../README.md")]

mod dispatch;
mod exact_sum;
mod interval;
mod lanes;
pub mod number;
mod powers;
pub mod rounding;
mod scalar;
mod sine_cosine;
mod taylor;
mod taylor_model;

pub use dispatch::{Dispatch, Kernel};
pub use exact_sum::ExactSum;
pub use interval::Interval;
pub use lanes::{Lanes, Lanewise};
pub use powers::Powers;
pub use scalar::Scalar;
pub use sine_cosine::SineCosine;
pub use taylor::{
    MapWorkspace, PolynomialMap, TaylorPolynomial, TaylorSpace, TaylorSpaceError, TaylorTerm,
};
pub use taylor_model::{TaylorBox, TaylorModel};
