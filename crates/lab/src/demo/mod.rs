//! Recordings of a virtual robot that differs from its nominal model, to try everything on; they
//! take a second or two to make.
//!
//! It is a small case of a [`campaign`](crate::campaign): test suites of random motions only, some
//! of them to calibrate the sets and to try them on.

mod data_folder;
pub(crate) mod error;
mod options;
mod plan;
mod record;
#[cfg(test)]
mod tests;

pub use error::DemoError;
pub use options::DemoOptions;
pub use record::{RecordedDemo, record};
