//! Output is written whole or not at all.

use std::io::{BufWriter, Write};
use std::path::Path;

use crate::error::{Error, Result};

/// Writes a file through a temporary one beside it that takes its name only when everything is on
/// disk. The folder is made if it is missing. A device or a pipe (/dev/stdout) is written to as it
/// is.
///
/// # Errors
///
/// [`Error::Write`]; a file that had the name before is as it was, and nothing else is left behind.
///
/// # Examples
///
/// ```
/// let folder = tempfile::tempdir().unwrap();
/// let path = folder.path().join("new/notes.txt");
/// reachtube_files::write::atomically(&path, |out| out.write_all(b"whole"))?;
/// assert_eq!(std::fs::read(&path).unwrap(), b"whole");
/// # Ok::<(), reachtube_files::Error>(())
/// ```
pub fn atomically(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<()> {
    let attempt = || {
        if is_special(path) {
            return write(&mut std::fs::OpenOptions::new().write(true).open(path)?);
        }
        // What a link leads to is replaced, not the link.
        let path = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        let folder = folder_of(&path);
        std::fs::create_dir_all(folder)?;
        let file = temporary_in(folder)?;
        let mut buffer = BufWriter::new(file.as_file());
        write(&mut buffer)?;
        buffer.into_inner().map_err(|error| error.into_error())?.sync_all()?;
        file.persist(path).map_err(|error| error.error)?;
        Ok(())
    };
    attempt().map_err(|source| Error::Write { path: path.to_path_buf(), source })
}

/// Tries, before a long job, whether a file can be written at `path` when it is done. Nothing is
/// left behind.
///
/// # Errors
///
/// [`Error::Write`] when `path` is a folder, or no file can be made in its folder or, where that is
/// missing, in the nearest one above.
pub fn try_at(path: &Path) -> Result<()> {
    let attempt = || {
        if path.is_dir() {
            return Err(std::io::Error::new(std::io::ErrorKind::IsADirectory, "it is a folder"));
        }
        if is_special(path) {
            return Ok(());
        }
        let path = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        let nearest = folder_of(&path).ancestors().find(|folder| folder.exists());
        temporary_in(nearest.unwrap_or(Path::new("."))).map(drop)
    };
    attempt().map_err(|source| Error::Write { path: path.to_path_buf(), source })
}

/// A device or a pipe: it is written to, where a file is replaced.
fn is_special(path: &Path) -> bool {
    path.metadata().is_ok_and(|data| !data.is_file() && !data.is_dir())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

#[cfg(unix)]
fn temporary_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    use std::os::unix::fs::PermissionsExt;
    // As any new file: the umask decides, not the privacy of a temporary file.
    tempfile::Builder::new()
        .permissions(std::fs::Permissions::from_mode(0o666))
        .tempfile_in(folder)
        .map_err(unnamed)
}

#[cfg(not(unix))]
fn temporary_in(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    tempfile::NamedTempFile::new_in(folder).map_err(unnamed)
}

/// The error without the name of the temporary file, which would only puzzle.
fn unnamed(error: std::io::Error) -> std::io::Error {
    error.kind().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_tried_without_a_trace() {
        let folder = tempfile::tempdir().unwrap();
        try_at(&folder.path().join("new/deep/model.json")).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        assert!(try_at(folder.path()).unwrap_err().to_string().contains("it is a folder"));
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        assert!(try_at(&file.join("model.json")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_what_it_leads_to_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (link, file) = (folder.path().join("link"), folder.path().join("file"));
        std::fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        atomically(&link, |out| out.write_all(b"new")).unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&file).unwrap(), b"new");
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        atomically(&path, |out| out.write_all(b"old")).unwrap();
        let full = |out: &mut dyn Write| {
            out.write_all(b"half of the new")?;
            Err(std::io::Error::other("the disk is full"))
        };
        let error = atomically(&path, full).unwrap_err().to_string();
        assert!(error.contains("model.json") && error.contains("the disk is full"), "{error}");
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
