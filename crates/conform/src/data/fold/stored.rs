//! A fold in bytes: what each of its parts is written as, in the format of the crate postcard.

use std::collections::BTreeMap;
use std::sync::Arc;

use reachtube_reach::TimeGrid;
use reachtube_recordings::{Defect, Run};
use reachtube_scalar::ExactSum;
use serde::{Deserialize, Serialize};

use crate::data::condition::Condition;
use crate::data::envelope::Envelope;
use crate::data::fold::context::Context;
use crate::data::fold::suite_fold::SuiteFold;
use crate::data::fold::whole_runs::{WholeRun, WholeRuns};
use crate::data::input::{RunInput, SharedInput};
use crate::data::marks::Marks;
use crate::data::summary::RunSummary;
use crate::data::totals::Totals;

/// A suite.
#[derive(Serialize, Deserialize)]
pub(super) struct StoredSuite {
    motion: Option<(u32, String)>,
    totals: StoredTotals,
    envelope: Envelope,
    shared: Option<StoredInput>,
    all_whole: bool,
    whole: Vec<(u32, StoredRun)>,
    runs: Vec<(u32, StoredSummary)>,
    names: Vec<(u32, String, u64)>,
    outside: Option<(u32, usize, f64)>,
}

#[derive(Serialize, Deserialize)]
struct StoredTotals {
    count: usize,
    first: usize,
    samples: [usize; 2],
    places: [u64; 2],
    starts: Vec<Vec<u64>>,
    start_bounds: Vec<[f64; 2]>,
    temperatures: Vec<Vec<u64>>,
    notes: Vec<(usize, Vec<String>)>,
    noted: usize,
}

#[derive(Serialize, Deserialize)]
struct StoredInput {
    run: u32,
    grid: StoredGrid,
    inputs: Vec<f64>,
}

/// A grid: its times, or the step and the number of samples of a uniform one.
#[derive(Serialize, Deserialize)]
enum StoredGrid {
    Uniform(f64, usize),
    Times(Vec<f64>),
}

#[derive(Serialize, Deserialize)]
struct StoredRun {
    start: f64,
    times: Vec<f64>,
    states: Vec<f64>,
    torques: Vec<f64>,
    temperatures: Vec<f64>,
    sha256: String,
}

#[derive(Serialize, Deserialize)]
struct StoredSummary {
    samples: usize,
    duration: f64,
    start: Vec<f64>,
    marks: Marks,
    place: u64,
    temperatures: Option<Vec<f64>>,
    sha256: String,
    noise: Option<Vec<f64>>,
    notes: Vec<String>,
}

impl StoredSuite {
    pub(super) fn new(suite: &SuiteFold) -> Self {
        let summary = |(place, run): (&u32, &RunSummary)| (*place, StoredSummary::new(run));
        let input = |shared: &SharedInput| StoredInput {
            run: shared.run,
            grid: StoredGrid::new(&shared.input.grid),
            inputs: shared.input.inputs.to_vec(),
        };
        let name = |(place, (file, order)): (&u32, &(String, u64))| (*place, file.clone(), *order);
        Self {
            motion: suite.motion.clone(),
            totals: StoredTotals::new(&suite.totals),
            envelope: suite.envelope.clone(),
            shared: suite.shared.as_ref().map(input),
            all_whole: suite.whole.are_all(),
            whole: suite.whole.iter().map(|(at, run)| (at, StoredRun::new(&run.run))).collect(),
            runs: suite.runs.iter().map(summary).collect(),
            names: suite.names.iter().map(name).collect(),
            outside: suite.outside,
        }
    }

    /// Returns the suite; `None` if its parts do not fit together.
    pub(super) fn into_suite(self, context: &Context) -> Option<SuiteFold> {
        let states = 2 * context.robot.joint_count();
        let whole = |(place, stored): (u32, StoredRun)| {
            Some((place, stored.into_whole(states / 2, context)?))
        };
        let mut whole: Vec<(u32, WholeRun)> =
            self.whole.into_iter().map(whole).collect::<Option<_>>()?;
        let shared = match self.shared {
            Some(stored) => Some(stored.into_shared(states / 2)?),
            None => None,
        };
        let any_grid = match &shared {
            Some(shared) => Arc::clone(&shared.input.grid),
            None => Arc::clone(&whole.first()?.1.input.grid),
        };
        let summary = |(place, stored): (u32, StoredSummary)| {
            let own = whole.iter().find(|(at, _)| *at == place).filter(|_| self.all_whole);
            let grid = own.map_or(&any_grid, |(_, run)| &run.input.grid);
            Some((place, stored.into_summary(place, states, grid)?))
        };
        let runs: BTreeMap<u32, RunSummary> =
            self.runs.into_iter().map(summary).collect::<Option<_>>()?;
        let names = self.names.into_iter().map(|(place, file, order)| (place, (file, order)));
        let names: BTreeMap<_, _> = names.collect();
        let places = whole.iter().map(|(place, _)| *place).chain(runs.keys().copied());
        let are_named =
            places.chain(self.envelope.owners()).all(|place| names.contains_key(&place));
        let fits = self.envelope.is_valid_for(states)
            && are_named
            && self.outside.is_none_or(|(at, i, _)| names.contains_key(&at) && i < states)
            && if self.all_whole { !whole.is_empty() } else { whole.len() == 1 };
        fits.then_some(())?;
        Some(SuiteFold {
            motion: self.motion,
            totals: self.totals.into_totals(states)?,
            envelope: self.envelope,
            shared,
            whole: match self.all_whole {
                true => WholeRuns::All(whole.into_iter().collect()),
                false => whole.pop().map(|(place, run)| WholeRuns::First(place, run))?,
            },
            runs,
            settled: names.len(),
            names,
            outside: self.outside,
        })
    }
}

impl StoredTotals {
    fn new(totals: &Totals) -> Self {
        let words = |sums: &[ExactSum]| sums.iter().map(ExactSum::to_words).collect();
        Self {
            count: totals.count,
            first: totals.first,
            samples: totals.samples,
            places: totals.places,
            starts: words(&totals.starts),
            start_bounds: totals.start_bounds.clone(),
            temperatures: words(&totals.temperatures),
            notes: totals.notes.iter().map(|(run, notes)| (*run, notes.clone())).collect(),
            noted: totals.noted,
        }
    }

    fn into_totals(self, states: usize) -> Option<Totals> {
        let sums = |words: Vec<Vec<u64>>| -> Option<Vec<ExactSum>> {
            words.iter().map(|words| ExactSum::from_words(words)).collect()
        };
        let totals = Totals {
            count: self.count,
            first: self.first,
            samples: self.samples,
            places: self.places,
            starts: sums(self.starts)?,
            start_bounds: self.start_bounds,
            temperatures: sums(self.temperatures)?,
            notes: self.notes.into_iter().collect(),
            noted: self.noted,
        };
        let lengths = [totals.starts.len(), totals.start_bounds.len()];
        let fits = lengths == [states; 2]
            && [0, states / 2].contains(&totals.temperatures.len())
            && totals.noted >= totals.notes.len();
        fits.then_some(totals)
    }
}

impl StoredInput {
    fn into_shared(self, joints: usize) -> Option<SharedInput> {
        let grid = self.grid.into_grid()?;
        let fits = self.inputs.len() == grid.len() * joints;
        let input = RunInput { grid: Arc::new(grid), inputs: self.inputs.into() };
        fits.then_some(SharedInput { run: self.run, input })
    }
}

impl StoredGrid {
    fn new(grid: &TimeGrid) -> Self {
        match grid.step() {
            Some(step) => Self::Uniform(step, grid.len()),
            None => Self::Times(grid.times().to_vec()),
        }
    }

    fn into_grid(self) -> Option<TimeGrid> {
        match self {
            Self::Uniform(step, count) => {
                let is_sound = step > 0.0 && step.is_finite() && count < 1 << 32;
                is_sound.then(|| TimeGrid::uniform(step, count))
            }
            Self::Times(times) => TimeGrid::from_times(&times).ok(),
        }
    }
}

impl StoredRun {
    fn new(run: &Run) -> Self {
        Self {
            start: run.start,
            times: run.times.clone(),
            states: run.states.clone(),
            torques: run.torques.clone(),
            temperatures: run.temperatures.clone(),
            sha256: run.sha256.clone(),
        }
    }

    fn into_whole(self, joints: usize, context: &Context) -> Option<WholeRun> {
        let Self { start, times, states, torques, temperatures, sha256 } = self;
        let run = Run { joints, start, times, states, torques, temperatures, sha256 };
        let input = context.input("", &run).map_err(|_: Vec<Defect>| ()).ok()?;
        Some(WholeRun { run, input })
    }
}

impl StoredSummary {
    fn new(run: &RunSummary) -> Self {
        Self {
            samples: run.samples,
            duration: run.duration,
            start: run.start.clone(),
            marks: run.marks.clone(),
            place: run.condition.place,
            temperatures: run.condition.temperatures.clone(),
            sha256: run.sha256.clone(),
            noise: run.noise.clone(),
            notes: run.notes.clone(),
        }
    }

    fn into_summary(self, index: u32, states: usize, grid: &Arc<TimeGrid>) -> Option<RunSummary> {
        let fits = self.start.len() == states
            && self.marks.is_valid_for(states)
            && self.noise.as_ref().is_none_or(|noise| noise.len() == states)
            && self.temperatures.as_ref().is_none_or(|t| 2 * t.len() == states);
        fits.then(|| RunSummary {
            index: index as usize,
            samples: self.samples,
            duration: self.duration,
            grid: Arc::clone(grid),
            start: self.start,
            marks: self.marks,
            condition: Condition { place: self.place, temperatures: self.temperatures },
            sha256: self.sha256,
            noise: self.noise,
            notes: self.notes,
        })
    }
}
