use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use reachtube_recordings::{Run, RunEntry, SuiteEntry};

use crate::data::fold::context::Context;
use crate::data::fold::fold::{Fold, other_setup};
use crate::data::fold::suite_fold::SuiteFold;
use crate::data::origin::Origin;
use crate::data::problem::Problem;
use crate::data::recordings::Recordings;
use crate::data::setup::Setup;
use crate::data::suite::Suite;
use crate::error::{Error, Result};

/// What becomes of a fold in which recordings have defects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnDefect {
    /// It is refused, and the defects are named.
    #[default]
    Refuse,
    /// The recordings with defects are left out. A note and the model file say how many they are.
    Report,
}

impl Problem {
    /// Makes the problem of the recordings that were folded, which equals the problem of
    /// [`read`](Self::read) over the same recordings: the same sets, verdicts and model files to
    /// the last bit. What needs single recordings again ends with [`Error::Fold`]: figures,
    /// and `fit` where runs differ.
    ///
    /// # Errors
    ///
    /// Defects, unless they are to be reported; a fold of another setup or of no recording; runs
    /// with nominal motions of their own that the fold could not keep; a run that starts outside
    /// the box over which the model's error was bounded.
    pub fn of_fold(setup: Setup, fold: Fold, on_defect: OnDefect) -> Result<Self> {
        let Fold { context, mut state, .. } = fold;
        if Context::new(&setup)?.digest != context.digest {
            return Err(other_setup());
        }
        if state.defects.recordings > 0 && on_defect == OnDefect::Refuse {
            return Err(reachtube_recordings::Error::Defects(state.defects.list()).into());
        }
        if state.suites.is_empty() {
            return Err(Error::Fold("it has no recording; fold one at least".into()));
        }
        state.settle();
        let (root, are_listed) = (state.tree.root(), state.are_listed());
        let skipped = state.defects.recordings as usize;
        let compared = state.compared;
        let mut folds: Vec<(String, SuiteFold)> = state.suites.into_iter().collect();
        folds.sort_by_key(|(_, suite)| suite.totals.first);
        for (name, suite) in &folds {
            suite.check(name, &context, state.most_bytes)?;
        }
        let (mut entries, mut kept) = (BTreeMap::new(), HashMap::new());
        let mut suites = Vec::with_capacity(folds.len());
        for (name, fold) in folds {
            entries.extend(entries_of(&name, &fold));
            suites.push(suite(name, fold, &setup, &mut kept));
        }
        let mut notes = Vec::new();
        if skipped > 0 {
            let first = state.defects.list().first().map(ToString::to_string);
            notes.push(format!(
                "{skipped} recordings are left out because they have defects; the first: {}",
                first.unwrap_or_default()
            ));
        }
        let origin = Origin::Fold(Arc::new(entries));
        let recordings = Recordings { suites, notes, root, are_listed, compared, skipped };
        Ok(Self::of_recordings(setup, origin, recordings, kept))
    }
}

/// Returns the entries of the manifest that a fold has kept, by their places.
fn entries_of(name: &str, fold: &SuiteFold) -> impl Iterator<Item = (usize, RunEntry)> {
    fold.names.iter().map(|(place, (file, order))| {
        let entry = RunEntry {
            file: file.clone(),
            suite: Some(name.into()),
            motion: fold.motion.as_ref().map(|(_, motion)| motion.clone()),
            order: *order,
            line: u64::from(*place) + 1,
            ..RunEntry::default()
        };
        (*place as usize, entry)
    })
}

fn suite(name: String, fold: SuiteFold, setup: &Setup, kept: &mut HashMap<usize, Run>) -> Suite {
    let whole = fold.whole.iter().map(|(place, whole)| (place as usize, whole.run.clone()));
    kept.extend(whole);
    let has_own_start = setup.settings.nominal.is_of_run();
    let runs: Vec<_> = fold.runs.into_values().collect();
    Suite {
        nominal_start: match setup.nominal_starts.get(&name) {
            Some(given) => given.clone(),
            None => fold.totals.mean_start(),
        },
        entry: SuiteEntry {
            name,
            motion: fold.motion.map(|(_, motion)| motion),
            runs: runs.iter().map(|run| run.index).collect(),
        },
        runs,
        totals: fold.totals,
        shared: fold.shared.filter(|_| !has_own_start).map(|shared| shared.input),
        envelope: Arc::new(fold.envelope),
    }
}
