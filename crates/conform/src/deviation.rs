//! d = x_m(t_k) - x̂(t_k): what the uncertainty sets must cover.

use rayon::prelude::*;
use reachtube_reach::{
    Disturbance, IntervalMatrix, IntervalVector, LinearSystem, Propagation, ReachSets, TimeGrid,
    Trajectory,
};
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{sub_down, sub_up};

use super::recordings::{Recordings, RunSummary, SharedInput, Suite, read_run};
use super::{Envelope, NominalStart, Settings, UncertaintySets};
use crate::error::Result;
use reachtube_recordings::{DataSet, Run};

/// A sample grid that suites share, with all that depends on the system and the grid only.
#[derive(Debug)]
pub struct Grid {
    /// e^{A t_k}, Γ(t_k).
    pub propagation: Propagation,
    /// κ(t_k).
    pub gains: Vec<IntervalMatrix>,
}

impl Grid {
    /// The reachable sets of the deviation on this grid.
    ///
    /// # Guarantee
    ///
    /// As [`ReachSets::new`].
    pub fn reach(&self, sets: &UncertaintySets) -> ReachSets {
        ReachSets::new(&self.propagation, &self.gains, &sets.initial_set, &sets.input_set)
    }
}

/// The distinct grids of some recordings; a grid that is the beginning of another is not distinct.
#[derive(Debug)]
pub struct Grids {
    grids: Vec<Grid>,
}

impl Grids {
    /// The grids of `recordings`, the longest first.
    ///
    /// # Errors
    ///
    /// When the solution of the system cannot be enclosed over a grid.
    pub fn new(
        recordings: &Recordings,
        system: &LinearSystem,
        disturbance: Disturbance,
    ) -> Result<Self> {
        let mut all: Vec<&TimeGrid> = recordings
            .suites
            .iter()
            .flat_map(|suite| suite.runs.iter().map(|run| run.grid.as_ref()))
            .collect();
        all.sort_by(|a, b| {
            b.len()
                .cmp(&a.len())
                .then(b.times().last().unwrap_or(&0.0).total_cmp(a.times().last().unwrap_or(&0.0)))
        });
        let mut distinct: Vec<&TimeGrid> = Vec::new();
        for grid in all {
            if !distinct.iter().any(|longer| grid.is_prefix_of(longer)) {
                distinct.push(grid);
            }
        }
        let build = |grid: &&TimeGrid| {
            let propagation = Propagation::new(system, grid)?;
            let gains = disturbance.gains(&propagation);
            Ok(Grid { propagation, gains })
        };
        let grids = distinct.par_iter().map(build).collect::<Result<_>>()?;
        Ok(Self { grids })
    }

    /// The grids.
    pub fn as_slice(&self) -> &[Grid] {
        &self.grids
    }

    /// The index of the grid that `grid` is, or is the beginning of.
    pub fn find(&self, grid: &TimeGrid) -> usize {
        let fits = |candidate: &Grid| grid.is_prefix_of(candidate.propagation.grid());
        self.grids.iter().position(fits).expect("every grid of the recordings is in the list")
    }
}

/// The envelope of the deviations of one suite on one grid.
#[derive(Debug, Clone)]
pub struct Deviation {
    /// Index of the grid.
    pub grid: usize,
    /// The deviations; each bound is outer.
    pub envelope: Envelope,
}

/// A nominal solution x̂ of the model.
#[derive(Debug, Clone)]
pub struct RunNominal {
    /// The run (index in the data set) that it belongs to; none when it is that of the whole suite.
    pub run: Option<usize>,
    /// Index of the grid.
    pub grid: usize,
    /// The input u, row-major, samples x n.
    pub inputs: Vec<f64>,
    /// x̂ at the samples, enclosed.
    pub trajectory: Trajectory,
}

/// The nominal solution of a suite, or one for each run where the runs differ in input.
///
/// # Errors
///
/// Defects of a run that has changed since it was first read.
pub fn nominals(
    data: &DataSet,
    robot: &Robot,
    settings: &Settings,
    grids: &Grids,
    suite: &Suite,
) -> Result<Vec<RunNominal>> {
    match &suite.shared {
        Some(shared) => Ok(vec![shared_nominal(grids, suite, shared)]),
        None => {
            let own = |run: &RunSummary| {
                Ok(own_nominal(data, robot, settings, grids, suite, run.index)?.0)
            };
            suite.runs.par_iter().map(own).collect()
        }
    }
}

fn shared_nominal(grids: &Grids, suite: &Suite, shared: &SharedInput) -> RunNominal {
    let grid = grids.find(&shared.grid);
    let trajectory = grids.as_slice()[grid].propagation.solve(&suite.mean_start, &shared.inputs);
    RunNominal { run: None, grid, inputs: shared.inputs.clone(), trajectory }
}

/// The deviations of a suite from its nominal solution, or from one for each run where the runs
/// differ in input.
///
/// # Guarantee
///
/// Outer: the exact deviation of every run from the exact solution of the model lies in the
/// envelope.
///
/// # Errors
///
/// Defects of a run that has changed since it was first read.
pub fn suite_deviations(
    data: &DataSet,
    robot: &Robot,
    settings: &Settings,
    grids: &Grids,
    suite: &Suite,
) -> Result<Vec<Deviation>> {
    match &suite.shared {
        Some(shared) => {
            let nominal = shared_nominal(grids, suite, shared);
            let envelope = suite.envelope.map(
                |k, i, upper| sub_up(upper, nominal.trajectory.state(k)[i].lo()),
                |k, i, lower| sub_down(lower, nominal.trajectory.state(k)[i].hi()),
            );
            Ok(vec![Deviation { grid: nominal.grid, envelope }])
        }
        None => own_deviations(data, robot, settings, grids, suite),
    }
}

fn own_deviations(
    data: &DataSet,
    robot: &Robot,
    settings: &Settings,
    grids: &Grids,
    suite: &Suite,
) -> Result<Vec<Deviation>> {
    let parts = suite.runs.par_iter().map(|summary| {
        let (nominal, run) = own_nominal(data, robot, settings, grids, suite, summary.index)?;
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for k in 0..run.len() {
            for (x, nominal) in run.state(k).iter().zip(nominal.trajectory.state(k)) {
                upper.push(sub_up(*x, nominal.lo()));
                lower.push(sub_down(*x, nominal.hi()));
            }
        }
        let mut envelope = Envelope::new(2 * run.joints);
        envelope.include_bounds(summary.index as u32, &lower, &upper);
        Ok(Deviation { grid: nominal.grid, envelope })
    });
    let mut merged: Vec<Deviation> = Vec::new();
    for part in parts.collect::<Result<Vec<_>>>()? {
        match merged.iter_mut().find(|deviation| deviation.grid == part.grid) {
            Some(deviation) => deviation.envelope.merge(&part.envelope),
            None => merged.push(part),
        }
    }
    Ok(merged)
}

/// The nominal solution of one run under its own input.
fn own_nominal(
    data: &DataSet,
    robot: &Robot,
    settings: &Settings,
    grids: &Grids,
    suite: &Suite,
    index: usize,
) -> Result<(RunNominal, Run)> {
    let (run, input) =
        read_run(data, index, robot, settings).map_err(reachtube_recordings::Error::Defects)?;
    let start = match settings.nominal {
        NominalStart::Mean => suite.mean_start.clone(),
        NominalStart::Own => {
            IntervalVector::from_fn(2 * run.joints, |i, _| Interval::point(run.state(0)[i]))
        }
    };
    let grid = grids.find(&input.grid);
    let trajectory = grids.as_slice()[grid].propagation.solve(&start, &input.inputs);
    Ok((RunNominal { run: Some(index), grid, inputs: input.inputs, trajectory }, run))
}
