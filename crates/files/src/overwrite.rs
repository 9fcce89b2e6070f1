use std::io::Read;
use std::path::Path;

use crate::error::{Error, Result};
use crate::write;

/// Length of the start of a file in which a mark is looked for, bytes.
const HEAD: u64 = 4096;

/// Name and version of the program, which every file that it writes records.
pub const TOOL: &str = concat!("reachtube ", env!("CARGO_PKG_VERSION"));

/// Sentence in the comment that marks text files of reachtube which are not JSON.
pub const MARK: &str = "Written by reachtube";

/// The starts of files that reachtube wrote hold one of these.
const MARKS: [&str; 3] = ["\"format\": \"reachtube-", "\"format\":\"reachtube-", MARK];

/// Existing files that a command may replace.
///
/// # Examples
///
/// ```
/// use reachtube_files::Overwrite;
///
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("runs.csv");
/// assert!(Overwrite::Own.check(&path).is_ok());
/// std::fs::write(&path, "file,suite\n").unwrap();
/// assert!(Overwrite::Own.check(&path).unwrap_err().to_string().contains("--force"));
/// assert!(Overwrite::Any.check(&path).is_ok());
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Overwrite {
    /// Files that carry a mark of reachtube: versioned JSON, and text with [`MARK`] in its first
    /// 4 KiB. CSV files carry no mark.
    #[default]
    Own,
    /// Every file.
    Any,
}

impl Overwrite {
    /// Checks, before a long job, that a file can be written at `path` when it is done, and that no
    /// file is lost by it. No file remains.
    ///
    /// # Errors
    ///
    /// [`Error::Exists`] for a file that may not be replaced, and the errors of [`write::try_at`].
    pub fn check(self, path: &Path) -> Result<()> {
        write::try_at(path)?;
        // A device or a pipe holds nothing that can be lost.
        let is_lost = path.is_file() && self == Self::Own && !is_ours(path);
        if is_lost { Err(Error::Exists { path: path.into() }) } else { Ok(()) }
    }
}

/// Returns whether a file carries a mark of reachtube. An empty file holds nothing to lose.
fn is_ours(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    let text = String::from_utf8_lossy(&head);
    read.is_ok() && (head.is_empty() || MARKS.iter().any(|mark| text.contains(mark)))
}

#[cfg(test)]
mod tests {
    use super::{MARK, Overwrite};

    #[test]
    fn files_of_others_are_kept_and_own_ones_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let allowed = |content: &[u8]| {
            std::fs::write(&path, content).unwrap();
            assert!(Overwrite::Any.check(&path).is_ok());
            Overwrite::Own.check(&path).is_ok()
        };
        let marked = format!("# {MARK} identify\nname = \"arm\"\n");
        let own = ["", "{\n  \"format\": \"reachtube-model\",", &marked];
        assert!(own.iter().all(|content| allowed(content.as_bytes())));
        let late = format!("{}{MARK}", " ".repeat(5000));
        let others =
            ["t,q1,qd1,tau1\n", "name = \"reachtube arm\"", "{\"format\": \"mine\"}", &late];
        assert!(others.iter().all(|content| !allowed(content.as_bytes())));
        assert!(!allowed(&[0xff, 0xfe, 0]));
    }
}
