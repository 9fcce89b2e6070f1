//! Preparation of recordings for regression.
//!
//! [`read`](fn@read) reads recordings, [`cut_off`](fn@cut_off) chooses the cut-off frequency of the
//! low-pass, and [`prepare`] samples evenly, filters without phase shift and differentiates.
//! [`windows`](fn@windows) cuts prepared recordings into test suites. Every change is reported as a
//! sentence.

mod align;
pub(crate) mod changes;
mod container;
pub(crate) mod cut_off;
mod derivative;
pub(crate) mod entry;
mod lag;
mod live;
pub(crate) mod log;
mod low_pass;
mod noise;
mod past;
pub(crate) mod prepared;
pub(crate) mod raw_log;
pub(crate) mod read;
mod resample;
pub(crate) mod rest;
pub(crate) mod settings;
mod signals;
mod spectrum;
pub(crate) mod survey;
pub(crate) mod turns;
pub(crate) mod velocity;
mod windows;

pub use cut_off::cut_off;
pub use entry::LogEntry;
pub use live::LiveLog;
pub use log::PreparedLog;
pub use noise::noise_left;
pub use prepared::{Prepared, prepare, shortest, unfiltered};
pub use raw_log::{Flaw, FlawOutcome, RawLog};
pub use read::read;
pub use resample::median_step;
pub use settings::{PrepareSettings, VelocitySource};
pub use windows::{Window, Windows, check_window, windows};
