//! Arms whose recorded torques drive models of their motion.
//!
//! [`setup()`] makes the [`Setup`](reachtube_conform::Setup) of a robot: the model that
//! [`ArmSettings`] select, and the [`Arm`] that turns recordings into its inputs. [`open`] reads a
//! model file with its setup again. [`OfArm`] and [`ArmModel`] return the robot of a problem and of
//! a model.
//!
//! # Examples
//!
//! ```
//! use reachtube_arm::{ArmModel, ArmSettings, setup};
//! use reachtube_conform::monitor::{Monitor, Schedule};
//! use reachtube_conform::{Job, Settings, Silent};
//! use reachtube_recordings::{MemoryRuns, Run, Torque};
//! use reachtube_robot::Robot;
//!
//! // Two runs of the arm at rest, a little apart.
//! let mut runs = MemoryRuns::default();
//! for offset in [0.0, 0.001] {
//!     let states = [vec![offset; 6], vec![0.0; 6]].concat().repeat(3);
//!     let run = Run::new(6, vec![0.0, 0.004, 0.008], states, vec![0.0; 18])?;
//!     runs.push(&format!("run{offset}"), Some("A"), None, run);
//! }
//! let arm = ArmSettings::new(Torque::Compensated, 6);
//! let setup = setup(Robot::lwa4p(), arm, Settings::default())?;
//! let answer = Job::new(setup, runs).run(&Silent)?;
//! assert!(answer.holds());
//! assert!((answer.model.initial_set.radius[0] - 0.0005).abs() < 1e-6);
//!
//! let model = &answer.model;
//! let mut monitor = Monitor::new(model, model.setup()?, Schedule::new(model, 0.004))?;
//! assert!(monitor.push(0.0, &[0.1; 6], &[0.0; 6], &[0.0; 6])?.is_empty());
//! // The arm jumps.
//! let left = monitor.push(0.004, &[0.2; 6], &[0.0; 6], &[0.0; 6])?;
//! assert!(left[0].proved && left[0].part == 1 && left[0].excess > 0.09);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arm;
mod basis;
mod cause;
mod causes;
mod correction;
mod corrector;
mod drive;
mod dry_friction;
mod friction;
mod input;
mod input_error;
mod kinematic;
mod less_friction;
mod live_input;
mod loads;
mod model;
mod parameters;
mod quantity;
mod record;
mod residual;
mod rising;
mod robot_equations;
mod settings;
mod setup;
mod signals;
mod system;

pub use arm::Arm;
pub use basis::{Basis, setup};
pub use correction::{InputCorrection, JointCorrection};
pub use less_friction::beyond_proof_of_stops;
pub use model::{ArmModel, model_schema, open, parse};
pub use record::DriveRecord;
pub use settings::{ArmSettings, Equations};
pub use setup::{OfArm, setup_of};
