//! Simple models of a robot's forward dynamics.
//!
//! A reachable-set computation needs a model ẋ = f_p(x, u) that is linear or polynomial. This crate
//! builds the three models of Liu and Althoff (IROS 2018, Sec. IV-B) from a
//! [`Robot`](reachtube_robot::Robot), at any order p and about any [`ExpansionPoint`].
//!
//! - [`PolynomialModel`] is the primary type: it evaluates f_p over numbers, SIMD lanes and
//!   intervals, and reads and writes its file. [`ModelKind`] chooses the model.
//! - [`linear_model`] returns model 1 of order 1 as a linear system.
//! - [`ModelField`] simulates a model, and [`Linearisation`] differentiates it along a motion.
//!   A model is a [`Nonlinear`](reachtube_reach::Nonlinear) system, which flowpipes enclose.
//!
//! # Examples
//!
//! ```
//! use reachtube_abstraction::{ExpansionPoint, ModelKind, PolynomialModel};
//! use reachtube_robot::Robot;
//!
//! let point = ExpansionPoint::zero(6);
//! let model = PolynomialModel::new(&Robot::lwa4p(), ModelKind::Two, 3, &point)?;
//!
//! // Accelerations of the joints (rad/s²) under 1 N m each, from rest at q = 0.1 rad.
//! let rate = model.rate(&model.state(&[0.1; 6], &[0.0; 6]), &[1.0; 6]);
//! assert!(rate[6..12].iter().all(|acceleration| acceleration.is_finite()));
//! # Ok::<(), reachtube_abstraction::Error>(())
//! ```

mod abstraction;
mod build;
mod error;
mod expansion_point;
mod field;
mod file;
mod formula;
mod layout;
mod limits;
mod linear_model;
mod linearisation;
mod model_kind;
mod nonlinear;
mod polynomial_model;
mod records;
mod systems;

pub use abstraction::Abstraction;
pub use error::{Error, RecordsError};
pub use expansion_point::ExpansionPoint;
pub use field::ModelField;
pub use file::file_schema;
pub use linear_model::linear_model;
pub use linearisation::Linearisation;
pub use model_kind::ModelKind;
pub use polynomial_model::PolynomialModel;
pub use records::{Records, TermRecord};
