//! Whether points lie in a zonotope: factors of the generators for those that do, a direction that
//! separates them for those that do not.

mod blocks;
mod locate;
mod proof;
pub(crate) mod rows;

pub use locate::{Membership, MembershipWorkspace, Place};
pub use proof::MembershipProof;
pub use rows::GeneratorRows;
