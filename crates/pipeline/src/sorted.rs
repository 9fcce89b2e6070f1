//! Recordings sorted by what they are.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use reachtube_conform::Finding;
use reachtube_conform::result::Code;
use reachtube_identify::prepare::{LogEntry, PrepareSettings, RawLog, read};
use reachtube_recordings::{DataSet, RunEntry, RunSource, any_simulated};
use reachtube_robot::Robot;
use reachtube_scalar::number::counted;

use crate::choices::Choices;
use crate::chooser::Chooser;
use crate::error::{Error, Result};
use crate::findings::warning;
use crate::held_out::Recording;
use crate::journal::data_digest;
use crate::kinds::{Kind, motions};

/// Recordings by what they are.
pub(crate) struct Sorted {
    pub rest: Vec<LogEntry>,
    pub one_joint: Vec<LogEntry>,
    pub motions: Vec<Recording>,
    /// What a user should know about the reading of the recordings.
    pub notes: Vec<String>,
    /// What contradicts other recordings, and was mended.
    pub findings: Vec<Finding>,
    /// Whether a recording is marked as simulated.
    pub simulated: bool,
    /// The digest of all recordings.
    pub digest: String,
}

impl Sorted {
    /// Reads recordings and sorts them.
    ///
    /// # Errors
    ///
    /// Recordings that cannot be read; [`Error::NoMotion`].
    pub(crate) fn read(
        chooser: &mut Chooser,
        given: &Choices,
        robot: &Robot,
        settings: &PrepareSettings,
    ) -> Result<Self> {
        let (raw, known) = read_logs(&given.data, robot, settings)?;
        let (raw, copies) = without_copies(raw);
        let kinds: Vec<Kind> = raw.iter().map(|log| Kind::of(&log.run)).collect();
        let count = |kind: Kind| kinds.iter().filter(|other| **other == kind).count();
        let of = |kind: Kind| -> Vec<&Arc<RawLog>> {
            let pairs = raw.iter().zip(&kinds).filter(|(_, other)| **other == kind);
            pairs.map(|(log, _)| log).collect()
        };
        let entry = |log: &Arc<RawLog>| LogEntry::Recording(Arc::clone(log));
        let moving = of(Kind::Motion);
        if moving.is_empty() {
            let (rest, one) = (count(Kind::Rest), count(Kind::OneJoint));
            return Err(Error::NoMotion { recordings: raw.len(), rest, one });
        }
        let known: Vec<Option<String>> =
            moving.iter().map(|log| known.get(&log.name).cloned()).collect();
        let shown: Vec<&RawLog> = moving.iter().map(|log| &***log).collect();
        let names = motions(&shown, &known);
        let digest = data_digest(&raw, &names);
        let distinct = names.iter().collect::<BTreeSet<_>>().len();
        chooser.choose(
            "data",
            format!("{} recordings", raw.len()),
            format!(
                "{} at rest, {} of one joint at a time, {} of several joints ({})",
                count(Kind::Rest),
                count(Kind::OneJoint),
                moving.len(),
                counted(distinct, "motion")
            ),
        );
        let recordings = moving.iter().zip(names);
        let recordings = recordings.map(|(log, motion)| Recording { log: Arc::clone(log), motion });
        let motions = recordings.collect();
        let [rest, one_joint] =
            [Kind::Rest, Kind::OneJoint].map(|kind| of(kind).into_iter().map(entry).collect());
        let notes = raw.iter().flat_map(|log| log.notes.iter().cloned()).collect();
        let findings =
            raw.iter().flat_map(|log| log.moved.iter().map(|text| warning(Code::TurnsMoved, text)));
        let findings = copies.into_iter().chain(findings).collect();
        let simulated = any_simulated(raw.iter().map(|log| &*log.file));
        Ok(Self { rest, one_joint, motions, notes, findings, simulated, digest })
    }
}

/// Leaves out recordings that are equal to the last byte to one before: they are no evidence, and a
/// copy must not be held out beside its original. Returns a warning that names the first.
fn without_copies(raw: Vec<RawLog>) -> (Vec<Arc<RawLog>>, Option<Finding>) {
    let mut first: BTreeMap<String, PathBuf> = BTreeMap::new();
    let mut copies: Vec<[PathBuf; 2]> = Vec::new();
    let mut kept = Vec::new();
    for log in raw {
        match first.get(&log.run.sha256) {
            Some(original) => copies.push([log.file, original.clone()]),
            None => {
                first.insert(log.run.sha256.clone(), log.file.clone());
                kept.push(Arc::new(log));
            }
        }
    }
    let finding = copies.first().map(|[copy, original]| {
        let text = match copies.len() {
            1 => "a recording is a copy of another and is left out".to_string(),
            count => format!("{count} recordings are copies of others and are left out"),
        };
        let pair = format!("{} is a copy of {}", copy.display(), original.display());
        warning(Code::Recordings, &format!("{text}: {pair}"))
    });
    (kept, finding)
}

/// Reads recordings, whose order is the one of their index. Returns the motion, or else the suite,
/// of each by its name too, where the log or an index names it.
///
/// # Errors
///
/// Recordings that cannot be read.
pub(crate) fn read_logs(
    paths: &[PathBuf],
    robot: &Robot,
    settings: &PrepareSettings,
) -> Result<(Vec<RawLog>, BTreeMap<String, String>)> {
    let entries: Vec<LogEntry> = paths.iter().cloned().map(LogEntry::from).collect();
    let mut raw = read(&entries, Path::new(""), robot, settings)?;
    let (known, mut names) = (indexed(paths), BTreeMap::new());
    for log in &mut raw {
        let entry = known.get(&log.file);
        log.order = log.order.or_else(|| entry.map(|entry| entry.order));
        let motion = log.motion.as_ref();
        let of_index = entry.and_then(|entry| entry.motion.as_ref().or(entry.suite.as_ref()));
        if let Some(name) = motion.or(of_index) {
            names.insert(log.name.clone(), name.clone());
        }
    }
    Ok((raw, names))
}

/// Returns the SHA-256 of each recording by its name.
pub(crate) fn origins_of(raw: &[RawLog]) -> BTreeMap<String, String> {
    raw.iter().map(|log| (log.name.clone(), log.run.sha256.clone())).collect()
}

/// Returns what the indices of folders say of each file.
fn indexed(folders: &[PathBuf]) -> BTreeMap<PathBuf, RunEntry> {
    let indices = folders.iter().filter(|folder| folder.join("runs.csv").is_file());
    let sets = indices.filter_map(|folder| DataSet::open(folder).ok());
    let entries = |set: DataSet| -> Vec<(PathBuf, RunEntry)> {
        let runs = set.runs().iter().enumerate();
        runs.map(|(index, run)| (set.run_name(index), run.clone())).collect()
    };
    sets.flat_map(entries).collect()
}
