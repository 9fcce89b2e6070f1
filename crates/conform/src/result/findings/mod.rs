//! The words of an answer: one constructor for each code.

mod beyond_proof;
mod check;
mod dependence;
mod fit;
mod held_out;
mod limits;
mod new_motions;
mod plausibility;
mod sets;
mod stiction;
mod vacuous;
mod verdict;
pub(super) mod words;
mod would_help;
