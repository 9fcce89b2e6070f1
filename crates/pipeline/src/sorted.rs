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
        let (raw, copies) = without_copies(read_logs(&given.data, robot, settings)?);
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
        let known: Vec<Option<String>> = moving.iter().map(|log| log.motion.clone()).collect();
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

/// Reads recordings. Each has the order of its index, and the motion, or else the suite, where the
/// log names no motion itself.
///
/// # Errors
///
/// Recordings that cannot be read.
pub(crate) fn read_logs(
    paths: &[PathBuf],
    robot: &Robot,
    settings: &PrepareSettings,
) -> Result<Vec<RawLog>> {
    let entries: Vec<LogEntry> = paths.iter().cloned().map(LogEntry::from).collect();
    let (mut raw, known) = (read(&entries, Path::new(""), robot, settings)?, indexed(paths));
    for log in &mut raw {
        if let Some(RunEntry { motion, suite, order, .. }) = known.get(&log.file).cloned() {
            log.motion = log.motion.take().or(motion).or(suite);
            log.order.get_or_insert(order);
        }
    }
    Ok(raw)
}

/// Returns the motion of each recording that has one, by the recording's name.
pub(crate) fn motions_of(raw: &[RawLog]) -> BTreeMap<String, String> {
    raw.iter().filter_map(|log| Some((log.name.clone(), log.motion.clone()?))).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_one_name_in_two_folders_have_the_motions_and_orders_of_their_own_index() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a", "b"].map(|name| folder.path().join(name));
        for (path, (suite, order)) in paths.iter().zip([("A", 3), ("B", 8)]) {
            std::fs::create_dir(path).unwrap();
            let log = format!("t,q1,qd1,tau1\n0,0,1,{order}\n0.1,0.1,1,{order}\n0.2,0.2,1,0\n");
            std::fs::write(path.join("run.csv"), log).unwrap();
            let index = format!("file,suite,order\nrun.csv,{suite},{order}\n");
            std::fs::write(path.join("runs.csv"), index).unwrap();
        }
        let robot = "schema_version = 1\nname = \"hinge\"\n[[joint]]\nname = \"hinge\"\n\
                     placement = { translation = [0.0, 0.0, 1.0] }\naxis = [0.0, 1.0, 0.0]\n\
                     mass = 1.0\ncom = [0.0, 0.0, -0.3]\n\
                     inertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.01]\n";
        let robot = Robot::from_toml(robot, "hinge").unwrap();
        let raw = read_logs(&paths, &robot, &PrepareSettings::default()).unwrap();
        let own = raw.iter().map(|log| (log.name.as_str(), log.motion.as_deref(), log.order));
        let own: Vec<_> = own.collect();
        assert_eq!(own, [("run", Some("A"), Some(3)), ("run", Some("B"), Some(8))]);
    }
}
