//! Files that are compressed as a whole, as rosbag2 writes them in its mode `file`.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::error::{Error, Result};
use crate::loss::Loss;

/// Most bytes that are decompressed.
const LARGEST: u64 = 1 << 36;

/// Returns the content of a file in zstd as a temporary file, which is deleted with the result.
///
/// # Errors
///
/// [`Error::Damaged`] if the file ends early or is damaged, unless `recover`; then the result ends
/// there. [`Error::Format`] if its content has more than 64 GiB.
pub(crate) fn decompressed(path: &Path, recover: bool) -> Result<NamedTempFile> {
    let unreadable =
        |source, remedy| reachtube_files::Error::Read { path: path.into(), source, remedy };
    let open = || zstd::Decoder::new(File::open(path)?);
    let decoder = open().map_err(|e| unreadable(e, "check the path and its permissions"))?;
    let room = "free space in the temporary folder for the decompressed file";
    let mut plain = NamedTempFile::new().map_err(|error| unreadable(error, room))?;
    let mut content = Checked { inner: decoder.take(LARGEST), fault: None };
    let written = io::copy(&mut content, plain.as_file_mut());
    if let Some(fault) = content.fault {
        let problem = format!("its compression by zstd is damaged ({fault})");
        if !recover {
            return Err(Error::Damaged(Loss::new(path, None, problem)));
        }
    } else if written.map_err(|error| unreadable(error, room))? == LARGEST {
        let problem = format!("its content has more than {LARGEST} bytes; cut the log");
        return Err(Error::Format { path: path.into(), problem });
    }
    Ok(plain)
}

/// A reader that ends where another one fails, and keeps the error.
struct Checked<R> {
    inner: R,
    fault: Option<io::Error>,
}

impl<R: Read> Read for Checked<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.inner.read(buffer).or_else(|error| match error.kind() {
            io::ErrorKind::Interrupted => Err(error),
            _ => {
                self.fault = Some(error);
                Ok(0)
            }
        })
    }
}
