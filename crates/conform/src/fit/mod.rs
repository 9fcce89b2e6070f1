//! The nominal model chosen for the smallest sets: parameters of the robot and of the correction of
//! its input are moved until the sets that enclose the recordings cost least.
//!
//! The paper identifies the model by least squares of torque, which predicts torque best, but is
//! not what makes sets small. Here the cost of the program itself is minimised, by linear programs
//! in the sets and the parameters together within a trust region; the cost of the program at the
//! new parameters decides each step. A pull toward the identified values keeps the fit from
//! covering only these motions; its weight is chosen by leaving one motion out.

pub(crate) mod data;
pub(crate) mod evaluation;
#[expect(clippy::module_inception, reason = "the folder and its main type share the noun")]
pub(crate) mod fit;
pub(crate) mod group;
pub(crate) mod pull;
pub(crate) mod record;
pub(crate) mod search;
pub(crate) mod slopes;
pub(crate) mod step;
pub(crate) mod unseen;

pub use fit::Fitted;
pub use record::{FitRecord, FittedParameter, GroupCost, TorquePrediction, UnseenMotion};
