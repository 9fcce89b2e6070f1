//! Files that are written whole or not at all.

use std::io::{BufWriter, Write};
use std::path::Path;

use tempfile::{Builder, NamedTempFile};

use crate::error::{Error, Result};

/// Writes a file through a temporary one beside it, which takes the file's name only when all its
/// bytes are on disk. The folder is created if it is missing. A device or a pipe (/dev/stdout) is
/// written to directly.
///
/// # Errors
///
/// [`Error::Write`] where the file cannot be written. An older file of this name is then as it was,
/// and no other file remains.
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
        // The target of a link is replaced, not the link.
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

/// Checks, before a long job, that a file can be written at `path` when it is done. No file
/// remains, and what a killed program left in its folder goes as in [`remove_left_over`].
///
/// # Errors
///
/// [`Error::Write`] when `path` is a folder, or when no file can be created in its folder. Where
/// that folder is missing, the nearest existing one above it is checked; [`Error::NotFolder`] if
/// that is a file.
pub fn try_at(path: &Path) -> Result<()> {
    let attempt = || {
        if path.is_dir() {
            return Err(std::io::Error::new(std::io::ErrorKind::IsADirectory, "it is a folder"));
        }
        if is_special(path) {
            return Ok(());
        }
        let path = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        remove_left_over(folder_of(&path));
        temporary_in(nearest(&path)).map(drop)
    };
    if !nearest(path).is_dir() {
        return Err(Error::NotFolder { path: nearest(path).to_path_buf() });
    }
    attempt().map_err(|source| Error::Write { path: path.to_path_buf(), source })
}

/// Removes temporary files of this library from a folder. They remain where a program was killed;
/// a program that still runs has locked its own, and keeps them.
pub fn remove_left_over(folder: &Path) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let files = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_file()));
    for path in files.map(|entry| entry.path()).filter(|path| is_temporary(path)) {
        // A file that stays is only in the way.
        let Ok(file) = std::fs::File::open(&path) else { continue };
        if file.try_lock().is_ok() {
            let _ = std::fs::remove_file(path);
        }
    }
}

/// What the names of temporary files begin with, before some letters and digits.
const PREFIX: &str = ".reachtube-";

/// What the names of temporary files end with.
const SUFFIX: &str = ".tmp";

fn is_temporary(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let middle = name.strip_prefix(PREFIX).and_then(|rest| rest.strip_suffix(SUFFIX));
    middle.is_some_and(|random| {
        random.len() == 6 && random.bytes().all(|b| b.is_ascii_alphanumeric())
    })
}

/// Returns whether `path` is a device or a pipe, which is written to directly.
fn is_special(path: &Path) -> bool {
    path.metadata().is_ok_and(|data| !data.is_file() && !data.is_dir())
}

/// Returns the folder of a file, or the nearest path above it that exists.
fn nearest(path: &Path) -> &Path {
    let nearest = folder_of(path).ancestors().find(|folder| folder.exists());
    nearest.unwrap_or(Path::new("."))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes a temporary file in a folder, and locks it.
fn temporary_in(folder: &Path) -> std::io::Result<NamedTempFile> {
    loop {
        let mut builder = Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        // The umask decides who may read the file, as for any new file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(folder).map_err(unnamed)?;
        // Where a file system has no locks, nothing that is left over is removed.
        let _ = file.as_file().lock();
        // Another program may have removed it before it was locked.
        if file.path().exists() {
            return Ok(file);
        }
    }
}

/// Returns the error without the name of the temporary file, which means nothing to users.
fn unnamed(error: std::io::Error) -> std::io::Error {
    error.kind().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        try_at(&folder.path().join("new/deep/model.json")).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        assert!(try_at(folder.path()).unwrap_err().to_string().contains("it is a folder"));
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        assert!(try_at(&file.join("model.json")).is_err());
    }

    #[test]
    fn what_a_killed_program_left_goes_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let kept = [".reachtube-notes.tmp", ".reachtube-AbC12.tmp", ".tmpAbC123", "a.tmp"];
        kept.iter().for_each(|name| std::fs::write(path(name), "mine").unwrap());
        std::fs::create_dir(path(".reachtube-folder.tmp")).unwrap();
        let left = path(".reachtube-AbC123.tmp");
        std::fs::write(&left, "half of the ol").unwrap();
        atomically(&path("model.json"), |out| {
            // A job that begins while this one writes.
            try_at(&path("page.html")).unwrap();
            out.write_all(b"whole")
        })
        .unwrap();
        assert!(!left.exists());
        assert_eq!(std::fs::read(path("model.json")).unwrap(), b"whole");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), kept.len() + 2);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_its_target_is_replaced() {
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
