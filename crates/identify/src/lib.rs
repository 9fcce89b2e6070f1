//! Identifies the nominal model of a robot from recordings: step 1 of the paper and its appendix.
//!
//! [`identify`] is the whole job. It takes a [`Robot`](reachtube_robot::Robot) with known geometry,
//! and [`IdentifySettings`] that name recordings. It returns an [`Identification`]: a robot
//! description with gravity, friction and inertial parameters, their standard errors, the errors on
//! validation recordings, and warnings.
//!
//! # Examples
//!
//! ```no_run
//! use reachtube_identify::{IdentifySettings, identify};
//! use reachtube_robot::Robot;
//! use std::path::Path;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let robot = Robot::load("arm.urdf")?;
//! let settings = IdentifySettings::from_toml(
//!     r#"
//!         rest = ["poses"]
//!         one_joint = ["slow"]
//!         excitation = ["a.csv", "b.csv"]
//!         validate = ["c.csv"]
//!     "#,
//!     "settings",
//! )?;
//! let progress = |done, steps| eprintln!("step {done} of {steps}");
//! let found = identify(&robot, &settings, Path::new("recordings"), &progress)?;
//! found.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
//! std::fs::write("arm.toml", found.robot_toml())?;
//! # Ok(())
//! # }
//! ```
//!
//! # Steps and modules
//!
//! 1. [`prepare`] reads recordings, samples them evenly, filters them without phase shift,
//!    differentiates them, and cuts them into windows.
//! 2. Gravity is fitted to poses at rest and slow motions (`GravityFit`). `friction` fits
//!    friction (5) to (9) to slow motions, with the gravity torque as its load. The two alternate.
//! 3. The inertial parameters are fitted to exciting motions ([`InertiaFit`]). [`bodies`] finds the
//!    physically consistent links nearest to the data.
//! 4. The identified robot predicts the torque of validation recordings ([`LogValidation`]) and
//!    their motion ([`WindowErrors`]). Implausible signs, gains ([`Gain`]) and residuals give
//!    warnings.
//!
//! `regression` is the least squares underneath; [`TriangularFactor`] holds its rows.

pub mod bodies;
mod error;
mod fit;
mod fitted;
mod friction;
mod gravity;
mod identification;
mod inertia;
mod inputs;
mod plausibility;
pub mod prepare;
mod regression;
mod report;
mod samples;
mod settings;
mod stiction;
mod summary;
mod validate;
mod variant;

pub use error::Error;
pub use fit::{Fit, JointFit};
pub use friction::falling::FallingFriction;
pub use friction::fit::{FrictionFit, JointFriction};
pub use friction::form::CoulombForm;
pub use identification::{Identification, identify, identify_unjudged};
pub use inertia::{BaseParameter, InertiaFit, PhysicalFit, SaturatingFriction};
pub use inputs::signals;
pub use plausibility::{Gain, Implausible, PositionOffset};
pub use regression::triangular_factor::TriangularFactor;
pub use settings::{IdentifySettings, ModelSettings};
pub use summary::Summary;
pub use validate::{JointError, LogValidation, TorqueTrace, WindowErrors};
