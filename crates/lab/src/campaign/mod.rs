//! A whole experiment as in the paper on a virtual robot: recordings to identify it with, and test
//! suites of random motions, as one data set.
//!
//! The experiment follows Sec. V-B and of the appendix:
//!
//! - Random point-to-point motions are followed closed loop, and the torque is recorded. Each gives
//!   test suites that start at several of its points (Fig. 3) and apply that torque open loop.
//! - Static poses show gravity, slow motions of single joints show friction, and exciting motions
//!   show the inertial parameters.
//!
//! The files are independent of each other, so that both cores are used, and each is written whole.
//! A campaign that was stopped goes on where it ended, with the same bytes.

pub(crate) mod error;
mod excitation;
mod folder;
mod job;
mod joint_motion;
mod mark;
mod options;
mod plan;
mod planned;
mod pose_series;
mod readme;
mod record;
#[cfg(test)]
mod tests;

pub use error::CampaignError;
pub(crate) use job::PlannedSuite;
pub use options::CampaignOptions;
pub(crate) use planned::planned_suites;
pub use record::{RecordedCampaign, record};
