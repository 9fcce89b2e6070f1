use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use crate::defect::Defect;
use crate::error::Error;
use crate::index::{RunEntry, read_index};
use crate::reading::read_csv;
use crate::run::Run;
use crate::source::{ReadOptions, RunSource};

/// The file in a folder of recordings that lists them.
const INDEX: &str = "runs.csv";

/// Number of folders above a recording in which an index may list it.
const LEVELS: usize = 3;

/// Returns the folder with the index that may list a recording: the recording's folder, or up to
/// two folders above; the nearest one counts.
#[must_use]
pub fn index_folder(recording: &Path) -> Option<&Path> {
    let mut folders = recording.ancestors().skip(1).take(LEVELS);
    folders.find(|folder| folder.join(INDEX).is_file())
}

/// Returns whether an index ([`index_folder`]) marks one of some recordings as simulated.
pub fn any_simulated<'a>(recordings: impl IntoIterator<Item = &'a Path>) -> bool {
    let recordings: BTreeSet<&Path> = recordings.into_iter().collect();
    let folders: BTreeSet<&Path> = recordings.iter().copied().filter_map(index_folder).collect();
    let sets = folders.into_iter().filter_map(|folder| DataSet::open(folder).ok());
    sets.into_iter().any(|data| {
        let marked = data.runs.iter().filter(|run| run.simulated);
        marked.into_iter().any(|run| recordings.contains(&*data.root.join(&run.file)))
    })
}

/// A folder of recordings with its index `runs.csv`.
#[derive(Debug, Clone)]
pub struct DataSet {
    root: PathBuf,
    runs: Vec<RunEntry>,
    /// CSV files in the folder that the index does not list.
    unlisted: Vec<PathBuf>,
}

impl DataSet {
    /// Reads the index of the folder `root`. The runs themselves are read one by one, when they are
    /// used.
    ///
    /// # Errors
    ///
    /// [`Error::File`] when the index cannot be read, and [`Error::Defects`] for a missing column
    /// and for a file that is listed twice or does not exist.
    pub fn open(root: impl Into<PathBuf>) -> Result<Self, Error> {
        let root = root.into();
        let index = root.join(INDEX);
        let remedy = "give the folder that holds the recordings and their index runs.csv, which \
                      has one line per recording with its file and suite";
        let bytes = reachtube_files::read(&index, remedy)?;
        let runs = read_index(&root, &index, &bytes).map_err(Error::Defects)?;
        let listed: BTreeSet<PathBuf> = runs.iter().map(|run| root.join(&run.file)).collect();
        let unlisted = csv_files(&root)
            .into_iter()
            .filter(|path| *path != index && !listed.contains(path))
            .collect();
        Ok(Self { root, runs, unlisted })
    }

    #[must_use]
    pub(crate) fn root(&self) -> &Path {
        &self.root
    }
}

impl RunSource for DataSet {
    fn index_name(&self) -> PathBuf {
        self.root.join(INDEX)
    }

    fn runs(&self) -> &[RunEntry] {
        &self.runs
    }

    fn run_name(&self, index: usize) -> PathBuf {
        self.root.join(&self.runs[index].file)
    }

    fn read(&self, index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
        read_csv(&self.run_name(index), options)
    }

    fn notes(&self) -> Vec<String> {
        self.outside_note().into_iter().chain(self.unlisted_note()).collect()
    }
}

impl DataSet {
    /// Returns a note about runs that do not move with the folder.
    fn outside_note(&self) -> Option<String> {
        let outside = |run: &&RunEntry| {
            let within = |part| matches!(part, Component::Normal(_) | Component::CurDir);
            !Path::new(&run.file).components().all(within)
        };
        let mut runs = self.runs.iter().filter(outside);
        let (first, more) = (runs.next()?, runs.count());
        let others = if more == 0 { String::new() } else { format!(" (and {more} more)") };
        Some(format!(
            "{}:{}: the path \"{}\"{others} leads out of the folder, so a copy of the folder would \
             lack the recording; list paths in the folder",
            self.index_name().display(),
            first.line,
            first.file
        ))
    }

    /// Returns a note about files that are not used.
    fn unlisted_note(&self) -> Option<String> {
        let (first, root) = (self.unlisted.first()?.display(), self.root.display());
        Some(match self.unlisted.len() {
            1 => format!("{first} is not in runs.csv and is not used; list it to use it"),
            count => format!(
                "{count} CSV files in {root} are not in runs.csv and are not used, for example \
                 {first}; list them to use them"
            ),
        })
    }
}

/// Returns the CSV files in a folder and the folders in it, in the order of their paths.
fn csv_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<PathBuf> = entries
        .flatten()
        .flat_map(|entry| {
            let path = entry.path();
            match entry.file_type() {
                Ok(kind) if kind.is_dir() => csv_files(&path),
                Ok(_)
                    if path
                        .extension()
                        .is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) =>
                {
                    vec![path]
                }
                _ => Vec::new(),
            }
        })
        .collect();
    files.sort();
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_index_marks_recordings_as_simulated() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("inner");
        std::fs::create_dir(&inner).unwrap();
        let paths = ["inner/a.csv", "inner/b.csv", "c.csv"].map(|file| folder.path().join(file));
        paths.iter().for_each(|path| std::fs::write(path, "").unwrap());
        let write = |text: &str| std::fs::write(folder.path().join(INDEX), text).unwrap();
        let found = |count: usize| any_simulated(paths[..count].iter().map(|path| &**path));
        assert!(!found(3), "there is no index");
        write("file,suite\ninner/a.csv,A\n");
        assert!(!found(3), "there is no mark");
        write("file,suite,simulated\ninner/a.csv,A,\ninner/b.csv,A,false\nc.csv,B,true\n");
        assert_eq!([found(2), found(3)], [false, true]);
        let marks = DataSet::open(folder.path()).unwrap().runs;
        assert_eq!(marks.iter().map(|run| run.simulated).collect::<Vec<_>>(), [false, false, true]);
        write("file,suite,simulated\nc.csv,B,perhaps\n");
        assert!(DataSet::open(folder.path()).is_err());
    }
}
