use std::path::Path;

use crate::error::{Error, Result};

/// Reads a whole file.
///
/// # Errors
///
/// [`Error::Read`], whose message ends with `remedy`.
pub fn read(path: &Path, remedy: &'static str) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|source| Error::Read { path: path.into(), source, remedy })
}

/// Reads a whole text file, which must be UTF-8.
///
/// # Errors
///
/// [`Error::Read`], whose message ends with `remedy`.
pub fn read_text(path: &Path, remedy: &'static str) -> Result<String> {
    std::fs::read_to_string(path).map_err(|source| Error::Read {
        path: path.into(),
        source,
        remedy,
    })
}
