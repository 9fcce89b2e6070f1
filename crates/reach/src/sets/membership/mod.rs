//! Whether points lie in a zonotope: factors of the generators for points inside, a separating
//! direction for points outside.

mod blocks;
mod locate;
mod proof;
pub(crate) mod rows;

pub use locate::{Membership, MembershipWorkspace, Place};
pub use proof::MembershipProof;
pub use rows::GeneratorRows;
