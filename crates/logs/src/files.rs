//! The files of a log, and their format.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::container::{Contents, LogFile, Receive, WantedTopics};
use crate::error::{Error, Result};

/// Starts of files, with what they are.
const STARTS: [(&[u8], Format); 4] = [
    (b"\x89MCAP0\r\n", Format::Mcap),
    (b"SQLite format 3\0", Format::Sqlite),
    (b"#ROSBAG V", Format::RosBag1),
    (b"\x28\xb5\x2f\xfd", Format::Zstd),
];

#[derive(Debug, Clone, Copy)]
enum Format {
    Mcap,
    Sqlite,
    RosBag1,
    Zstd,
}

/// Returns the file itself, or the parts of the bag in a folder in the order of their numbers.
pub(crate) fn files_of(path: &Path) -> Result<Vec<PathBuf>> {
    let unreadable = |source| reachtube_files::Error::Read {
        path: path.into(),
        source,
        remedy: "give an MCAP file, a .db3 file, or the folder of a bag",
    };
    if !path.metadata().map_err(unreadable)?.is_dir() {
        return Ok(vec![path.into()]);
    }
    let parts = parts_of(path).map_err(unreadable)?;
    if parts.is_empty() {
        let problem = "the folder has no .mcap and no .db3 file; give the folder of a bag".into();
        return Err(Error::Format { path: path.into(), problem });
    }
    Ok(parts)
}

/// Returns the logs among files and folders: the path itself if it is a log, and of a folder its
/// .mcap and .db3 files and the folders of bags in it. If the folder has none, returns the ones in
/// its subfolders. The folder of a bag has a file `metadata.yaml`.
///
/// # Errors
///
/// [`reachtube_files::Error::Read`] for a folder that cannot be read.
pub(crate) fn logs_in(path: &Path) -> Result<Vec<PathBuf>, reachtube_files::Error> {
    let unreadable = |source| reachtube_files::Error::Read {
        path: path.into(),
        source,
        remedy: "give a log, or a folder of logs",
    };
    let is_folder = path.metadata().map_err(unreadable)?.is_dir();
    if (!is_folder && has_ending(path)) || is_bag(path) {
        return Ok(vec![path.into()]);
    }
    if !is_folder {
        return Ok(vec![]);
    }
    let below = folders_of(path).map_err(unreadable)?;
    let inside = |folder: &Path, below: &[PathBuf]| -> std::io::Result<Vec<PathBuf>> {
        let mut found = parts_of(folder)?;
        found.extend(below.iter().filter(|folder| is_bag(folder)).cloned());
        found.sort();
        Ok(found)
    };
    let mut found = inside(path, &below).map_err(unreadable)?;
    if found.is_empty() {
        for folder in below {
            let further = folders_of(&folder).map_err(unreadable)?;
            found.extend(inside(&folder, &further).map_err(unreadable)?);
        }
    }
    Ok(found)
}

fn is_bag(path: &Path) -> bool {
    path.join("metadata.yaml").is_file() && parts_of(path).is_ok_and(|parts| !parts.is_empty())
}

fn folders_of(path: &Path) -> std::io::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(path)?.flatten().map(|entry| entry.path());
    let mut folders: Vec<PathBuf> = entries.filter(|path| path.is_dir()).collect();
    folders.sort();
    Ok(folders)
}

/// Returns the .mcap and .db3 files in a folder, in the order of their numbers. A file that is
/// compressed as a whole does not count beside what was decompressed of it.
fn parts_of(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder)?.flatten();
    let is_part = |path: &PathBuf| has_ending(path) && path.is_file();
    let mut parts: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_part).collect();
    parts.retain(|part| !is_compressed(part) || !part.with_extension("").is_file());
    parts.sort_by_key(|part| (number_of(part), part.clone()));
    Ok(parts)
}

/// Returns whether the name of a file is one of a log.
fn has_ending(path: &Path) -> bool {
    let plain = if is_compressed(path) { path.with_extension("") } else { path.into() };
    plain.extension().is_some_and(|extension| extension == "mcap" || extension == "db3")
}

/// Returns whether a file is compressed as a whole, by its name.
fn is_compressed(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "zstd" || extension == "zst")
}

/// Returns the number at the end of a file's name, as in `bag_12.db3` and `bag_12.db3.zstd`.
fn number_of(path: &Path) -> Option<u64> {
    let name = path.file_name()?.to_str()?;
    name.split('.').next()?.rsplit('_').next()?.parse().ok()
}

/// Reads a file of any format that was built in, also if it is compressed as a whole.
pub(crate) fn scan(
    path: &Path,
    wanted: WantedTopics<'_>,
    recover: bool,
    receive: &mut Receive<'_>,
) -> Result<Contents> {
    let start = start_of(path, path)?;
    if !matches!(format_of(&start), Some(Format::Zstd)) {
        return scan_content(LogFile { path, content: path }, &start, wanted, recover, receive);
    }
    let plain = decompressed(path, recover)?;
    let content = plain.as_ref();
    let start = start_of(path, content)?;
    scan_content(LogFile { path, content }, &start, wanted, recover, receive)
}

/// Returns the first bytes of `content`, which the file `path` has.
fn start_of(path: &Path, content: &Path) -> Result<Vec<u8>> {
    let mut start = vec![];
    let read = File::open(content).and_then(|file| file.take(16).read_to_end(&mut start));
    read.map_err(|source| reachtube_files::Error::Read {
        path: path.into(),
        source,
        remedy: "check the path and its permissions",
    })?;
    Ok(start)
}

fn format_of(start: &[u8]) -> Option<Format> {
    STARTS.iter().find(|(magic, _)| start.starts_with(magic)).map(|(_, format)| *format)
}

/// Reads a file that is not compressed as a whole and starts with `start`.
fn scan_content(
    file: LogFile<'_>,
    start: &[u8],
    wanted: WantedTopics<'_>,
    recover: bool,
    receive: &mut Receive<'_>,
) -> Result<Contents> {
    let problem = match format_of(start) {
        Some(Format::Mcap) => return mcap(file, wanted, recover, receive),
        Some(Format::Sqlite) => return sqlite(file, wanted, recover, receive),
        Some(Format::RosBag1) => {
            "it is a bag of ROS 1; convert it with rosbags-convert of the Python package rosbags"
        }
        Some(Format::Zstd) => "it is compressed as a whole twice; decompress it with zstd -d",
        None if start.is_empty() => "the file is empty, so nothing can be recovered",
        None => "it is neither MCAP nor SQLite (.db3); give a log in one of these formats",
    };
    Err(Error::Format { path: file.path.into(), problem: problem.into() })
}

#[cfg(any(feature = "mcap", feature = "rosbag"))]
use crate::compressed::decompressed;

#[cfg(not(any(feature = "mcap", feature = "rosbag")))]
fn decompressed(path: &Path, _: bool) -> Result<PathBuf> {
    Err(not_built_in(path, "mcap"))
}

#[cfg(feature = "mcap")]
use crate::mcap_file::scan as mcap;

#[cfg(feature = "rosbag")]
use crate::bag_file::scan as sqlite;

#[cfg(not(feature = "mcap"))]
fn mcap(file: LogFile<'_>, _: WantedTopics<'_>, _: bool, _: &mut Receive<'_>) -> Result<Contents> {
    Err(not_built_in(file.path, "mcap"))
}

#[cfg(not(feature = "rosbag"))]
fn sqlite(
    file: LogFile<'_>,
    _: WantedTopics<'_>,
    _: bool,
    _: &mut Receive<'_>,
) -> Result<Contents> {
    Err(not_built_in(file.path, "rosbag"))
}

#[cfg(not(all(feature = "mcap", feature = "rosbag")))]
fn not_built_in(path: &Path, feature: &str) -> Error {
    let problem = format!("its format is not built in; build with the feature {feature}");
    Error::Format { path: path.into(), problem }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{files_of, logs_in};

    #[test]
    fn the_parts_of_a_bag_are_in_the_order_of_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["bag_10.db3", "bag_9.db3", "metadata.yaml"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let files = files_of(folder.path()).unwrap();
        let names: Vec<_> = files.iter().map(|file| file.file_name().unwrap()).collect();
        assert_eq!(names, ["bag_9.db3", "bag_10.db3"]);
        let none = tempfile::tempdir().unwrap();
        assert!(files_of(none.path()).unwrap_err().to_string().contains("no .mcap and no .db3"));
        std::fs::write(folder.path().join("bag_11.db3.zstd"), "").unwrap();
        std::fs::write(folder.path().join("bag_9.db3.zstd"), "").unwrap();
        let files = files_of(folder.path()).unwrap();
        let names: Vec<_> = files.iter().map(|file| file.file_name().unwrap()).collect();
        assert_eq!(names, ["bag_9.db3", "bag_10.db3", "bag_11.db3.zstd"]);
        assert!(files_of(Path::new("missing.mcap")).unwrap_err().to_string().contains("missing"));
    }

    #[test]
    fn the_logs_of_a_folder_are_its_files_and_its_bags() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        };
        let files = ["day/bag/metadata.yaml", "day/bag/bag_0.db3", "day/b.mcap", "day/a.csv"];
        files.into_iter().for_each(write);
        let day = folder.path().join("day");
        let expected = [day.join("b.mcap"), day.join("bag")];
        assert_eq!(logs_in(&day).unwrap(), expected);
        assert_eq!(logs_in(folder.path()).unwrap(), expected);
        assert_eq!(logs_in(&day.join("bag")).unwrap(), [day.join("bag")]);
        assert_eq!(logs_in(&day.join("a.csv")).unwrap().len(), 0);
        assert!(logs_in(&day.join("missing")).is_err());
    }
}
