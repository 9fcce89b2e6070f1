//! What is no defect, but what a user should know about a data set.

use std::collections::BTreeMap;

use crate::index::RunEntry;
use crate::run::Run;
use crate::source::RunSource;
use crate::units::velocity_mismatch;

/// What is odd about the run `index`, which was read as `run`.
pub fn run_notes(source: &dyn RunSource, index: usize, run: &Run) -> Vec<String> {
    let entry = &source.runs()[index];
    let slow = velocity_mismatch(run).into_iter().map(|(joint, slope)| {
        format!(
            "{}: joint {}: q moves {slope:.3} times as far as qd integrates to",
            entry.file,
            joint + 1
        )
    });
    entry.changed_note(&run.sha256).into_iter().chain(slow).collect()
}

/// Recordings that are the same to the last byte, given the index and the SHA-256 of each.
pub fn copies_note<'a>(
    source: &dyn RunSource,
    read: impl Iterator<Item = (usize, &'a str)>,
) -> Option<String> {
    let mut first: BTreeMap<&str, usize> = BTreeMap::new();
    let pair = |(index, sha256): (usize, &'a str)| {
        let original = *first.entry(sha256).or_insert(index);
        (original != index).then_some((index, original))
    };
    let copies: Vec<(usize, usize)> = read.filter_map(pair).collect();
    let &(copy, original) = copies.first()?;
    let (copy, original) = (&source.runs()[copy].file, &source.runs()[original].file);
    Some(match copies.len() {
        1 => format!("{copy} is a copy of {original}: one recording counts twice"),
        many => format!(
            "{many} recordings are copies of others and count again; {copy} is a copy of {original}"
        ),
    })
}

impl RunEntry {
    fn changed_note(&self, sha256: &str) -> Option<String> {
        let listed = self.sha256.as_ref()?;
        (!listed.eq_ignore_ascii_case(sha256)).then(|| {
            let (file, line) = (&self.file, self.line);
            format!("{file}: its SHA-256 is not the one in runs.csv (line {line}): it was changed after it was listed")
        })
    }
}
