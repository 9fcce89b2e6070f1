//! The logs among files and folders, of any format.

use std::path::{Path, PathBuf};

use reachtube_recordings::{LogSettings, group_files, table_files};

use crate::error::{Error, Result};
use crate::files::logs_in;
use crate::log::LogOptions;

/// A log of any format.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LogFiles {
    /// CSV files of one recording.
    Csv(Vec<PathBuf>),
    /// An MCAP file, a .db3 file, or the folder of a bag.
    Container(PathBuf),
}

impl LogFiles {
    /// Returns the logs among files and folders: the path itself if it is one, or the logs in a
    /// folder, in the order of their names. Subfolders count if the folder itself has no log.
    ///
    /// # Errors
    ///
    /// [`reachtube_files::Error::Read`] for a path that cannot be read.
    pub fn find(path: &Path) -> Result<Vec<Self>, reachtube_files::Error> {
        let mut logs = logs_in(path)?;
        if logs == [path] {
            return Ok(vec![Self::Container(path.into())]);
        }
        let mut csv = table_files(path)?;
        let is_inside = |file: &PathBuf| file.parent() == Some(path);
        if csv.iter().chain(&logs).any(is_inside) {
            csv.retain(is_inside);
            logs.retain(is_inside);
        } else if path.is_file() {
            logs.clear();
        }
        let csv = group_files(csv).into_iter().map(Self::Csv);
        if logs.is_empty() {
            return Ok(csv.collect());
        }
        let mut all: Vec<Self> = csv.chain(logs.into_iter().map(Self::Container)).collect();
        all.sort_by(|a, b| a.path().cmp(b.path()));
        Ok(all)
    }

    /// Returns the path for messages: of the only or the first file.
    #[must_use]
    pub(crate) fn path(&self) -> &Path {
        match self {
            Self::Csv(files) => &files[0],
            Self::Container(path) => path,
        }
    }
}

impl LogOptions {
    /// Returns the options of the settings, for a robot with these names of joints.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] unless the settings name no joint, or one for each of the robot's.
    pub fn new(settings: &LogSettings, joints: &[String]) -> Result<Self> {
        let given = &settings.joints;
        if !given.is_empty() && given.len() != joints.len() {
            return Err(Error::Setting(format!(
                "--joints gives {} names, but the robot has {} joints: {}; give one name for each",
                given.len(),
                joints.len(),
                joints.join(", ")
            )));
        }
        Ok(Self {
            topics: settings.topic.clone(),
            joints: if given.is_empty() { joints.to_vec() } else { given.clone() },
            marker: settings.marker.clone(),
            time: settings.time,
            recover: false,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::LogFiles;

    #[test]
    fn logs_of_all_formats_are_found_in_a_folder() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        for name in ["b.mcap", "a.csv", "runs.csv", "below/c.csv", "below/d.db3", "notes.txt"] {
            let path = root.join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "t,x\n").unwrap();
        }
        let csv = |name: &str| LogFiles::Csv(vec![root.join(name)]);
        let log = |name: &str| LogFiles::Container(root.join(name));
        // Logs below do not count beside others, which may have been cut from them.
        assert_eq!(LogFiles::find(root).unwrap(), [csv("a.csv"), log("b.mcap")]);
        for name in ["b.mcap", "a.csv"] {
            std::fs::remove_file(root.join(name)).unwrap();
        }
        assert_eq!(LogFiles::find(root).unwrap(), [csv("below/c.csv"), log("below/d.db3")]);
        assert_eq!(LogFiles::find(&root.join("below/d.db3")).unwrap(), [log("below/d.db3")]);
        assert_eq!(LogFiles::find(&root.join("runs.csv")).unwrap(), [csv("runs.csv")]);
        assert!(LogFiles::find(&root.join("missing")).is_err());
    }
}
