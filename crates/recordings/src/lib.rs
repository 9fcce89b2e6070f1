//! Recordings of a robot and their test suites, read and checked.
//!
//! A recording, or [`Run`], holds the positions, velocities and torques of all joints at its
//! samples. Runs that start from one state under one input form a test suite (Definition 2 of the
//! paper).
//!
//! - [`RunSource`] is the primary trait: it lists runs and suites, and reads runs one by one.
//!   [`DataSet`] is a folder of CSV files with the header `t,q1..qn,qd1..qdn,tau1..taun` and an
//!   index `runs.csv`; [`MemoryRuns`] holds runs in memory.
//! - Reading refuses a recording with a [`Defect`], and reports every one with line, joint and
//!   remedy. [`check_limits`] finds wrong units; [`run_notes`] and [`copies_note`] return notes.
//! - [`Torque`] states what the recorded torques mean.
//! - [`inspect()`] summarises a data set.
//! - [`read_logged`] reads CSV files of any header, as robots and drivers log them, by the same
//!   reader of numbers and defects.
//!
//! `docs/recordings.md` describes the format.
//!
//! # Examples
//!
//! ```
//! use reachtube_recordings::{DataSet, ReadOptions, RunSource};
//!
//! let folder = tempfile::tempdir()?;
//! std::fs::write(folder.path().join("runs.csv"), "file,suite\nfirst.csv,A\n")?;
//! let samples = "t,q1,qd1,tau1\n0.0,0.1,0.0,2.0\n0.1,0.1,0.0,2.0\n";
//! std::fs::write(folder.path().join("first.csv"), samples)?;
//!
//! let data = DataSet::open(folder.path())?;
//! let run = data.read(0, &ReadOptions::default()).expect("the recording has no defect");
//! assert_eq!((run.joints, run.len(), run.q(1)[0]), (1, 2, 0.1));
//! assert_eq!(data.suites()[0].name, "A");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;
mod checked;
mod data_set;
mod decimal;
mod defect;
mod error;
mod gap_limit;
mod index;
mod inspect;
mod inspect_run;
mod memory;
mod moving_rows;
mod notes;
mod order;
mod pattern;
mod preparation;
mod reading;
mod refusal;
mod resample;
mod run;
mod sample_error;
mod sensor_noise;
mod source;
mod state;
mod text;
mod torque;
mod units;
mod unwrap;

pub use axis::Axis;
pub use data_set::{DataSet, any_simulated, index_folder};
pub use decimal::picoseconds;
pub use defect::{Defect, DefectKind};
pub use error::Error;
pub use gap_limit::GapLimit;
pub use index::RunEntry;
pub use inspect::{Inspection, JointSummary, RunGroup, inspect, inspect_source};
pub use memory::MemoryRuns;
pub use moving_rows::{MovingRow, RowSketch, TimeShift};
pub use notes::{copies_note, run_notes};
pub use pattern::matching;
pub use preparation::Preparation;
pub use reading::{
    ColumnSettings, LogSettings, LogTime, Logged, LoggedOptions, NamedColumns, NamedRun,
    Understood, Wanted, group_files, is_commanded, parse_csv, parse_logged, read_csv, read_logged,
    read_logged_runs, read_named, table_files,
};
pub use refusal::Refusal;
pub use resample::{EvenSamples, Sample};
pub use run::{Run, RunError, column_names};
pub use sample_error::SampleError;
pub use sensor_noise::noise_deviations;
pub use source::{ReadOptions, RunSource, SuiteEntry};
pub use state::{State, StateKind};
pub use torque::Torque;
pub use units::{check_limits, dead_torques, integral_gap};
