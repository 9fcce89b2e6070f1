//! Recordings of logs: their files read, divided, and given times.

use std::path::{Path, PathBuf};

use reachtube_files::hex;
use sha2::{Digest, Sha256};

use super::assignment::assign;
use super::canonical::is_recording;
use super::content::content;
use super::dialect::Dialect;
use super::even_times::with_times;
use super::log::{Log, Logged, as_it_is};
use super::options::{LoggedOptions, Wanted};
use super::runs::{RunRows, parts};
use super::settings::ColumnSettings;
use crate::defect::Defect;

/// Reads a recording from the files of a log: one with all quantities, or one for each quantity
/// with the same times.
///
/// A file with the header `t,q1..qn,qd1..qdn,tau1..taun` is read as it is, unless
/// [`LoggedOptions::columns`] say otherwise. In others, columns and units are recognised.
///
/// # Errors
///
/// Every defect, with file, line, column and remedy.
///
/// # Panics
///
/// Panics without a file.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::{ColumnSettings, GapLimit, LoggedOptions, Wanted, read_logged};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("log.csv");
/// let rows = "0 0.10 1.0 2.0\n4 0.104 1.0 2.0\n8 0.108 1.0 2.0\n";
/// std::fs::write(&path, format!("time_ms actual_q_0 actual_qd_0 target_moment_0\n{rows}"))?;
///
/// let columns = ColumnSettings::default();
/// let options = LoggedOptions {
///     robot: None,
///     joints: &[],
///     columns: &columns,
///     gains: false,
///     wanted: Wanted::Torques,
///     gap_limit: GapLimit::Usual,
///     until: None,
/// };
/// let logged = read_logged(&[path], &options).unwrap();
/// assert_eq!(logged.run.times, [0.0, 0.004, 0.008]);
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn read_logged(files: &[PathBuf], options: &LoggedOptions) -> Result<Logged, Vec<Defect>> {
    let (contents, digest) = contents(files)?;
    let dialects = dialects(files, &contents)?;
    logged(files, contents, dialects, digest, options)
}

/// Reads the recordings in the files of a log, as [`read_logged`] does. A file with a column `run`,
/// `episode` or `episode_index` has a recording for each of its values, row after row, with the
/// value; the SHA-256 is of its rows.
///
/// # Errors
///
/// Every defect, with file, line, column and remedy.
///
/// # Panics
///
/// Panics without a file.
pub fn read_logged_runs(
    files: &[PathBuf],
    options: &LoggedOptions,
) -> Result<Vec<(Option<String>, Logged)>, Vec<Defect>> {
    let (contents, digest) = contents(files)?;
    let dialects = dialects(files, &contents)?;
    let parts = match (&contents[..], &dialects[..]) {
        ([bytes], [dialect]) => parts(bytes, dialect),
        _ => None,
    };
    let Some(parts) = parts else {
        return Ok(vec![(None, logged(files, contents, dialects, digest, options)?)]);
    };
    let read = |part: RunRows| {
        let digest = Sha256::new_with_prefix(&part.text);
        let mut dialect = dialects[0].clone();
        dialect.line += part.skipped;
        let logged = logged(files, vec![part.text], vec![dialect], digest, options)?;
        Ok((Some(part.run), logged))
    };
    parts.into_iter().map(read).collect()
}

/// Reads a recording from the text of a log, which messages call `name`, as [`read_logged`] does.
///
/// # Errors
///
/// Every defect, with line, column and remedy.
pub fn parse_logged(
    name: &Path,
    text: Vec<u8>,
    options: &LoggedOptions,
) -> Result<Logged, Vec<Defect>> {
    let files = [name.to_path_buf()];
    let digest = Sha256::new_with_prefix(&text);
    let dialects = dialects(&files, std::slice::from_ref(&text))?;
    logged(&files, vec![text], dialects, digest, options)
}

/// Returns the texts of files, and the SHA-256 of all of them.
fn contents(files: &[PathBuf]) -> Result<(Vec<Vec<u8>>, Sha256), Vec<Defect>> {
    if let [file] = files {
        return content(file).map(|(text, digest)| (vec![text], digest));
    }
    let mut all = Sha256::new();
    let mut text = |file: &PathBuf| {
        let (text, _) = content(file)?;
        all.update(&text);
        Ok::<_, Vec<Defect>>(text)
    };
    let texts = files.iter().map(&mut text).collect::<Result<_, _>>()?;
    Ok((texts, all))
}

/// Reads a recording from the texts of files.
fn logged(
    files: &[PathBuf],
    mut contents: Vec<Vec<u8>>,
    mut dialects: Vec<Dialect>,
    digest: Sha256,
    options: &LoggedOptions,
) -> Result<Logged, Vec<Defect>> {
    if let Some(rate) = options.columns.rate {
        let timed = contents.iter().zip(&dialects);
        contents = timed.map(|(bytes, dialect)| with_times(bytes, dialect, rate)).collect();
        dialects = self::dialects(files, &contents)?;
    }
    let mut logged = match &dialects[..] {
        [only]
            if *options.columns == ColumnSettings::default()
                && is_recording(only)
                && options.wanted != Wanted::Commands =>
        {
            as_it_is(files, &contents[0], only, options)?
        }
        _ => {
            let assignment = assign(files, &dialects, options)?;
            let log = Log { files, dialects: &dialects, assignment: &assignment, options };
            log.logged(&contents)?
        }
    };
    logged.run.sha256 = hex(&digest.finalize());
    logged.run.truncate(options.until);
    Ok(logged)
}

fn dialects(files: &[PathBuf], contents: &[Vec<u8>]) -> Result<Vec<Dialect>, Vec<Defect>> {
    let all = files.iter().zip(contents).map(|(file, bytes)| Dialect::of(file, bytes));
    all.collect::<Result<_, _>>().map_err(|defect| vec![*defect])
}
