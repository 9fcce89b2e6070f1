//! Recordings as robots and drivers log them: columns of any name, order, unit and separator.
//!
//! [`read_logged`] matches columns with joints by their names, recognises units from the numbers,
//! and says what it did. What is ambiguous is refused with the setting that decides it.

mod assignment;
mod dialect;
mod files;
mod joints;
mod log_settings;
mod name;
mod numbers;
mod options;
mod pattern;
mod recognise;
mod recording;
mod settings;
mod time_column;
mod understood;
mod unit;

pub use files::{csv_files, group_files, is_recording};
pub use log_settings::{LogSettings, LogTime};
pub use options::LoggedOptions;
pub use recording::{Logged, read_logged};
pub use settings::ColumnSettings;
pub use understood::Understood;
pub use unit::{AngleUnit, TimeUnit};
