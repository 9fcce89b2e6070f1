//! Test suites as conformance sees them: read once, run by run, and kept as envelopes.

use std::sync::Arc;

use nalgebra::DVector;
use rayon::prelude::*;
use reachtube_reach::{IntervalVector, TimeGrid};
use reachtube_robot::Robot;
use reachtube_scalar::Interval;

use super::{Envelope, NominalStart, Settings};
use crate::error::Result;
use reachtube_recordings::{DataSet, Defect, Run, SuiteEntry, check_limits};

/// Progress of a long job: called with the number of recordings done so far and the number there
/// are.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// The suites of a data set, read and checked.
#[derive(Debug)]
pub struct Recordings {
    /// The suites, in the order asked for.
    pub suites: Vec<Suite>,
    /// What a user should know about the data, in words.
    pub notes: Vec<String>,
}

/// One test suite after reading.
#[derive(Debug)]
pub struct Suite {
    /// Its name and runs.
    pub entry: SuiteEntry,
    /// What was read of each run, in the order of `entry.runs`.
    pub runs: Vec<RunSummary>,
    /// The mean of the runs' first states, 2n.
    ///
    /// # Guarantee
    ///
    /// Outer enclosure of the exact mean.
    pub mean_start: IntervalVector,
    /// The one input of all runs (Definition 2), where they have one.
    pub shared: Option<SharedInput>,
    /// Envelope of the measured states, with run indices of the data set.
    pub envelope: Envelope,
}

/// What is kept of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunSummary {
    /// Index in the data set.
    pub index: usize,
    /// Its samples.
    pub samples: usize,
    /// Time from the first to the last of them, s.
    pub duration: f64,
    /// Its grid, or a longer one of the suite that it is the beginning of: runs of one rate share
    /// one.
    pub grid: Arc<TimeGrid>,
    /// Its first state, 2n.
    pub start: Vec<f64>,
    /// SHA-256 of its file.
    pub sha256: String,
    /// What a user should know about it.
    pub notes: Vec<String>,
}

/// Sample times and inputs of the longest run of a suite; those of the others are its beginning.
#[derive(Debug, Clone, PartialEq)]
pub struct SharedInput {
    /// The grid.
    pub grid: TimeGrid,
    /// The input u, row-major, samples x n, N m.
    pub inputs: Vec<f64>,
}

impl SharedInput {
    /// The longer of the two when the other is its beginning. The input of a run's last sample acts
    /// on nothing and is not compared.
    fn merge(self, other: Self, joints: usize) -> Option<Self> {
        let (short, long) =
            if self.grid.len() <= other.grid.len() { (self, other) } else { (other, self) };
        let acting = short.grid.len().saturating_sub(1) * joints;
        let same =
            short.grid.is_prefix_of(&long.grid) && short.inputs[..acting] == long.inputs[..acting];
        same.then_some(long)
    }
}

impl Recordings {
    /// Reads the suites named, on all cores; memory does not grow with the number of runs in a
    /// suite.
    ///
    /// # Errors
    ///
    /// Every defect of every run, or an unknown suite.
    pub fn read(
        data: &DataSet,
        names: &[String],
        robot: &Robot,
        settings: &Settings,
        progress: Progress,
    ) -> Result<Self> {
        let entries = data.select(names)?;
        let total = entries.iter().map(|entry| entry.runs.len()).sum();
        let mut notes = index_notes(data, &entries);
        let (mut suites, mut defects, mut done) = (Vec::new(), Vec::new(), 0);
        for entry in entries {
            let counted = |within: usize| progress(done + within, total);
            match read_suite(data, &entry, robot, settings, &counted) {
                Ok(suite) => {
                    notes.extend(suite_notes(&suite, settings.nominal));
                    suites.push(suite);
                }
                Err(found) => defects.extend(found),
            }
            done += entry.runs.len();
        }
        let read = suites
            .iter()
            .flat_map(|suite| suite.runs.iter().map(|run| (run.index, run.sha256.as_str())));
        notes.extend(data.copies_note(read));
        if defects.is_empty() {
            Ok(Self { suites, notes })
        } else {
            Err(reachtube_recordings::Error::Defects(defects).into())
        }
    }

    /// Number of runs.
    pub fn run_count(&self) -> usize {
        self.suites.iter().map(|suite| suite.runs.len()).sum()
    }
}

/// What a part of a suite's runs has come to.
struct Part {
    runs: Vec<(usize, RunSummary)>,
    shared: Option<SharedInput>,
    /// Whether no run has been taken in yet, so that `shared` is not yet known.
    empty: bool,
    envelope: Envelope,
    grids: Vec<Arc<TimeGrid>>,
    defects: Vec<(usize, Vec<Defect>)>,
}

impl Part {
    fn new(joints: usize) -> Self {
        let envelope = Envelope::new(2 * joints);
        Self {
            runs: Vec::new(),
            shared: None,
            empty: true,
            envelope,
            grids: Vec::new(),
            defects: Vec::new(),
        }
    }

    fn grid(&mut self, grid: &TimeGrid) -> Arc<TimeGrid> {
        if let Some(known) = self.grids.iter().find(|known| grid.is_prefix_of(known)) {
            return Arc::clone(known);
        }
        self.grids.push(Arc::new(grid.clone()));
        Arc::clone(&self.grids[self.grids.len() - 1])
    }

    fn share(&mut self, other: Option<SharedInput>, joints: usize) {
        self.shared = if self.empty {
            other
        } else {
            self.shared.take().zip(other).and_then(|(a, b)| a.merge(b, joints))
        };
        self.empty = false;
    }

    fn merge(mut self, other: Self, joints: usize) -> Self {
        if !other.empty {
            self.share(other.shared, joints);
        }
        self.runs.extend(other.runs);
        self.defects.extend(other.defects);
        self.envelope.merge(&other.envelope);
        self
    }
}

fn read_suite(
    data: &DataSet,
    entry: &SuiteEntry,
    robot: &Robot,
    settings: &Settings,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Suite, Vec<Defect>> {
    let n = robot.joint_count();
    let done = std::sync::atomic::AtomicUsize::new(0);
    let take = |mut part: Part, (place, &index): (usize, &usize)| {
        match read_run(data, index, robot, settings) {
            Ok((run, shared)) => {
                part.envelope.include(index as u32, &run.states);
                let start = run.state(0).to_vec();
                let notes = data.run_notes(index, &run);
                let (samples, duration) =
                    (run.len(), shared.grid.times().last().copied().unwrap_or(0.0));
                let grid = part.grid(&shared.grid);
                let summary =
                    RunSummary { index, samples, duration, grid, start, sha256: run.sha256, notes };
                part.runs.push((place, summary));
                part.share(Some(shared), n);
            }
            Err(defects) => part.defects.push((place, defects)),
        }
        progress(done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1);
        part
    };
    let parts = entry.runs.par_iter().enumerate().fold(|| Part::new(n), take);
    let mut whole = parts.reduce(|| Part::new(n), |a, b| a.merge(b, n));
    if !whole.defects.is_empty() {
        whole.defects.sort_by_key(|(place, _)| *place);
        return Err(whole.defects.into_iter().flat_map(|(_, defects)| defects).collect());
    }
    whole.runs.sort_by_key(|(place, _)| *place);
    let runs: Vec<RunSummary> = whole.runs.into_iter().map(|(_, run)| run).collect();
    let own_start = settings.nominal == NominalStart::Own;
    let shared = whole.shared.filter(|_| !own_start);
    Ok(Suite {
        entry: entry.clone(),
        mean_start: mean_start(&runs, n),
        runs,
        shared,
        envelope: whole.envelope,
    })
}

/// A run with its grid and the input u along it.
pub(super) fn read_run(
    data: &DataSet,
    index: usize,
    robot: &Robot,
    settings: &Settings,
) -> Result<(Run, SharedInput), Vec<Defect>> {
    let run = data.read(index, Some(robot.joint_count()), settings.gap_limit, settings.until)?;
    let path = data.path(index);
    let defects = check_limits(&path, &run, robot);
    if !defects.is_empty() {
        return Err(defects);
    }
    let grid = TimeGrid::from_times(&run.times).map_err(|error| {
        vec![Defect::new(&path, None, error.to_string(), "sort the samples, drop duplicates")]
    })?;
    let mut inputs = Vec::with_capacity(run.torques.len());
    for k in 0..run.len() {
        inputs.extend(settings.torque.input(robot, run.q(k), run.qd(k), run.torque(k)));
    }
    Ok((run, SharedInput { grid, inputs }))
}

fn mean_start(runs: &[RunSummary], joints: usize) -> IntervalVector {
    let count = Interval::point(runs.len() as f64);
    DVector::from_fn(2 * joints, |i, _| {
        runs.iter().fold(Interval::ZERO, |sum, run| sum + Interval::point(run.start[i])) / count
    })
}

fn index_notes(data: &DataSet, chosen: &[SuiteEntry]) -> Vec<String> {
    let used: usize = chosen.iter().map(|entry| entry.runs.len()).sum();
    let mut notes = Vec::new();
    if used < data.runs().len() {
        let without = data.runs().iter().filter(|run| run.suite.is_none()).count();
        notes.push(format!(
            "{used} of the {} runs in {} are used: {} belong to suites that were not asked for, {without} to no suite",
            data.runs().len(),
            data.root().join("runs.csv").display(),
            data.runs().len() - used - without,
        ));
    }
    notes.extend(data.unlisted_note());
    notes
}

fn suite_notes(suite: &Suite, nominal: NominalStart) -> Vec<String> {
    let mut notes: Vec<String> = suite.runs.iter().flat_map(|run| run.notes.clone()).collect();
    let lengths = suite.runs.iter().map(|run| run.samples);
    let (shortest, longest) = (lengths.clone().min().unwrap_or(0), lengths.max().unwrap_or(0));
    if shortest < longest {
        let name = &suite.entry.name;
        notes.push(format!(
            "suite {name}: its runs have {shortest} to {longest} samples; each counts as far as it goes"
        ));
    }
    if suite.shared.is_none() && suite.runs.len() > 1 && nominal == NominalStart::Mean {
        notes.push(format!(
            "suite {}: its runs differ in input or sample times, so each run has its own nominal solution",
            suite.entry.name
        ));
    }
    notes
}
