//! Gravity from poses at rest and slow motions, in alternation with friction.

pub(crate) mod alternation;
pub(crate) mod fit;
