//! Recordings of a virtual robot that differs from its nominal model, as one data set: the paper's
//! whole experiment, a small one, or the logs of the demo.
//!
//! The experiment follows Sec. V-B and the appendix of the paper:
//!
//! - Random point-to-point motions are followed closed loop, and the torque is recorded. Each gives
//!   test suites that start at several of its points (Fig. 3) and apply that torque open loop.
//! - Static poses show gravity, slow motions of single joints show friction, and exciting motions
//!   show the inertial parameters.
//!
//! [`CampaignOptions::small`] has test suites only, some of them to try the sets on, and
//! [`CampaignOptions::demo`] exciting motions only; they take a second or two to make.
//!
//! The files are independent of each other, so that all cores are used, and each is written whole.
//! A campaign that was stopped continues where it ended, with the same bytes.

mod excitation;
mod folder;
mod job;
mod motion_series;
mod options;
mod plan;
mod readme;
mod record;
#[cfg(test)]
mod tests;

pub use options::CampaignOptions;
pub(crate) use options::campaign_options;
pub(crate) use plan::{PlannedSuite, planned_suites};
pub use record::{RecordedCampaign, record};
