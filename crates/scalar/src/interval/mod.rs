//! Intervals with outward rounding.
//!
//! Each file uses only files named before it in this list:
//!
//! 1. `closed`: the type [`Interval`].
//! 2. `ends`: sums and products, both ends at once.
//! 3. `arithmetic`: sums, products, quotients and their operators.
//! 4. `powers`: powers, roots, absolute value, minimum and maximum.
//! 5. `power_series`: series with a proved error bound.
//! 6. `exponential` and `trigonometric`: exp, sin and cos by such series.

mod arithmetic;
pub(crate) mod closed;
mod ends;
mod exponential;
mod power_series;
mod powers;
mod trigonometric;

pub use closed::Interval;
