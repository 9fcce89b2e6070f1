use std::io::{Error as IoError, Read};
use std::path::Path;

use crate::error::{Error, Result};

/// Size of the largest file that is read, bytes. It also ends the reading of devices without end.
const LARGEST: u64 = 1 << 29;

/// Reads a whole file of at most 512 MiB.
///
/// # Errors
///
/// [`Error::Read`], whose message ends with `remedy`.
pub fn read(path: &Path, remedy: &'static str) -> Result<Vec<u8>> {
    bytes(path).map_err(|source| Error::Read { path: path.into(), source, remedy })
}

/// Reads a whole text file of at most 512 MiB, which must be UTF-8.
///
/// # Errors
///
/// [`Error::Read`], whose message ends with `remedy`.
pub fn read_text(path: &Path, remedy: &'static str) -> Result<String> {
    bytes(path)
        .and_then(|bytes| {
            String::from_utf8(bytes).map_err(|_| IoError::other("it is not UTF-8 text"))
        })
        .map_err(|source| Error::Read { path: path.into(), source, remedy })
}

/// Reads a whole file of at most 512 MiB.
///
/// # Errors
///
/// The operating system's, and one for a larger file.
pub fn bytes(path: &Path) -> std::io::Result<Vec<u8>> {
    limited(std::fs::File::open(path)?, LARGEST)
}

fn limited(file: std::fs::File, largest: u64) -> std::io::Result<Vec<u8>> {
    let too_large = || IoError::other(format!("it is larger than {} MiB", largest >> 20));
    let expected = file.metadata()?.len();
    if expected > largest {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(expected as usize + 1);
    file.take(largest + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest { Err(too_large()) } else { Ok(bytes) }
}

#[cfg(test)]
mod tests {
    use super::limited;

    #[test]
    fn a_file_larger_than_the_limit_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, vec![b' '; 1 << 20]).unwrap();
        let read = |largest| limited(std::fs::File::open(&path).unwrap(), largest);
        assert_eq!(read(1 << 20).unwrap().len(), 1 << 20);
        assert!(read((1 << 20) - 1).unwrap_err().to_string().contains("larger than 0 MiB"));
    }

    #[cfg(unix)]
    #[test]
    fn a_device_without_end_is_refused() {
        let zeros = std::fs::File::open("/dev/zero").unwrap();
        assert!(limited(zeros, 1 << 20).unwrap_err().to_string().contains("larger than 1 MiB"));
    }
}
