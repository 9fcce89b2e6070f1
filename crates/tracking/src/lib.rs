#![doc = include_str!("../README.md")]

mod basis;
mod check;
mod code;
mod defects;
mod error;
mod family;
mod fit;
mod links;
mod make;
mod model;
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
pub use links::{LinkTracking, Links, Ways};
pub use make::{MadeModel, TriedFamily, make};
pub use model::{JointTracking, NeedsOfMotions, RunOfModel, TrackingModel};
pub use plan::{Plan, PlanTube};
pub use recording::{Reading, TrackedRun};
pub use tolerances::Deviations;
pub use words::width_up;
