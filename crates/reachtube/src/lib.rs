#![doc = include_str!("../README.md")]

pub mod export;
pub mod prelude;

pub use reachtube_abstraction::{
    self as abstraction, Abstraction, ExpansionPoint, ModelKind, PolynomialModel,
};
pub use reachtube_arm as arm;
pub use reachtube_conform::{
    self as conform, Check, Conformance, Keep, Model, Problem, Progress, Settings, Setup, Silent,
    Tube, check, conform, reach,
};
pub use reachtube_diagnose::axes;
pub use reachtube_files::{TOOL, write};
pub use reachtube_finding as finding;
pub use reachtube_identify::{self as identify, Identification, identify};
#[cfg(feature = "report")]
pub use reachtube_lab::{Error, Result, campaign, reproduce, virtual_robot};
#[cfg(feature = "report")]
pub use reachtube_page as page;
pub use reachtube_pipeline as pipeline;
pub use reachtube_reach::{
    self as reach, Disturbance, Flowpipe, FlowpipeSettings, Hyperrectangle, PolynomialSystem,
    TimeGrid, UncertainInput,
};
pub use reachtube_recordings::{self as recordings, DataSet, MemoryRuns, Run, RunSource, Torque};
pub use reachtube_robot::{self as robot, Robot};
pub use reachtube_scalar::{self as scalar, number};
pub use reachtube_systems as systems;
pub use reachtube_tracking as tracking;
pub use reachtube_verify as verify;
