//! Which files are logs, and which of them are one recording.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::canonical::is_recording;
use super::dialect::Dialect;
use super::name::{ColumnName, Quantity};

/// Bytes in which a header ends.
const HEADER_BYTES: u64 = 1 << 16;

fn head(file: &Path) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let file = std::fs::File::open(file).ok()?;
    file.take(HEADER_BYTES).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

/// Returns the file itself, or the CSV and Parquet files of a folder except `runs.csv`, sorted by
/// name. If the folder has none, returns the files of its subfolders. The recordings of a LeRobot
/// folder are in its subfolder `data`.
///
/// # Errors
///
/// [`reachtube_files::Error::Read`] for a path that cannot be read.
pub fn table_files(path: &Path) -> Result<Vec<PathBuf>, reachtube_files::Error> {
    let unreadable = |source| reachtube_files::Error::Read {
        path: path.to_path_buf(),
        source,
        remedy: "give a CSV or Parquet file, or a folder of them",
    };
    if !path.metadata().map_err(unreadable)?.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let data = Some(path.join("data")).filter(|_| path.join("meta/info.json").is_file());
    let [mut files, folders] = recordings(data.as_deref().unwrap_or(path)).map_err(unreadable)?;
    if files.is_empty() {
        for folder in folders {
            let [below, _] = recordings(&folder).map_err(unreadable)?;
            files.extend(below);
        }
    }
    files.sort();
    Ok(files)
}

/// Returns the files of recordings in a folder, and its folders.
fn recordings(folder: &Path) -> std::io::Result<[Vec<PathBuf>; 2]> {
    let entries = std::fs::read_dir(folder)?.flatten().map(|entry| entry.path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let has_ending = |path: &PathBuf| {
        let is =
            |ending: &str| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending));
        is("csv") || is("parquet")
    };
    let is_recording =
        |path: &PathBuf| has_ending(path) && path.file_name().is_some_and(|f| f != "runs.csv");
    Ok([files.into_iter().filter(is_recording).collect(), folders])
}

/// Groups the files of a folder to recordings: files with one quantity each, such as `position.csv`
/// and `effort.csv`, are one recording if their names are the same without the quantity. Each other
/// file is a recording.
#[must_use]
pub fn group_files(files: Vec<PathBuf>) -> Vec<Vec<PathBuf>> {
    let mut groups: Vec<Vec<PathBuf>> = Vec::new();
    let mut of_name: BTreeMap<(PathBuf, Vec<String>), (usize, Vec<Quantity>)> = BTreeMap::new();
    for file in files {
        let Some((quantity, name)) = only_quantity(&file) else {
            groups.push(vec![file]);
            continue;
        };
        let key = (file.parent().unwrap_or(Path::new("")).to_path_buf(), name);
        match of_name.get_mut(&key) {
            Some((group, quantities)) if !quantities.contains(&quantity) => {
                groups[*group].push(file);
                quantities.push(quantity);
            }
            _ => {
                of_name.insert(key, (groups.len(), vec![quantity]));
                groups.push(vec![file]);
            }
        }
    }
    // Positions come first: they are the file that messages name.
    for group in &mut groups {
        group.sort_by_key(|file| only_quantity(file).map(|(quantity, _)| quantity));
    }
    groups
}

/// Returns the quantity that a file's name speaks of, other than the time.
pub(super) fn quantity_of_file(file: &Path) -> Option<Quantity> {
    let stem = file.file_stem()?.to_string_lossy();
    ColumnName::new(&stem).quantity.filter(|q| !matches!(q, Quantity::Time | Quantity::Other))
}

/// Returns the one quantity of a file, and the rest of its name; `None` for a file with several.
fn only_quantity(file: &Path) -> Option<(Quantity, Vec<String>)> {
    let quantity = quantity_of_file(file)?;
    let dialect = Dialect::of(file, &head(file)?).ok()?;
    if is_recording(&dialect) {
        return None;
    }
    let is_other = |name: &String| {
        let other = ColumnName::new(name).quantity;
        other.is_some_and(|q| q != quantity && !matches!(q, Quantity::Time | Quantity::Other))
    };
    if dialect.names.iter().any(is_other) {
        return None;
    }
    let name = ColumnName::new(&file.file_stem()?.to_string_lossy());
    Some((quantity, name.joint))
}
