//! Recordings that stay in parts on several machines: folds of them.

pub use crate::data::fold::fold::Fold;
pub use crate::data::fold::of_fold::OnDefect;
