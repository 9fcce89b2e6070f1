//! The nominal model from recordings: gravity, then friction, then inertia (step 1 of the paper, its appendix).

pub mod feasible;
pub mod prepare;
pub mod regression;
