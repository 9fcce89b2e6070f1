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
use crate::defect::{Defect, DefectKind};

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
    LogText::read(files)?.logged(options)
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
    let log = LogText::read(files)?;
    let parts = match (&log.texts[..], &log.dialects[..]) {
        ([text], [dialect]) => parts(text, dialect),
        _ => None,
    };
    if let Some(run) = parts.iter().flatten().find_map(|part| part.continues.as_deref()) {
        let problem = format!("run {run} continues after other runs");
        let remedy = "sort the rows by run, or give each run its own number";
        return Err(vec![Defect::new(&files[0], None, problem, remedy)]);
    }
    let Some(parts) = parts else {
        return Ok(vec![(None, log.logged(options)?)]);
    };
    let read = |part: RunRows| {
        let digest = Sha256::new_with_prefix(&part.text);
        let mut dialect = log.dialects[0].clone();
        dialect.line += part.skipped;
        let (texts, dialects, notes) = (vec![part.text], vec![dialect], log.notes.clone());
        let logged = LogText { files, texts, dialects, digest, notes }.logged(options)?;
        Ok::<_, Vec<Defect>>((Some(part.run), logged))
    };
    let runs: Vec<(_, Logged)> = parts.into_iter().map(read).collect::<Result<_, _>>()?;
    let units = |(_, logged): &(Option<String>, Logged)| {
        logged.understood.as_ref().map(|of| (of.time_unit, of.angle_units))
    };
    if let Some((run, _)) = runs.iter().find(|run| units(run) != units(&runs[0])) {
        let run = run.as_deref().unwrap_or_default();
        let problem = format!("run {run} seems to have other units than the first one");
        let remedy = "give the units: columns.angle = \"rad\" or \"deg\", and columns.time_unit";
        let defect = Defect::new(&files[0], None, problem, remedy).of_kind(DefectKind::Units);
        return Err(vec![defect]);
    }
    Ok(runs)
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
    let texts = vec![text];
    let dialects = dialects(&files, &texts)?;
    LogText { files: &files, texts, dialects, digest, notes: vec![] }.logged(options)
}

/// The texts of the files of one recording.
struct LogText<'a> {
    files: &'a [PathBuf],
    texts: Vec<Vec<u8>>,
    dialects: Vec<Dialect>,
    /// SHA-256 of the files.
    digest: Sha256,
    /// What is missing in the texts.
    notes: Vec<String>,
}

impl<'a> LogText<'a> {
    fn read(files: &'a [PathBuf]) -> Result<Self, Vec<Defect>> {
        let (mut texts, mut notes, mut digest) = (Vec::new(), Vec::new(), Sha256::new());
        for file in files {
            let own = content(file)?;
            match files {
                [_] => digest = own.digest,
                _ => digest.update(&own.text),
            }
            texts.push(own.text);
            notes.extend(own.notes);
        }
        let dialects = dialects(files, &texts)?;
        Ok(Self { files, texts, dialects, digest, notes })
    }

    fn logged(mut self, options: &LoggedOptions) -> Result<Logged, Vec<Defect>> {
        let files = self.files;
        if let Some(rate) = options.columns.rate {
            let timed = self.texts.iter().zip(&self.dialects);
            self.texts = timed.map(|(text, dialect)| with_times(text, dialect, rate)).collect();
            let mut dialects = dialects(files, &self.texts)?;
            let lines = dialects.iter_mut().zip(&self.dialects);
            lines.for_each(|(timed, own)| timed.line = own.line);
            self.dialects = dialects;
        }
        let mut logged = match &self.dialects[..] {
            [only]
                if *options.columns == ColumnSettings::default()
                    && is_recording(only)
                    && options.wanted != Wanted::Commands =>
            {
                as_it_is(files, &self.texts[0], only, options)?
            }
            _ => {
                let assignment = assign(files, &self.dialects, options)?;
                let dialects = &self.dialects;
                Log { files, dialects, assignment: &assignment, options }.logged(&self.texts)?
            }
        };
        logged.notes.splice(..0, self.notes);
        logged.run.sha256 = hex(&self.digest.finalize());
        logged.run.truncate(options.until);
        Ok(logged)
    }
}

fn dialects(files: &[PathBuf], texts: &[Vec<u8>]) -> Result<Vec<Dialect>, Vec<Defect>> {
    let all = files.iter().zip(texts).map(|(file, text)| Dialect::of(file, text));
    all.collect::<Result<_, _>>().map_err(|defect| vec![*defect])
}
