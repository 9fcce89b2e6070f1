//! Files that are written whole or not at all, and JSON that carries its format and version.
//!
//! [`write::atomically`] writes through a temporary file beside the target, [`write::try_at`]
//! checks before a long job whether its result can be written, and [`json`] reads and writes
//! versioned files.

mod digest;
mod error;
pub mod json;
mod read;
pub mod write;

pub use digest::hex;
pub use error::{Error, Result};
pub use read::{read, read_text};

/// Name and version of the program, as every file that it writes records them.
pub const TOOL: &str = concat!("reachtube ", env!("CARGO_PKG_VERSION"));
