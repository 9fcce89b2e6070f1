//! Truncated polynomials of many variables.
//!
//! Each file uses only files named before it in this list:
//!
//! 1. `monomial`: exponents packed into one integer.
//! 2. `space`: the number of variables, the order and the numbering of monomials.
//! 3. `addition`: how coefficients are added.
//! 4. `sparse`: sums and products of lists of terms.
//! 5. `dense`: dense series and their product kernel.
//! 6. `polynomial`: the type [`TaylorPolynomial`] over both storage forms.
//! 7. `arithmetic`: sums, products and their operators.
//! 8. `recurrence`: series whose coefficients follow degree by degree.
//! 9. `division`: quotients.
//! 10. `sine_cosine`: sine and cosine.
//! 11. `substitution`: evaluation, composition, derivatives.
//! 12. `map`: fast evaluation of several polynomials at once.

pub(crate) mod addition;
mod arithmetic;
mod dense;
mod division;
pub(crate) mod map;
pub(crate) mod monomial;
pub(crate) mod polynomial;
mod recurrence;
mod sine_cosine;
pub(crate) mod space;
pub(crate) mod sparse;
mod substitution;

pub use map::{MapWorkspace, PolynomialMap};
pub use polynomial::{TaylorPolynomial, TaylorTerm};
pub use space::{TaylorSpace, TaylorSpaceError};
