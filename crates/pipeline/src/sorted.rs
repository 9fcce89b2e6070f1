//! Recordings sorted by what they are.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::code::Code;
use reachtube_finding::Finding;
use reachtube_identify::prepare::{LogEntry, PrepareSettings, RawLog, read};
use reachtube_recordings::{DataSet, RunEntry, RunSource, any_simulated, index_folder};
use reachtube_robot::Robot;
use reachtube_scalar::number::counted;

use crate::choices::Choices;
use crate::chooser::Chooser;
use crate::error::{Error, Result};
use crate::findings::warning;
use crate::flaws::find_flaws;
use crate::held_out::Recording;
use crate::kinds::{MotionType, motions};
use crate::one_motion::{link_notes, links};
use crate::steps::data_digest;
use crate::windows::Origin;

/// Data from which the warmth of the robot is known.
pub(crate) const WARMTH: &str = "an index runs.csv, whose column order counts the runs since the \
    cold start, or the columns temp1 to tempn";

/// Recordings by what they are.
pub(crate) struct Sorted {
    /// All recordings.
    pub all: Vec<Arc<RawLog>>,
    pub rest: Vec<Arc<RawLog>>,
    pub one_joint: Vec<Arc<RawLog>>,
    pub motions: Vec<Recording>,
    /// Notes about the reading of the recordings for the user.
    pub notes: Vec<String>,
    /// Contradictions to other recordings that were corrected.
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
        let kinds: Vec<MotionType> = raw.iter().map(|log| MotionType::of(&log.run)).collect();
        let count = |kind: MotionType| kinds.iter().filter(|other| **other == kind).count();
        let of = |kind: MotionType| -> Vec<&Arc<RawLog>> {
            let pairs = raw.iter().zip(&kinds).filter(|(_, other)| **other == kind);
            pairs.map(|(log, _)| log).collect()
        };
        let moving = of(MotionType::Motion);
        if moving.is_empty() {
            let (rest, one) = (count(MotionType::Rest), count(MotionType::OneJoint));
            return Err(Error::NoMotion { recordings: raw.len(), rest, one });
        }
        let all: Vec<&RawLog> = raw.iter().map(|log| &**log).collect();
        let links = links(&all);
        let names = motions(&all, &links).into_iter().zip(&kinds);
        let names = names.filter(|(_, kind)| **kind == MotionType::Motion).map(|(name, _)| name);
        let names: Vec<String> = names.collect();
        let digest = data_digest(&raw, &names);
        let distinct = names.iter().collect::<BTreeSet<_>>().len();
        chooser.choose(
            "data",
            format!("{} recordings", raw.len()),
            format!(
                "{} at rest, {} of one joint at a time, {} of several joints ({})",
                count(MotionType::Rest),
                count(MotionType::OneJoint),
                moving.len(),
                counted(distinct, "motion")
            ),
        );
        let recordings = moving.iter().zip(names);
        let recordings = recordings.map(|(log, motion)| Recording { log: Arc::clone(log), motion });
        let motions = recordings.collect();
        let [rest, one_joint] = [MotionType::Rest, MotionType::OneJoint]
            .map(|kind| of(kind).into_iter().cloned().collect());
        let [joined, shared] = link_notes(&all, &links);
        let notes = raw.iter().flat_map(|log| log.notes.iter().cloned()).chain(joined).collect();
        let findings =
            raw.iter().flat_map(|log| log.moved.iter().map(|text| warning(Code::TurnsMoved, text)));
        let shared = shared.map(|text| warning(reachtube_conform::Code::Recordings, &text));
        let findings = copies.into_iter().chain(shared).chain(findings).collect();
        let simulated = any_simulated(raw.iter().map(|log| &*log.file));
        Ok(Self { all: raw, rest, one_joint, motions, notes, findings, simulated, digest })
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
        warning(reachtube_conform::Code::Recordings, &format!("{text}: {pair}"))
    });
    (kept, finding)
}

/// Reads recordings, and looks for samples that are missing or wrong. Each recording has the order
/// of its index, and the motion, or else the suite, if the log names no motion itself. Files of one
/// name have the names of their folders too.
///
/// # Errors
///
/// Recordings that cannot be read or of which much is missing, and an index beside them that is
/// wrong.
pub(crate) fn read_logs(
    paths: &[PathBuf],
    robot: &Robot,
    settings: &PrepareSettings,
) -> Result<Vec<RawLog>> {
    // In which order they are named makes no difference.
    let mut paths = paths.to_vec();
    paths.sort_unstable();
    let entries: Vec<LogEntry> = paths.iter().cloned().map(LogEntry::from).collect();
    // Gaps are looked for in what was read.
    let settings = PrepareSettings { max_gap: Some(f64::INFINITY), ..settings.clone() };
    let mut raw = read(&entries, Path::new(""), robot, &settings)?;
    let known = indexed(&raw, &paths)?;
    for log in &mut raw {
        if let Some(RunEntry { motion, suite, order, .. }) = known.get(&log.file).cloned() {
            let is_in_order = suite.is_some();
            log.motion = log.motion.take().or(motion).or(suite);
            // Lines without a suite are in no order.
            log.order = log.order.or(is_in_order.then_some(order));
        }
    }
    name_apart(&mut raw);
    raw.iter_mut().try_for_each(|log| find_flaws(log, robot))?;
    Ok(raw)
}

/// Returns a note about recordings without a suite beside others whose index gives them one:
/// windows are cut from all.
pub(crate) fn without_suite_note(raw: &[RawLog]) -> Option<String> {
    // Only an index with a suite gives an order.
    let mut without = raw.iter().filter(|log| log.order.is_none());
    let (first, more) = (without.next()?, without.count());
    (more + 1 < raw.len()).then(|| {
        format!(
            "{} of the {} recordings have no suite in runs.csv, for example {}; they are used too, \
             because each log is cut into suites of its own: to leave them out, move them to \
             another folder",
            more + 1,
            raw.len(),
            first.file.display()
        )
    })
}

/// Gives recordings of one name the names of their folders too, and numbers where these are the
/// same.
fn name_apart(raw: &mut [RawLog]) {
    let mut names: Vec<String> = raw.iter().map(|log| log.name.clone()).collect();
    for log in raw {
        if names.iter().filter(|name| **name == log.name).count() < 2 {
            continue;
        }
        let folder = log.file.parent().and_then(Path::file_name).unwrap_or_default();
        let name = match folder.is_empty() {
            true => log.name.clone(),
            false => format!("{}_{}", folder.to_string_lossy(), log.name),
        };
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let mut all = std::iter::once(name.clone()).chain(numbered);
        let free = all.find(|name| !names.contains(name)).expect("numbers do not end");
        // The old name stays in the list, so that the others of this name are renamed too.
        names.push(free.clone());
        log.name = free;
    }
}

/// Returns the file of a recording without the warmth of the robot: by the temperatures of its
/// joints, or else by the order of the runs.
pub(crate) fn unknown_warmth<'a>(logs: &[&'a RawLog], by_temperature: bool) -> Option<&'a Path> {
    let is_known = |log: &RawLog| match by_temperature {
        true => !log.run.temperatures.is_empty(),
        false => log.order.is_some(),
    };
    logs.iter().find(|log| !is_known(log)).map(|log| &*log.file)
}

/// Returns the motion and the SHA-256 of each log, and whether the robot rests in it, by its name.
pub(crate) fn origins_of(raw: &[RawLog]) -> BTreeMap<String, Origin> {
    let all: Vec<&RawLog> = raw.iter().collect();
    let logs = raw.iter().zip(motions(&all, &links(&all)));
    let origin = |log: &RawLog, motion| Origin {
        motion,
        sha256: log.run.sha256.clone(),
        at_rest: MotionType::of(&log.run) == MotionType::Rest,
    };
    logs.map(|(log, motion)| (log.name.clone(), origin(log, motion))).collect()
}

/// Returns the entries of each file in the indices. An index that is wrong is an error, unless it
/// lies above the `given` folders and the recordings' own.
fn indexed(raw: &[RawLog], given: &[PathBuf]) -> Result<BTreeMap<PathBuf, RunEntry>> {
    let folders: BTreeSet<&Path> = raw.iter().filter_map(|log| index_folder(&log.file)).collect();
    let is_beside = |folder: &Path| {
        raw.iter().any(|log| log.file.parent() == Some(folder))
            || given.iter().any(|given| folder.starts_with(given))
    };
    let mut known = BTreeMap::new();
    for folder in folders {
        match DataSet::open(folder) {
            Ok(set) => {
                let runs = set.runs().iter().enumerate();
                known.extend(runs.map(|(index, run)| (set.run_name(index), run.clone())));
            }
            Err(error) if is_beside(folder) => {
                return Err(reachtube_conform::Error::from(error).into());
            }
            Err(_) => {}
        }
    }
    Ok(known)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pendulum::pendulum;

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
        let robot = pendulum();
        let backward: Vec<PathBuf> = paths.iter().rev().cloned().collect();
        let raw = read_logs(&backward, &robot, &PrepareSettings::default()).unwrap();
        let own = raw.iter().map(|log| (log.name.as_str(), log.motion.as_deref(), log.order));
        let own: Vec<_> = own.collect();
        assert_eq!(own, [("a_run", Some("A"), Some(3)), ("b_run", Some("B"), Some(8))]);
        let origins = origins_of(&raw);
        assert_eq!([&*origins["a_run"].motion, &*origins["b_run"].motion], ["A", "B"]);
        assert_ne!(origins["a_run"].sha256, origins["b_run"].sha256);
        // The folder above them, and no index.
        paths.iter().for_each(|path| std::fs::remove_file(path.join("runs.csv")).unwrap());
        let settings = PrepareSettings::default();
        let raw = read_logs(&[folder.path().to_path_buf()], &robot, &settings).unwrap();
        let own: Vec<_> = raw.iter().map(|log| (&*log.name, log.motion.as_deref())).collect();
        assert_eq!(own, [("a_run", None), ("b_run", None)]);
        // An index that is wrong is not passed over.
        std::fs::write(paths[0].join("runs.csv"), "file,suite\nother.csv,A\n").unwrap();
        let wrong = read_logs(&paths, &robot, &settings).unwrap_err().to_string();
        assert!(wrong.contains("other.csv"), "{wrong}");
        let above = folder.path().join("runs.csv");
        std::fs::rename(paths[0].join("runs.csv"), above).unwrap();
        assert_eq!(
            read_logs(&paths, &robot, &settings).unwrap().len(),
            2,
            "it lies above what was given"
        );
    }
}
