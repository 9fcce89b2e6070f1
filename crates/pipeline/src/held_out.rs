//! Which motions are held out, before anything is looked at.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use reachtube_identify::prepare::{LogEntry, RawLog};
use reachtube_recordings::matching;

use crate::error::{Error, Result};
use crate::stretches::{Use, stretches};
use crate::windows::Origin;

/// One motion in this many is held out.
const ONE_IN: usize = 4;

/// Recordings in place of motions are held out of fewer motions than this, if each was recorded at
/// least [`REPEATS`] times.
const FEW: usize = 8;
const REPEATS: usize = 4;

/// The part of a single motion that is used; the rest is held out.
const PART_OF_ONE: f64 = 0.75;

/// A recording, or a part of one.
#[derive(Debug, Clone)]
pub(crate) struct Recording {
    /// The samples.
    pub log: Arc<RawLog>,
    /// The motion that it shows.
    pub motion: String,
}

/// Motions for the sets, motions that are held out, and the rule by which they were chosen.
#[derive(Debug)]
pub(crate) struct Split {
    pub kept: Vec<Recording>,
    pub held_out: Vec<Recording>,
    pub names: Vec<String>,
    pub reason: String,
}

impl Split {
    /// Splits recordings of motions: the motions or recordings `given` are held out, or else every
    /// fourth motion in the order of the recordings, the last of two or three, and the last quarter
    /// of a single one. If few motions were repeated, every fourth recording of each.
    ///
    /// # Errors
    ///
    /// [`Error::HeldOut`] for a name that is no motion, [`Error::NothingLeft`].
    pub(crate) fn new(recordings: Vec<Recording>, given: Option<&[String]>) -> Result<Self> {
        let mut motions: Vec<String> = Vec::new();
        for recording in &recordings {
            if !motions.contains(&recording.motion) {
                motions.push(recording.motion.clone());
            }
        }
        let given = given.filter(|given| !given.is_empty());
        let given = given.map(|given| named(given, &recordings, &motions)).transpose()?;
        let (names, reason): (Vec<String>, String) = match (given, motions.len()) {
            (Some(names), _) => (names, "given".into()),
            (None, count) if count < FEW && recordings.len() >= REPEATS * count => {
                let each = match count {
                    1 => "the motion".to_string(),
                    _ => format!("each of {count} motions"),
                };
                let reason =
                    format!("every fourth recording of {each}; nothing follows for other motions");
                (fourths(&recordings, &motions), reason)
            }
            (None, 1) => return Ok(Self::in_time(recordings)),
            (None, count @ 2..ONE_IN) => {
                (motions[count - 1..].to_vec(), format!("the last of {count} motions"))
            }
            (None, count) => {
                let every = motions.iter().skip(ONE_IN - 1).step_by(ONE_IN);
                (every.cloned().collect(), format!("every fourth of {count} motions"))
            }
        };
        let is_held_out = |recording: &Recording| {
            names.contains(&recording.motion) || names.contains(&recording.log.name)
        };
        let (held_out, kept): (Vec<_>, Vec<_>) = recordings.into_iter().partition(is_held_out);
        if kept.is_empty() {
            return Err(Error::NothingLeft);
        }
        Ok(Self { kept, held_out, names, reason })
    }

    /// Returns the same motions, with each recording as its stretches.
    pub(crate) fn in_stretches(&self, what: Use) -> Self {
        let of = |recording: &Recording| {
            let stretches = stretches(&recording.log, what).into_iter().map(Arc::new);
            let motion = recording.motion.clone();
            stretches.map(move |log| Recording { log, motion: motion.clone() })
        };
        let [kept, held_out] =
            [&self.kept, &self.held_out].map(|all| all.iter().flat_map(of).collect());
        Self { kept, held_out, names: self.names.clone(), reason: self.reason.clone() }
    }

    pub(crate) fn are_motions_whole(&self) -> bool {
        let motions = |recordings: &[Recording]| -> BTreeSet<String> {
            recordings.iter().map(|recording| recording.motion.clone()).collect()
        };
        motions(&self.kept).is_disjoint(&motions(&self.held_out))
    }

    /// Returns the motion and the SHA-256 of each log, by its name.
    pub(crate) fn origins(&self) -> BTreeMap<String, Origin> {
        let origin = |Recording { log, motion }: &Recording| {
            let sha256 = log.run.sha256.clone();
            (log.name.clone(), Origin { motion: motion.clone(), sha256, at_rest: false })
        };
        self.kept.iter().chain(&self.held_out).map(origin).collect()
    }

    /// Holds out the end of each recording of a single motion.
    fn in_time(recordings: Vec<Recording>) -> Self {
        let [mut kept, mut held_out] = [Vec::new(), Vec::new()];
        for recording in recordings {
            let at = PART_OF_ONE * recording.log.run.duration();
            kept.push(recording.between(0.0, Some(at)));
            held_out.push(recording.between(at, None));
        }
        let reason = "there is one motion: its last quarter is held out, and nothing follows for \
                      other motions";
        Self { kept, held_out, names: Vec::new(), reason: reason.into() }
    }
}

/// Returns the motions, or else the recordings, that names and patterns select.
fn named(given: &[String], recordings: &[Recording], motions: &[String]) -> Result<Vec<String>> {
    let mut names: Vec<String> = Vec::new();
    for name in given {
        let mut selected = matching(name, motions.iter().map(String::as_str));
        if selected.is_empty() {
            let all = recordings.iter().map(|recording| recording.log.name.as_str());
            selected = matching(name, all);
        }
        if selected.is_empty() {
            return Err(Error::HeldOut { name: name.clone(), motions: motions.to_vec() });
        }
        for name in selected {
            if !names.iter().any(|other| other == name) {
                names.push(name.into());
            }
        }
    }
    Ok(names)
}

/// Returns the names of every fourth recording of each motion.
fn fourths(recordings: &[Recording], motions: &[String]) -> Vec<String> {
    let of = |motion: &String| {
        let own = recordings.iter().filter(|recording| recording.motion == *motion);
        own.skip(ONE_IN - 1).step_by(ONE_IN).map(|recording| recording.log.name.clone()).collect()
    };
    motions.iter().flat_map(|motion| -> Vec<String> { of(motion) }).collect()
}

impl Recording {
    /// Returns the recording as an identification takes it.
    pub(crate) fn entry(&self) -> LogEntry {
        LogEntry::Recording(Arc::clone(&self.log))
    }

    /// Returns the part between two times since the first sample, s.
    fn between(&self, from: f64, until: Option<f64>) -> Self {
        let run = &self.log.run;
        let first = run.times.partition_point(|t| *t < from);
        let last = until.map_or(run.len(), |until| run.times.partition_point(|t| *t <= until));
        let log = RawLog { run: run.only(first..last), ..RawLog::clone(&self.log) };
        Self { log: Arc::new(log), motion: self.motion.clone() }
    }

    /// Returns the recording with its torques earlier by `lag`, s, in whole samples, without the
    /// samples that then have none.
    pub(crate) fn with_earlier_torques(&self, lag: f64) -> Self {
        let mut log = RawLog::clone(&self.log);
        let (n, run) = (log.run.joints, &mut log.run);
        let steps = run.len().saturating_sub(1).max(1) as f64;
        let shift = (lag * steps / run.duration()).round() as isize;
        let (moved, kept) = (shift.unsigned_abs(), run.len().saturating_sub(shift.unsigned_abs()));
        let [torques, others] = if shift > 0 { [moved, 0] } else { [0, moved] };
        let rows = |values: &[f64], width: usize, from: usize| {
            values.iter().skip(width * from).take(width * kept).copied().collect::<Vec<f64>>()
        };
        run.torques = rows(&run.torques, n, torques);
        run.states = rows(&run.states, 2 * n, others);
        run.temperatures = rows(&run.temperatures, n, others);
        run.times = rows(&run.times, 1, others);
        let first = run.times.first().copied().unwrap_or(0.0);
        run.times.iter_mut().for_each(|time| *time -= first);
        Self { log: Arc::new(log), motion: self.motion.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use reachtube_recordings::Run;

    fn recordings(motions: &[&str]) -> Vec<Recording> {
        let of = |motion: &&str| {
            let times: Vec<f64> = (0..101).map(|k| 0.1 * f64::from(k)).collect();
            let states = times.iter().flat_map(|t| [*t, 1.0]).collect();
            let run = Run::new(1, times, states, vec![0.0; 101]).unwrap();
            let name = motion.to_string();
            let log = RawLog::new(&name, &name, run);
            Recording { log: Arc::new(log), motion: name }
        };
        motions.iter().map(of).collect()
    }

    #[test]
    fn every_fourth_motion_is_held_out() {
        let split =
            Split::new(recordings(&["a", "a", "b", "c", "d", "e", "f", "g", "h"]), None).unwrap();
        assert!(split.are_motions_whole());
        assert_eq!((split.names, split.kept.len()), (vec!["d".into(), "h".into()], 7));
        let split = Split::new(recordings(&["a", "b"]), None).unwrap();
        assert_eq!(split.names, ["b"]);
        let split = Split::new(recordings(&["a", "b"]), Some(&["a".into()])).unwrap();
        assert_eq!(split.kept[0].motion, "b");
        let split = Split::new(recordings(&["a", "b"]), Some(&[])).unwrap();
        assert_eq!((split.names, split.reason), (vec!["b".into()], "the last of 2 motions".into()));
        let split = Split::new(recordings(&["a1", "a2", "b"]), Some(&["a*".into()])).unwrap();
        assert_eq!((split.names, split.kept.len()), (vec!["a1".into(), "a2".into()], 1));
    }

    #[test]
    fn recordings_of_few_repeated_motions_are_held_out() {
        let mut all = recordings(&["a", "a", "a", "a", "b", "b", "b", "b"]);
        for (number, recording) in all.iter_mut().enumerate() {
            let name = format!("{}{number}", recording.motion);
            Arc::make_mut(&mut recording.log).name = name;
        }
        let split = Split::new(all.clone(), None).unwrap();
        assert_eq!((&split.names[..], split.kept.len()), (&["a3".into(), "b7".into()][..], 6));
        assert!(!split.are_motions_whole());
        let again = Split::new(all, Some(&split.names)).unwrap();
        assert_eq!(again.held_out.len(), 2);
    }

    #[test]
    fn the_end_of_a_single_motion_is_held_out() {
        let split = Split::new(recordings(&["a"]), None).unwrap();
        assert!(!split.are_motions_whole());
        let (kept, held_out) = (&split.kept[0].log.run, &split.held_out[0].log.run);
        assert_eq!((kept.len(), held_out.len()), (76, 26));
        assert_eq!((held_out.start, held_out.times[0], held_out.q(0)[0]), (7.5, 0.0, 7.5));
    }

    #[test]
    fn names_that_are_no_motions_and_nothing_left_are_errors() {
        let wrong = Split::new(recordings(&["a", "b"]), Some(&["c".into()])).unwrap_err();
        assert!(wrong.to_string().contains("the motions are a, b"), "{wrong}");
        let all = Split::new(recordings(&["a"]), Some(&["a".into()])).unwrap_err();
        assert!(matches!(all, Error::NothingLeft));
    }
}
