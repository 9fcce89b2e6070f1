use std::sync::Arc;

use crate::data::envelope::Envelope;
use crate::tube::deviation::Deviation;
use crate::tube::grids::Grid;

/// The rows of one sample grid of one linear system, ready to be evaluated at the speed of memory.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    /// Sample times, s.
    pub times: Vec<f64>,
    /// Samples x states x (unknown centres, then radii): the entries of E_k, then of R_k.
    pub coefficients: Arc<Vec<f64>>,
    /// The deviations that must be covered.
    pub envelope: Envelope,
}

impl Block {
    pub(crate) fn of_grids(grids: &[Grid], deviations: &[Deviation]) -> Vec<Self> {
        let none = |grid: &Grid| Envelope::new(grid.propagation.system().states());
        let mut merged: Vec<Envelope> = grids.iter().map(none).collect();
        deviations.iter().for_each(|deviation| merged[deviation.grid].merge(&deviation.envelope));
        let block = |(grid, envelope): (&Grid, Envelope)| Self {
            times: grid.propagation.grid().times().to_vec(),
            coefficients: Arc::new(coefficients(grid)),
            envelope,
        };
        grids.iter().zip(merged).map(block).collect()
    }
}

fn coefficients(grid: &Grid) -> Vec<f64> {
    let mut all = Vec::new();
    for (k, gain) in grid.input_gains.iter().enumerate() {
        let (e, g) = (grid.propagation.exponential(k), grid.propagation.integral(k));
        for i in 0..e.nrows() {
            all.extend(e.row(i).iter().chain(g.row(i).iter()).map(|x| x.mid()));
            all.extend(e.row(i).iter().map(|x| x.mid().abs()));
            all.extend(gain.row(i).iter().map(|x| x.lo()));
        }
    }
    all
}
