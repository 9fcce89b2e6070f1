//! Enclosures against exact rational numbers, closed forms, brute force and simulated disturbances.

mod arm;
mod disturbances;
mod edges;
mod exponential;
mod gains;
mod grid;
mod lwa4p;
mod polynomial;
mod propagation;
mod random;
mod rational;
mod simulation;
mod systems;
mod taylor_models;
mod trigonometric;
mod tube;
