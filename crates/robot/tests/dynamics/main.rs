//! The crate against independent oracles, identities of its algorithms, and errors of invalid
//! robots.

mod base_parameters;
mod close;
mod description;
mod excitation;
mod identities;
mod lanes;
mod locks;
mod lwa4p;
mod physicality;
mod pinocchio;
mod polynomials;
mod prismatic;
mod random;
mod regressor;
mod shared;
mod simulation;
mod urdf;
mod warmth;
