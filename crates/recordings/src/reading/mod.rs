//! The one reader of recordings in text: of the format of `docs/recordings.md`, and as robots and
//! drivers log them, with columns of any name, order, unit and separator.
//!
//! [`Table`](table::Table) reads the numbers of some columns of a file, and finds all defects. The
//! header `t,q1..qn,qd1..qdn,tau1..taun` is one assignment of columns ([`canonical`]). For others,
//! [`read_logged`] matches columns with joints by their names, recognises units from the numbers,
//! and says what it did. What is ambiguous is refused with the setting that decides it.

mod assignment;
mod canonical;
mod command;
mod content;
mod dialect;
mod digits;
mod even_times;
mod files;
mod joints;
mod log;
mod log_settings;
mod name;
mod named;
mod number;
mod options;
#[cfg(feature = "parquet")]
mod parquet;
mod read;
mod recognise;
mod row;
mod runs;
mod settings;
mod table;
mod time_column;
mod understood;
mod unit;

pub use canonical::{parse_csv, read_csv};
pub use files::{group_files, table_files};
pub use log::Logged;
pub use log_settings::{LogSettings, LogTime};
pub use name::is_commanded;
pub use named::{NamedColumns, NamedRun, read_named};
pub use options::{LoggedOptions, Wanted};
pub use read::{parse_logged, read_logged, read_logged_runs};
pub use settings::ColumnSettings;
pub use understood::Understood;
