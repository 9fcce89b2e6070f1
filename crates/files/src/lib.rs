//! Files that are written whole or not at all, and JSON that carries its format and version.
//!
//! - [`write::atomically`] writes through a temporary file beside the target.
//! - [`write::try_at`] checks, before a long job, whether its result can be written.
//! - [`Overwrite`] decides which existing files may be replaced.
//! - [`json`] reads and writes versioned files; a [`SealedFile`] notices a change of its content.
//! - [`Journal`] keeps what a long job has finished.
//! - [`Kind`] says what an error is about.
//! - [`schema()`] gives the JSON schema of what a type writes.
//! - [`read`] and [`read_text`] read a file with an error that names it, and [`bytes`] without.
//!
//! # Examples
//!
//! ```
//! use reachtube_files::{json, read_text, write};
//!
//! let folder = tempfile::tempdir().unwrap();
//! let path = folder.path().join("counts.json");
//! let text = json::to_lines(&[1, 2, 3]);
//! write::atomically(&path, |out| out.write_all(text.as_bytes()))?;
//! assert_eq!(read_text(&path, "write the counts first")?, text);
//! # Ok::<(), reachtube_files::Error>(())
//! ```

mod digest;
mod error;
mod journal;
pub mod json;
mod kind;
mod names;
mod overwrite;
mod read;
mod schema;
mod sealed;
pub mod write;

pub use digest::hex;
pub use error::Error;
pub use journal::Journal;
pub use kind::{AnyError, ErrorKind, Kind};
pub use names::distinct_names;
pub use overwrite::{MARK, Overwrite, TOOL};
pub use read::{bytes, read, read_text};
pub use schema::{schema, schema_of_any};
pub use sealed::{FileHead, SealedFile};
