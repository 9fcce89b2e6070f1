//! Recordings sorted by what they are.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use reachtube_identify::prepare::{LogEntry, PrepareSettings, RawLog, read};
use reachtube_recordings::{DataSet, RunEntry, RunSource, any_simulated};
use reachtube_robot::Robot;

use crate::choices::Choices;
use crate::chooser::Chooser;
use crate::error::{Error, Result};
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
        let entries: Vec<LogEntry> = given.data.iter().cloned().map(LogEntry::from).collect();
        let raw = read(&entries, Path::new(""), robot, settings)?;
        let kinds: Vec<Kind> = raw.iter().map(|log| Kind::of(&log.run)).collect();
        let count = |kind: Kind| kinds.iter().filter(|other| **other == kind).count();
        let of = |kind: Kind| -> Vec<&RawLog> {
            let pairs = raw.iter().zip(&kinds).filter(|(_, other)| **other == kind);
            pairs.map(|(log, _)| log).collect()
        };
        let entry = |log: &RawLog| LogEntry::Path(log.file.clone());
        let moving = of(Kind::Motion);
        if moving.is_empty() {
            let (rest, one) = (count(Kind::Rest), count(Kind::OneJoint));
            return Err(Error::NoMotion { recordings: raw.len(), rest, one });
        }
        let known = indexed(given.data.iter().cloned());
        let known: Vec<Option<String>> =
            moving.iter().map(|log| known.get(&log.file).cloned()).collect();
        let names = motions(&moving, &known);
        let digest = data_digest(&raw, &names);
        let distinct = names.iter().collect::<BTreeSet<_>>().len();
        chooser.choose(
            "data",
            format!("{} recordings", raw.len()),
            format!(
                "{} at rest, {} of one joint at a time, {} of several joints ({} motions)",
                count(Kind::Rest),
                count(Kind::OneJoint),
                moving.len(),
                distinct
            ),
        );
        let recordings = moving.iter().zip(names).map(|(log, motion)| Recording {
            log: (*log).clone(),
            entry: entry(log),
            motion,
        });
        let motions = recordings.collect();
        let [rest, one_joint] =
            [Kind::Rest, Kind::OneJoint].map(|kind| of(kind).into_iter().map(entry).collect());
        let notes = raw.iter().flat_map(|log| log.notes.iter().cloned()).collect();
        let simulated = any_simulated(raw.iter().map(|log| &*log.file));
        Ok(Self { rest, one_joint, motions, notes, simulated, digest })
    }
}

/// Returns the motion, or else the suite, of each recording by its name, where an index names it.
pub(crate) fn index_names(paths: &[PathBuf], raw: &[RawLog]) -> BTreeMap<String, String> {
    let known = indexed(paths.iter().cloned());
    let named = |log: &RawLog| Some((log.name.clone(), known.get(&log.file)?.clone()));
    raw.iter().filter_map(named).collect()
}

/// Returns the motion, or else the suite, of each file that the index of a folder names.
fn indexed(folders: impl Iterator<Item = PathBuf>) -> BTreeMap<PathBuf, String> {
    let indices = folders.filter(|folder| folder.join("runs.csv").is_file());
    let sets = indices.filter_map(|folder| DataSet::open(&folder).ok());
    let motion = |set: DataSet| -> Vec<(PathBuf, String)> {
        let named = |(index, run): (usize, &RunEntry)| {
            let motion = run.motion.clone().or_else(|| run.suite.clone())?;
            Some((set.run_name(index), motion))
        };
        set.runs().iter().enumerate().filter_map(named).collect()
    };
    sets.flat_map(motion).collect()
}
