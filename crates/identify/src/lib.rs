//! The nominal model from recordings: gravity, then friction, then inertia (step 1 of the paper,
//! its appendix).
//!
//! [`identify`] prepares recordings ([`prepare`]), fits gravity to poses at rest and slow motions,
//! friction (5) to (9) with the gravity torque for its load, and the inertial parameters to
//! exciting motions; makes the links bodies that can exist ([`feasible`]); and tries the robot on
//! recordings kept back.

mod error;
pub mod feasible;
mod fit;
pub mod friction;
mod gravity;
mod identification;
mod inertia;
pub mod prepare;
pub mod regression;
mod samples;
mod settings;
mod summary;
mod suspect;
mod validate;

pub use fit::{Fit, JointFit};
pub use friction::{FrictionFit, JointFriction};
pub use gravity::GravityFit;
pub use inertia::{BaseParameter, InertiaFit, PhysicalFit};
pub use settings::{IdentifySettings, ModelSettings, Prior};
pub use summary::Summary;
pub use suspect::Gain;
pub use validate::{JointError, LogValidation, TorqueTrace, WindowErrors};

pub use error::{Error, Result};
pub use identification::{Identification, identify};
