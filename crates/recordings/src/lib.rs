//! Recordings of a robot and their test suites, read and checked.
//!
//! A data set is a folder of CSV runs with the header `t,q1..qn,qd1..qdn,tau1..taun` and an index
//! `runs.csv` that puts runs into test suites (Definition 2 of the paper: runs from one initial
//! state under one input).

mod data_set;
mod decimal;
mod defect;
mod error;
mod gap_limit;
mod index;
mod inspect;
mod memory;
mod notes;
mod reading;
mod run;
mod source;
mod state;
mod text;
mod torque;
mod units;

pub use data_set::DataSet;
pub use defect::Defect;
pub use error::{Error, Result};
pub use gap_limit::GapLimit;
pub use index::RunEntry;
pub use inspect::{Group, Inspection, JointSummary, inspect};
pub use memory::MemoryRuns;
pub use notes::{copies_note, run_notes};
pub use reading::read_csv;
pub use run::{Run, column_names};
pub use source::{ReadOptions, RunSource, SuiteEntry};
pub use state::{State, StateKind};
pub use torque::Torque;
pub use units::check_limits;
