use std::collections::HashMap;
use std::sync::Arc;

use crate::data::envelope::Envelope;
use crate::sets::InputScale;
use crate::tube::deviation::Deviation;
use crate::tube::grids::Grid;
use crate::tube::place::Place;

/// The rows of one strand of a linear system, ready to be evaluated at the speed of memory.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    /// Sample times, s.
    pub times: Arc<[f64]>,
    /// Samples x states x (unknown centres, then radii): the entries of E_k, then of R_k.
    pub coefficients: Arc<Vec<f64>>,
    /// The factors of the entries of R_k, one per radius; empty if all are 1.
    pub scale: Arc<[f64]>,
    /// The deviations that must be covered.
    pub envelope: Envelope,
}

impl Block {
    pub(crate) fn of_places(
        grids: &[Grid],
        places: &[Place],
        deviations: &[Deviation],
    ) -> Vec<Self> {
        let on_grid = |grid: &Grid| Self {
            times: grid.propagation.grid().times().into(),
            coefficients: Arc::new(coefficients(grid)),
            scale: [].into(),
            envelope: Envelope::new(grid.propagation.system().states()),
        };
        let on_grids: Vec<Self> = grids.iter().map(on_grid).collect();
        let block = |place: &Place| {
            let block = on_grids[place.grid].clone();
            let starts = vec![1.0; block.envelope.dimension()];
            let InputScale(inputs) = &place.scale;
            let scale = if inputs.is_empty() {
                block.scale
            } else {
                [&starts, &inputs[..]].concat().into()
            };
            Self { scale, ..block }
        };
        let mut blocks: Vec<Self> = places.iter().map(block).collect();
        deviations.iter().for_each(|own| blocks[own.strand].envelope.merge(&own.envelope));
        blocks
    }

    /// Returns a block without rows that has the same coefficients.
    pub(crate) fn emptied(&self) -> Self {
        let Self { times, coefficients, scale, envelope } = self;
        Self {
            times: Arc::clone(times),
            coefficients: Arc::clone(coefficients),
            scale: Arc::clone(scale),
            envelope: Envelope::new(envelope.dimension()),
        }
    }

    /// Returns some radii times the block's factors; empty if these are 1, or if it has no rows.
    pub(crate) fn scaled(&self, radius: &[f64]) -> Vec<f64> {
        if self.envelope.is_empty() {
            return Vec::new();
        }
        self.scale.iter().zip(radius).map(|(factor, radius)| factor * radius).collect()
    }

    /// Returns, for each of some blocks, the first one that has the same coefficients: they differ
    /// in the factors of U alone.
    pub(crate) fn groups(blocks: &[Self]) -> Arc<[usize]> {
        let mut first = HashMap::new();
        let of = |(index, block): (usize, &Self)| {
            *first.entry(Arc::as_ptr(&block.coefficients)).or_insert(index)
        };
        blocks.iter().enumerate().map(of).collect()
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
