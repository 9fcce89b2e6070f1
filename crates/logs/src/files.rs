//! The files of a log, and their format.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::container::{Contents, Receive, WantedTopics};
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
    let is_part = |path: &PathBuf| {
        path.extension().is_some_and(|extension| extension == "mcap" || extension == "db3")
    };
    let entries = std::fs::read_dir(path).map_err(unreadable)?.flatten();
    let mut parts: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(is_part).collect();
    parts.sort_by_key(|part| (number_of(part), part.clone()));
    if parts.is_empty() {
        let problem = "the folder has no .mcap and no .db3 file; give the folder of a bag".into();
        return Err(Error::Format { path: path.into(), problem });
    }
    Ok(parts)
}

/// Returns the number at the end of a file's name, as in `bag_12.db3`.
fn number_of(path: &Path) -> Option<u64> {
    path.file_stem()?.to_str()?.rsplit('_').next()?.parse().ok()
}

/// Reads a file of any format that was built in.
pub(crate) fn scan(
    path: &Path,
    wanted: WantedTopics<'_>,
    recover: bool,
    receive: &mut Receive<'_>,
) -> Result<Contents> {
    let mut start = vec![];
    let read = File::open(path).and_then(|file| file.take(16).read_to_end(&mut start));
    read.map_err(|source| reachtube_files::Error::Read {
        path: path.into(),
        source,
        remedy: "check the path and its permissions",
    })?;
    let known = STARTS.iter().find(|(magic, _)| start.starts_with(magic));
    let problem = match known.map(|(_, format)| format) {
        Some(Format::Mcap) => return mcap(path, wanted, recover, receive),
        Some(Format::Sqlite) => return sqlite(path, wanted, recover, receive),
        Some(Format::RosBag1) => {
            "it is a bag of ROS 1; convert it with rosbags-convert of the Python package rosbags"
        }
        Some(Format::Zstd) => "it is compressed as a whole; decompress it with zstd -d",
        None if start.is_empty() => "the file is empty, so nothing can be recovered",
        None => "it is neither MCAP nor SQLite (.db3); give a log in one of these formats",
    };
    Err(Error::Format { path: path.into(), problem: problem.into() })
}

#[cfg(feature = "mcap")]
use crate::mcap_file::scan as mcap;

#[cfg(feature = "rosbag")]
use crate::bag_file::scan as sqlite;

#[cfg(not(feature = "mcap"))]
fn mcap(path: &Path, _: WantedTopics<'_>, _: bool, _: &mut Receive<'_>) -> Result<Contents> {
    Err(not_built_in(path, "mcap"))
}

#[cfg(not(feature = "rosbag"))]
fn sqlite(path: &Path, _: WantedTopics<'_>, _: bool, _: &mut Receive<'_>) -> Result<Contents> {
    Err(not_built_in(path, "rosbag"))
}

#[cfg(not(all(feature = "mcap", feature = "rosbag")))]
fn not_built_in(path: &Path, feature: &str) -> Error {
    let problem = format!("its format is not built in; build with the feature {feature}");
    Error::Format { path: path.into(), problem }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::files_of;

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
        assert!(files_of(Path::new("missing.mcap")).unwrap_err().to_string().contains("missing"));
    }
}
