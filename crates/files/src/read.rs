use std::path::Path;

use crate::error::{Error, Result};

/// Reads a whole file.
///
/// # Errors
///
/// [`Error::Read`] with `remedy`, which says what to do.
pub fn read(path: &Path, remedy: &'static str) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|source| Error::Read { path: path.into(), source, remedy })
}

/// Reads a whole text file in UTF-8.
///
/// # Errors
///
/// [`Error::Read`] with `remedy`, which says what to do.
pub fn read_text(path: &Path, remedy: &'static str) -> Result<String> {
    std::fs::read_to_string(path).map_err(|source| Error::Read {
        path: path.into(),
        source,
        remedy,
    })
}
