use std::sync::Arc;

use rayon::prelude::*;
use reachtube_reach::{
    Disturbance, IntervalMatrix, LinearSystem, Propagation, ReachSets, TimeGrid,
};

use crate::error::Result;
use crate::sets::UncertaintySets;

/// A sample grid that suites share, with all that depends on the system and the grid only.
#[derive(Debug)]
pub(crate) struct Grid {
    pub times: Arc<TimeGrid>,
    pub propagation: Propagation,
    /// κ(t_k), the gains of the disturbance, 2n x n for each sample.
    pub input_gains: Vec<IntervalMatrix>,
}

impl Grid {
    /// Computes the reachable sets of the deviation on this grid.
    ///
    /// # Guarantee
    ///
    /// As [`ReachSets::new`].
    pub(crate) fn reach(&self, sets: &UncertaintySets) -> ReachSets {
        let UncertaintySets { initial_set, input_set, .. } = sets;
        ReachSets::new(&self.propagation, &self.input_gains, initial_set, input_set)
    }
}

/// The distinct grids of some recordings; a grid that is the beginning of another is not distinct.
#[derive(Debug)]
pub(crate) struct Grids {
    grids: Vec<Grid>,
}

impl Grids {
    /// Computes e^{At}, Γ(t) and κ(t) over the distinct ones of the grids `times`, on all cores.
    ///
    /// # Errors
    ///
    /// When the solution of the system cannot be enclosed over a grid.
    pub(crate) fn new<'a>(
        times: impl Iterator<Item = &'a TimeGrid>,
        system: &LinearSystem,
        disturbance: Disturbance,
    ) -> Result<Self> {
        let distinct = distinct(times);
        let build = |grid: &&TimeGrid| {
            let propagation = Propagation::new(system, grid)?;
            let input_gains = disturbance.input_gains(&propagation);
            Ok(Grid { times: Arc::new((*grid).clone()), propagation, input_gains })
        };
        let grids = distinct.par_iter().map(build).collect::<Result<_>>()?;
        Ok(Self { grids })
    }

    pub(crate) fn as_slice(&self) -> &[Grid] {
        &self.grids
    }

    /// Returns the index of the grid that `grid` is, or is the beginning of.
    ///
    /// # Panics
    ///
    /// When `grid` was not given to [`new`](Self::new).
    pub(crate) fn find(&self, grid: &TimeGrid) -> usize {
        let fits = |candidate: &Grid| grid.is_prefix_of(&candidate.times);
        self.grids.iter().position(fits).expect("every grid of the recordings is in the list")
    }
}

/// Returns the grids that are not the beginning of another one: the longest first, of equally long
/// ones the last to end, and then by their times, so that the order of the runs makes no
/// difference.
pub(crate) fn distinct<'a>(grids: impl Iterator<Item = &'a TimeGrid>) -> Vec<&'a TimeGrid> {
    let end = |grid: &TimeGrid| grid.times().last().copied().unwrap_or(0.0);
    let by_times = |a: &TimeGrid, b: &TimeGrid| {
        let mut pairs = a.times().iter().zip(b.times()).map(|(a, b)| a.total_cmp(b));
        pairs.find(|order| order.is_ne()).unwrap_or(a.step().is_some().cmp(&b.step().is_some()))
    };
    let mut all: Vec<&TimeGrid> = grids.collect();
    all.sort_by(|a, b| {
        let longest = b.len().cmp(&a.len()).then(end(b).total_cmp(&end(a)));
        longest.then_with(|| by_times(a, b))
    });
    let mut distinct: Vec<&TimeGrid> = Vec::new();
    for grid in all {
        if !distinct.iter().any(|longer| grid.is_prefix_of(longer)) {
            distinct.push(grid);
        }
    }
    distinct
}
