//! The words of an answer: one constructor for each code.

mod check;
mod dependence;
mod fit;
mod new_motions;
mod sets;
mod verdict;
pub(super) mod words;
