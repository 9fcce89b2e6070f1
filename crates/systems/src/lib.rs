#![doc = include_str!("../README.md")]

mod arx;
mod check;
mod code;
mod conform;
mod description;
mod error;
mod findings;
mod form;
mod identify;
mod make;
mod model;
mod motion;
mod rows;
mod run;
mod system;
mod tube;
mod words;

pub use check::{CheckedRun, SystemCheck};
pub use code::Code;
pub use description::{
    BoxCentre, MatrixEntry, MatrixRows, NamedSignal, NominalStartRule, ScaleOf, SetDescription,
    SetDescriptions, ShapedSet, SignalUnit, SimpleSet, SystemDescription, SystemKind,
    SystemParameter,
};
pub use error::{Error, Result};
pub use form::ScaledSet;
pub use make::MadeSystem;
pub use model::{OutputWidth, OutputsAlone, RunsLeftOut, SystemModel, SystemRecording};
pub use rows::SystemSets;
pub use run::SystemRun;
pub use system::OutputSystem;
pub use tube::OutputTube;
