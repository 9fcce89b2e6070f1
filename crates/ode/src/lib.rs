#![doc = include_str!("../README.md")]

mod dormand_prince;
mod ensemble;
mod outcome;
mod run;
mod runge_kutta;
mod step_control;
mod tableau;
mod vector_field;

pub use dormand_prince::DormandPrince;
pub use ensemble::Ensemble;
pub use outcome::{Cause, Outcome};
pub use run::InitialValueProblem;
pub use runge_kutta::RungeKutta4;
pub use step_control::Tolerance;
pub use vector_field::VectorField;
