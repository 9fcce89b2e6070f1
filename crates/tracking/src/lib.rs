#![doc = include_str!("../README.md")]

mod basis;
mod check;
mod code;
mod defects;
mod delay;
mod error;
mod family;
mod fit;
mod links;
mod make;
mod model;
mod monitor;
mod motion;
mod noise;
mod plan;
mod recording;
mod slip;
mod tolerances;
mod words;

pub use check::{CheckedJoint, CheckedMotion, TrackingCheck};
pub use code::Code;
pub use error::{Error, Result};
pub use links::{TrackedLinks, Ways};
pub use make::{MadeModel, TriedFamily, make};
pub use model::{JointTracking, LinkTracking, NeedsOfMotions, RunOfModel, TrackingModel};
pub use monitor::{JudgedSample, TrackingMonitor};
pub use plan::PlanTube;
pub use recording::{Plan, Reading, TrackedRun};
pub use tolerances::PlanDeviations;
pub use words::width_up;
