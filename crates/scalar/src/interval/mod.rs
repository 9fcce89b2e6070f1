//! Intervals with outward rounding.
//!
//! Each file uses only files named before it in this list:
//!
//! 1. `closed`: the type [`Interval`].
//! 2. `arithmetic`: sums, products, quotients and their operators.
//! 3. `powers`: powers, roots, absolute value, minimum and maximum.
//! 4. `power_series`: series with a proved error bound.
//! 5. `exponential` and `trigonometric`: exp, sin and cos by such series.
//! 6. `inverse`: logarithm and angle, as corrected guesses.
//! 7. `decimal`: decimal text.

mod arithmetic;
pub(crate) mod closed;
mod decimal;
mod exponential;
mod inverse;
mod power_series;
mod powers;
mod trigonometric;

pub use closed::Interval;
pub use decimal::DecimalError;
