use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;
use reachtube_reach::TimeGrid;
use reachtube_recordings::{Defect, ReadOptions, Run, RunSource, SuiteEntry};

use crate::data::envelope::Envelope;
use crate::data::input::{RunInput, SharedInput};
use crate::data::kept::KeptRuns;
use crate::data::settings::NominalStart;
use crate::data::setup::Drive;
use crate::data::shape::Shape;
use crate::data::summary::{RunSummary, SAMPLE, sampled};
use crate::data::totals::Totals;
use crate::error::{Error, Result as AnyResult};

/// One test suite after reading.
#[derive(Debug, Clone)]
pub struct Suite {
    /// The suite's name and runs.
    pub entry: SuiteEntry,
    /// Summaries of the runs, in the order of `entry.runs`: of all runs of a source. A fold of many
    /// runs keeps 256 of them, as random as their SHA-256.
    pub runs: Vec<RunSummary>,
    /// Totals of all runs.
    pub(crate) totals: Totals,
    /// The nominal initial state, N: the one that was given for the suite's name, or the mean of
    /// the runs' first states, rounded to nearest.
    pub nominal_start: Vec<f64>,
    /// The one input of all runs (Definition 2), where they share it and their nominal start: the
    /// input of the longest run, of which the others' are the beginning.
    pub shared: Option<RunInput>,
    /// Envelope of the measured states, with run indices of the source.
    pub envelope: Arc<Envelope>,
}

impl Suite {
    pub(crate) fn run_count(&self) -> usize {
        self.totals.count
    }

    pub(crate) fn is_at_rest(&self) -> bool {
        self.runs.iter().all(|run| run.at_rest)
    }

    /// Returns what was read of each run.
    ///
    /// # Errors
    ///
    /// [`Error::Fold`] where a fold has not kept it.
    pub(crate) fn every_run(&self) -> AnyResult<&[RunSummary]> {
        if self.runs.len() == self.totals.count {
            return Ok(&self.runs);
        }
        Err(Error::Fold(format!(
            "suite {}: this step needs each of its {} recordings, of which it has kept {}; read \
             them on one machine for it",
            self.entry.name,
            self.totals.count,
            self.runs.len()
        ).into()))
    }

    /// Returns the runs that statistics are of, in their order: all, or 256 of more.
    pub(crate) fn sample(&self) -> impl Iterator<Item = &RunSummary> {
        sampled(&self.runs)
    }

    pub(crate) fn is_small(&self) -> bool {
        self.totals.count <= SAMPLE
    }
}

/// What reading a suite depends on.
pub(super) struct SuiteReader<'a> {
    pub source: &'a dyn RunSource,
    pub options: ReadOptions,
    pub drive: &'a dyn Drive,
    pub shape: Shape,
    pub nominal: NominalStart,
    pub nominal_starts: &'a BTreeMap<String, Vec<f64>>,
    pub kept: &'a KeptRuns,
    /// Whether every run is kept, and not only the runs that later steps need one by one.
    pub keep_all: bool,
}

impl SuiteReader<'_> {
    /// Reads the runs of a suite on all cores and folds them. The fold's size does not grow with
    /// the number of runs, except for the summaries; `progress` takes how many runs are done.
    pub(super) fn read(
        &self,
        entry: &SuiteEntry,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Result<Suite, Vec<Defect>> {
        let shape = self.shape;
        let (done, grids) = (AtomicUsize::new(0), SharedGrids::default());
        let take = |mut part: Part, (place, &index): (usize, &usize)| {
            match self.read_run(index) {
                Ok((run, input)) => {
                    let summary = self.summary(index, &run, grids.of(&input.grid));
                    part.runs.push((place, summary));
                    self.take(&mut part, index, run, input);
                }
                Err(defects) => part.defects.push((place, defects)),
            }
            progress(done.fetch_add(1, Ordering::Relaxed) + 1);
            part
        };
        let parts = entry.runs.par_iter().enumerate().fold(|| Part::new(shape), take);
        let whole = parts.reduce_with(|a, b| a.merge(b, shape, self.kept));
        self.suite(entry, whole.unwrap_or_else(|| Part::new(shape)))
    }

    fn read_run(&self, index: usize) -> Result<(Run, RunInput), Vec<Defect>> {
        let run = self.source.read(index, &self.options)?;
        let path = self.source.run_name(index);
        self.nominal.check(&path, &run)?;
        let input = self.drive.input(&path, &run, None)?;
        Ok((run, input))
    }

    fn summary(&self, index: usize, run: &Run, grid: Arc<TimeGrid>) -> RunSummary {
        RunSummary::new(index, &self.source.runs()[index], run, grid)
    }

    /// Folds one run into `part`. A run is kept when the suite's runs are known to be cases of
    /// their own, or when it may turn out so: the first one, until a second shares its input.
    fn take(&self, part: &mut Part, index: usize, run: Run, input: RunInput) {
        part.envelope.include(index as u32, &run.states);
        let is_first = part.is_empty;
        part.share(Some(SharedInput { run: index as u32, input }), self.shape);
        if self.keep_all || self.nominal.is_of_run() || part.shared.is_none() {
            self.kept.keep(index, run);
        } else if is_first {
            part.first = Some((index, run));
            return;
        }
        let first = part.first.take();
        part.keep_if_own(first, self.kept);
    }

    fn suite(&self, entry: &SuiteEntry, mut whole: Part) -> Result<Suite, Vec<Defect>> {
        if !whole.defects.is_empty() {
            whole.defects.sort_by_key(|(place, _)| *place);
            return Err(whole.defects.into_iter().flat_map(|(_, defects)| defects).collect());
        }
        whole.runs.sort_by_key(|(place, _)| *place);
        let mut runs: Vec<RunSummary> = whole.runs.into_iter().map(|(_, run)| run).collect();
        let totals = Totals::of_all(&runs).expect("a suite has one run at least");
        let sample: BTreeSet<usize> = sampled(&runs).map(|run| run.index).collect();
        let others = runs.iter_mut().filter(|run| !sample.contains(&run.index));
        others.for_each(|run| run.marks.clear());
        let own_start = self.nominal.is_of_run();
        Ok(Suite {
            entry: entry.clone(),
            nominal_start: match self.nominal_starts.get(&entry.name) {
                Some(given) => given.clone(),
                None => totals.mean_start(),
            },
            runs,
            totals,
            shared: whole.shared.filter(|_| !own_start).map(|shared| shared.input),
            envelope: Arc::new(whole.envelope),
        })
    }
}

/// What a part of a suite's runs is folded into.
struct Part {
    runs: Vec<(usize, RunSummary)>,
    /// The input that all runs so far share, if they do.
    shared: Option<SharedInput>,
    /// Whether no run has been taken in yet, so that `shared` is not yet known.
    is_empty: bool,
    /// The first run, while it is the only one.
    first: Option<(usize, Run)>,
    envelope: Envelope,
    defects: Vec<(usize, Vec<Defect>)>,
}

impl Part {
    fn new(shape: Shape) -> Self {
        Self {
            runs: Vec::new(),
            shared: None,
            is_empty: true,
            first: None,
            envelope: Envelope::new(shape.states),
            defects: Vec::new(),
        }
    }

    fn share(&mut self, other: Option<SharedInput>, shape: Shape) {
        self.shared = if self.is_empty {
            other
        } else {
            self.shared.take().zip(other).and_then(|(a, b)| a.merge(b, shape.inputs))
        };
        self.is_empty = false;
    }

    fn keep_if_own(&self, first: Option<(usize, Run)>, kept: &KeptRuns) {
        if let (Some((index, run)), None) = (first, &self.shared) {
            kept.keep(index, run);
        }
    }

    fn merge(mut self, other: Self, shape: Shape, kept: &KeptRuns) -> Self {
        if self.is_empty {
            self.first = other.first;
        } else if !other.is_empty {
            let firsts = [self.first.take(), other.first];
            self.share(other.shared.clone(), shape);
            firsts.into_iter().for_each(|first| self.keep_if_own(first, kept));
        }
        if self.is_empty && !other.is_empty {
            self.share(other.shared, shape);
        }
        self.runs.extend(other.runs);
        self.defects.extend(other.defects);
        self.envelope.merge(&other.envelope);
        self
    }
}

/// The grids of a suite's runs, of which runs of one rate share one.
#[derive(Default)]
struct SharedGrids(Mutex<Vec<Arc<TimeGrid>>>);

impl SharedGrids {
    fn of(&self, grid: &Arc<TimeGrid>) -> Arc<TimeGrid> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(longer) = known.iter().find(|longer| grid.is_prefix_of(longer)) {
            return Arc::clone(longer);
        }
        known.push(Arc::clone(grid));
        Arc::clone(grid)
    }
}
