//! Taylor models: polynomials with a proved bound of their error.
//!
//! Each file uses only files named before it in this list:
//!
//! 1. `bounds`: bounds of polynomials over [-1, 1]^k.
//! 2. `polarisation`: bounds of the product of two homogeneous parts.
//! 3. `model`: the type [`TaylorModel`].
//! 4. `product`: products and multiples.
//! 5. `arithmetic`: sums, and the operators `+`, `-` and `*`.
//! 6. `tight`: closer bounds by branch and bound.
//! 7. `taylor_box`: the box that models are defined over.

mod arithmetic;
mod bounds;
mod model;
mod polarisation;
mod product;
mod taylor_box;
mod tight;

pub use model::TaylorModel;
pub use taylor_box::TaylorBox;
