//! The names of a conformance from recordings to an answer.

#[cfg(feature = "report")]
pub use reachtube_lab::Result;

pub use reachtube_arm::{ArmModel, ArmSettings, OfArm, setup};
pub use reachtube_conform::{
    Answer, Check, CheckJob, Job, Model, Noise, Notion, Settings, Silent, Tube,
};
pub use reachtube_finding::Finding;
pub use reachtube_recordings::{DataSet, Torque};
pub use reachtube_robot::Robot;
