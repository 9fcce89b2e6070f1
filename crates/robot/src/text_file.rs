//! Reading of text files, up to a size that no description has.

use std::fs::File;
use std::io::{Error as IoError, Read};
use std::path::Path;

use crate::error::RobotError;

/// Size of the largest file that is read, bytes. It also ends the reading of devices without end.
const LARGEST: u64 = 1 << 24;

/// Reads a text file of at most 16 MiB.
pub(crate) fn read_text(path: &Path) -> Result<String, RobotError> {
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_string(&mut text));
    let size = read.map_err(|source| RobotError::Read { path: path.into(), source })?;
    if size as u64 > LARGEST {
        let source = IoError::other(format!("it is larger than {} MiB", LARGEST >> 20));
        return Err(RobotError::Read { path: path.into(), source });
    }
    Ok(text)
}
