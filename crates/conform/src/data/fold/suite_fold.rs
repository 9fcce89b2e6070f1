use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use reachtube_reach::TimeGrid;
use reachtube_recordings::{Run, RunEntry};
use serde::{Deserialize, Serialize};

use crate::data::envelope::Envelope;
use crate::data::fold::context::Context;
use crate::data::fold::whole_runs::{WholeRun, WholeRuns};
use crate::data::input::{RunInput, SharedInput};
use crate::data::summary::{RunSummary, SAMPLE, sampled};
use crate::data::totals::Totals;
use crate::error::{Error, Result};
use reachtube_finding::Advice;

/// Summaries of runs beyond the sample that may stay for a while.
const SUPERFLUOUS: usize = SAMPLE / 4;

/// Names that may be superfluous before they are looked through.
const MOST_SUPERFLUOUS: usize = 256;

/// What the runs of one suite are folded into.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct SuiteFold {
    /// The motion that the first run names which names one, with its place.
    pub motion: Option<(u32, String)>,
    /// Totals of all runs.
    pub totals: Totals,
    /// The measured states.
    pub envelope: Envelope,
    /// The input that all runs share, if they do.
    pub shared: Option<SharedInput>,
    /// The runs that stay whole.
    pub whole: WholeRuns,
    /// What was read of each run, where that is kept: of all, while the data set lists its runs or
    /// all stay whole, and otherwise of the sample.
    pub runs: BTreeMap<u32, RunSummary>,
    /// File, and place in the order of the suite, of every run that anything may name.
    pub names: BTreeMap<u32, (String, u64)>,
    /// Number of names that were looked through last.
    #[serde(skip)]
    pub settled: usize,
}

impl SuiteFold {
    /// Folds one run, whose measured states `envelope` has already, or the envelope of the suite
    /// that it will be merged with.
    pub(super) fn of(
        place: u32,
        entry: &RunEntry,
        run: Run,
        input: RunInput,
        envelope: Envelope,
    ) -> Self {
        let summary = RunSummary::new(place as usize, entry, &run, Arc::clone(&input.grid));
        Self {
            motion: entry.motion.clone().map(|motion| (place, motion)),
            totals: Totals::of(&summary),
            envelope,
            shared: Some(SharedInput { run: place, input: input.clone() }),
            names: [(place, (entry.file.clone(), entry.order))].into(),
            runs: [(place, summary)].into(),
            whole: WholeRuns::one(place, WholeRun { run, input }),
            settled: 0,
        }
    }

    pub(super) fn merge(&mut self, other: Self, context: &Context, most_bytes: usize) {
        let inputs = context.shape.inputs;
        let motions = self.motion.take().into_iter().chain(other.motion);
        self.motion = motions.min_by_key(|(place, _)| *place);
        self.totals.merge(other.totals);
        self.envelope.merge(&other.envelope);
        let shared = self.shared.take().zip(other.shared);
        self.shared = shared.and_then(|(own, other)| own.merge(other, inputs));
        replace(&mut self.whole, |whole| whole.merge(other.whole, context, most_bytes));
        self.runs.extend(other.runs);
        self.names.extend(other.names);
    }

    /// Drops what no later step needs; `are_listed` says whether the data set lists its runs. With
    /// `now`, nothing superfluous stays.
    pub(super) fn settle(&mut self, are_listed: bool, now: bool) {
        let keeps_all = are_listed || self.whole.are_all();
        let marked = self.runs.values().filter(|run| !run.marks.is_empty()).count();
        if now || marked.max(if keeps_all { 0 } else { self.runs.len() }) > SAMPLE + SUPERFLUOUS {
            let sample: BTreeSet<usize> = sampled(self.runs.values()).map(|r| r.index).collect();
            let others = self.runs.values_mut().filter(|run| !sample.contains(&run.index));
            others.for_each(|run| run.marks.clear());
            self.runs.retain(|_, run| keeps_all || sample.contains(&run.index));
        }
        if now || self.names.len() > 2 * self.settled + MOST_SUPERFLUOUS {
            let mut needed: Vec<u32> = self.envelope.owners().collect();
            needed.extend(self.runs.keys());
            needed.extend(self.whole.iter().map(|(place, _)| place));
            needed.sort_unstable();
            self.names.retain(|place, _| needed.binary_search(place).is_ok());
            self.settled = self.names.len();
        }
    }

    /// Returns whether a problem can be made of the suite, which is called `name`.
    ///
    /// # Errors
    ///
    /// Runs with nominal motions of their own that could not be kept.
    pub(super) fn check(&self, name: &str, context: &Context, most_bytes: usize) -> Result<()> {
        let can_share = self.shared.is_some() && !context.is_own;
        if can_share || self.whole.are_all() {
            return Ok(());
        }
        let (count, most) = (self.totals.count, most_bytes >> 20);
        let why = if context.is_own {
            "each has a nominal motion of its own, because the nominal start is the run's or \
            friction depends on it"
        } else {
            "they differ in input or sample times"
        };
        let problem = format!(
            "suite {name}: of its {count} recordings {why}, so each is needed sample by sample, \
             and a fold keeps them only where no two share their input, up to {most} MiB: give \
             recordings of different inputs suites of their own (they share an input where it was \
             recorded as such), fold fewer, or read them on one machine"
        );
        Err(Error::Fold(Advice::from(problem).with("torque", "compensated")))
    }

    /// Completes what was read from bytes: inputs of whole runs, and places and grids of summaries,
    /// which share theirs. `None` if the parts do not fit together.
    pub(super) fn completed(mut self, context: &Context) -> Option<Self> {
        let states = context.shape.states;
        self.whole = self.whole.with_inputs(context)?;
        let shared = self.shared.as_ref().map(|shared| &shared.input);
        let input = shared.or_else(|| self.whole.iter().next().map(|(_, run)| &run.input))?;
        let grid = Arc::clone(&input.grid);
        let grids: BTreeMap<u32, Arc<TimeGrid>> = match self.whole.are_all() {
            true => self.whole.iter().map(|(at, run)| (at, Arc::clone(&run.input.grid))).collect(),
            false => BTreeMap::new(),
        };
        for (place, run) in &mut self.runs {
            run.index = *place as usize;
            run.grid = Arc::clone(grids.get(place).unwrap_or(&grid));
        }
        self.settled = self.names.len();
        self.is_valid_for(states).then_some(self)
    }

    /// Returns whether its parts fit together and are about states of `dimension` entries.
    fn is_valid_for(&self, dimension: usize) -> bool {
        let is_named = |place: u32| self.names.contains_key(&place);
        let places = self.whole.iter().map(|(place, _)| place).chain(self.runs.keys().copied());
        let is_valid = |input: &RunInput| 2 * input.inputs.len() == input.grid.len() * dimension;
        self.totals.is_valid_for(dimension)
            && self.envelope.is_valid_for(dimension)
            && self.shared.as_ref().is_none_or(|shared| is_valid(&shared.input))
            && self.runs.values().all(|run| run.is_valid_for(dimension))
            && places.chain(self.envelope.owners()).all(is_named)
    }
}

fn replace(value: &mut WholeRuns, with: impl FnOnce(WholeRuns) -> WholeRuns) {
    let taken = std::mem::replace(value, WholeRuns::All(BTreeMap::new()));
    *value = with(taken);
}
