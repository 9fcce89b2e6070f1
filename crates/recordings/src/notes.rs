//! Notes for the user about recordings that have no defect.

use std::collections::BTreeMap;

use crate::index::RunEntry;
use crate::run::Run;
use crate::source::RunSource;
use crate::units::velocity_mismatch;

/// Returns the notes about the run of an entry, which was read as `run`: a file that has changed
/// since it was listed, and joints whose velocities do not integrate to their positions.
#[must_use]
pub fn run_notes(entry: &RunEntry, run: &Run) -> Vec<String> {
    let mismatches = velocity_mismatch(run).into_iter().map(|(joint, slope)| {
        format!(
            "{}: joint {}: q moves {slope:.3} times as far as the integral of qd; check both units",
            entry.file,
            joint + 1
        )
    });
    changed_note(entry, &run.sha256).into_iter().chain(mismatches).collect()
}

/// Returns a note about recordings that are equal to the last byte. `read` gives the name and the
/// SHA-256 of each recording that was read, in any order.
pub fn copies_note<'a>(read: impl Iterator<Item = (&'a str, &'a str)>) -> Option<String> {
    let mut first: BTreeMap<&str, &str> = BTreeMap::new();
    let pair = |(file, sha256): (&'a str, &'a str)| {
        first.insert(sha256, file).map(|original| {
            first.insert(sha256, original);
            (file, original)
        })
    };
    let copies: Vec<(&str, &str)> = read.filter_map(pair).collect();
    let &(copy, original) = copies.first()?;
    Some(match copies.len() {
        1 => format!(
            "{copy} is a copy of {original}, so one recording counts twice; list each recording \
             once"
        ),
        many => format!(
            "{many} recordings are copies of others and count twice; for example, {copy} is a \
             copy of {original}; list each recording once"
        ),
    })
}

/// Returns a note for each suite of which some runs have recorded temperatures and some have not.
/// `read` gives the index of each recording that was read, and whether it has temperatures.
///
/// # Panics
///
/// Panics if the source has no run of an index.
pub(crate) fn temperature_notes(
    source: &dyn RunSource,
    read: impl Iterator<Item = (usize, bool)>,
) -> Vec<String> {
    let mut suites: BTreeMap<&str, [Vec<usize>; 2]> = BTreeMap::new();
    for (index, has_temperatures) in read {
        let Some(suite) = &source.runs()[index].suite else { continue };
        suites.entry(suite).or_default()[usize::from(has_temperatures)].push(index);
    }
    let note = |(suite, [without, with]): (&str, [Vec<usize>; 2])| {
        let (first, missing) = (*without.first()?, without.len());
        let all = missing + with.len();
        (!with.is_empty()).then(|| {
            format!(
                "suite {suite}: {missing} of {all} recordings have no temperatures, for example \
                 {}; models whose friction depends on temperature cannot use them: add the \
                 columns temp1..tempn, or remove them from all recordings of the suite",
                source.runs()[first].file
            )
        })
    };
    suites.into_iter().filter_map(note).collect()
}

/// Returns a note about the suites whose runs have one sample each. `read` gives the index of each
/// recording that was read, and its number of samples.
pub(crate) fn single_samples_note(
    source: &dyn RunSource,
    read: impl Iterator<Item = (usize, usize)>,
) -> Option<String> {
    let mut longest: BTreeMap<&str, usize> = BTreeMap::new();
    for (index, samples) in read {
        let Some(suite) = &source.runs()[index].suite else { continue };
        let known = longest.entry(suite).or_default();
        *known = samples.max(*known);
    }
    let single = longest.into_iter().filter(|(_, samples)| *samples == 1);
    let names: Vec<&str> = single.map(|(suite, _)| suite).collect();
    let plural = if names.len() == 1 { "suite" } else { "suites" };
    (!names.is_empty()).then(|| {
        let names = names.join(", ");
        format!("{plural} {names}: the runs have one sample each, which shows no motion")
    })
}

/// Returns a note where the SHA-256 of a file is not the one in the index.
fn changed_note(entry: &RunEntry, sha256: &str) -> Option<String> {
    let listed = entry.sha256.as_ref()?;
    (!listed.eq_ignore_ascii_case(sha256)).then(|| {
        let (file, line) = (&entry.file, entry.line);
        format!(
            "{file}: its SHA-256 is not the one in runs.csv (line {line}): the file has changed \
             since it was listed; restore it or update the index"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::{copies_note, run_notes, single_samples_note, temperature_notes};
    use crate::memory::MemoryRuns;
    use crate::run::Run;
    use crate::source::{ReadOptions, RunSource};

    /// Returns a run of one joint that moves at `speed`, recorded as 1 rad/s.
    fn run(speed: f64) -> Run {
        let times = vec![0.0, 0.5, 1.0];
        let states = times.iter().flat_map(|t| [speed * t, 1.0]).collect();
        Run::new(1, times, states, vec![0.0; 3]).unwrap()
    }

    #[test]
    fn copies_are_counted_and_named() {
        let mut runs = MemoryRuns::default();
        for (name, speed) in [("a", 1.0), ("b", 1.5), ("c", 1.0), ("d", 1.0)] {
            runs.push(name, None, None, run(speed));
        }
        let read = |index| runs.read(index, &ReadOptions::default()).unwrap().sha256;
        let read: Vec<String> = (0..4).map(read).collect();
        let digests = || read.iter().map(String::as_str);
        let note = |count| copies_note(["a", "b", "c", "d"].into_iter().zip(digests()).take(count));
        assert_eq!(note(2), None);
        assert!(note(3).unwrap().starts_with("c is a copy of a, so one recording counts twice"));
        assert!(note(4).unwrap().starts_with("2 recordings are copies"));
    }

    #[test]
    fn a_suite_with_temperatures_in_some_runs_is_noted() {
        let mut runs = MemoryRuns::default();
        for (name, suite) in [("a", "A"), ("b", "A"), ("c", "B"), ("d", "B"), ("e", "C")] {
            runs.push(name, Some(suite), None, run(1.0));
        }
        let with = [true, false, true, true, false];
        let notes = temperature_notes(&runs, with.into_iter().enumerate());
        assert_eq!(notes.len(), 1, "{notes:?}");
        let expected = "suite A: 1 of 2 recordings have no temperatures, for example b; ";
        assert!(notes[0].starts_with(expected), "{notes:?}");
    }

    #[test]
    fn suites_of_one_sample_are_noted() {
        let mut runs = MemoryRuns::default();
        for (name, suite) in [("a", "A"), ("b", "A"), ("c", "B"), ("d", "C")] {
            runs.push(name, Some(suite), None, run(1.0));
        }
        let note = |samples: [usize; 4]| single_samples_note(&runs, (0..).zip(samples));
        assert_eq!(note([1, 3, 2, 5]), None);
        assert!(note([1, 1, 2, 5]).unwrap().starts_with("suite A: the runs have one sample each"));
        assert!(note([1, 3, 1, 1]).unwrap().starts_with("suites B, C: "));
    }

    #[test]
    fn velocities_that_do_not_integrate_to_the_positions_are_noted() {
        let mut runs = MemoryRuns::default();
        runs.push("fast", None, None, run(3.0));
        assert_eq!(run_notes(&runs.runs()[0], &run(1.0)), [""; 0]);
        let notes = run_notes(&runs.runs()[0], &run(3.0));
        assert_eq!(notes.len(), 1);
        assert!(notes[0].starts_with("fast: joint 1: q moves 3.000 times as far"), "{notes:?}");
    }
}
