//! Enclosures against exact rational numbers, closed forms, brute force and simulated disturbances.

mod arm;
mod automatic;
mod disturbances;
mod edges;
mod exponential;
mod grid;
mod input_gains;
mod linearisation;
mod lwa4p;
mod membership;
mod outcomes;
mod propagation;
mod random;
mod random_systems;
mod rational;
mod simulated_case;
mod simulation;
mod systems;
mod taylor_models;
mod trigonometric;
mod tube;
