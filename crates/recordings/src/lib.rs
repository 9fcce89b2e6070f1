//! Recordings and test suites, read and checked.
//!
//! A data set is a folder of CSV runs with the header `t,q1..qn,qd1..qdn,tau1..taun` and an index
//! `runs.csv` that puts runs into test suites (Definition 2 of the paper: runs from one initial
//! state under one input).

mod data_set;
mod decimal;
mod defect;
mod error;
mod index;
mod inspect;
mod notes;
mod reading;
mod run;
mod torque;
mod units;

pub use data_set::{DataSet, SuiteEntry};
pub use defect::Defect;
pub use error::{Error, Result};
pub use index::RunEntry;
pub use inspect::{Group, Inspection, JointSummary, inspect};
pub use run::{GapLimit, Run};
pub use run::{column_names, state_name};
pub use torque::Torque;
pub use units::check_limits;
