//! The nominal model from recordings: gravity, then friction, then inertia (step 1 of the paper, its appendix).

pub mod prepare;
