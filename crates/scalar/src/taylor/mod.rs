//! Truncated polynomials of many variables.

mod arithmetic;
mod dense;
mod functions;
mod map;
mod monomial;
mod polynomial;
mod space;
mod sparse;
mod substitution;

pub(crate) use arithmetic::Addition;
pub use map::{MapWorkspace, PolynomialMap, Powers};
pub(crate) use monomial::exponents_only;
pub(crate) use polynomial::Form;
pub use polynomial::{TaylorPolynomial, TaylorTerm};
pub use space::{TaylorSpace, TaylorSpaceError};
pub(crate) use sparse::collected;
