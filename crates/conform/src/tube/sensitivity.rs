//! A model linearised along its nominal motion: how far X0 and U move each state, to first order.

use reachtube_reach::{Disturbance, Nonlinear};

use crate::data::case::Case;
use crate::data::shape::Shape;
use crate::error::Result;
use crate::nominal::simulate::{simulate, substeps};
use crate::sets::UncertaintySets;
use crate::tube::direction::{Direction, DirectionRow};
use crate::tube::state_sensitivities::{Node, StateSensitivities};

/// Samples of a case at which worst-case motions are simulated, at most.
const NODES: usize = 24;

/// The motion of a model from the centre of X0 under the centre of U, and the linearisation along
/// it. Unrounded: no proof rests on it.
#[derive(Debug, Clone)]
pub(super) struct Sensitivity {
    shape: Shape,
    /// Samples x 2n.
    pub nominal: Vec<f64>,
    /// Number of Runge-Kutta steps from one sample to the next.
    pub substeps: usize,
    /// Samples x 2n x (3n, then 3n): E_k = (Φ(t_k, 0), ∫Φ(t_k, s) B ds), then R_k, as the program
    /// takes them.
    pub coefficients: Vec<f64>,
    /// Where worst-case motions of the model itself are simulated.
    pub nodes: Vec<Node>,
    /// The rows in the directions that were asked, in their order.
    pub directions: Vec<DirectionRow>,
}

impl Sensitivity {
    /// Linearises the model along `case` about the centres of `sets`, also in the directions
    /// `asked` after the first sample.
    ///
    /// # Errors
    ///
    /// The time, s, up to which the model could be followed, where it diverges.
    pub(super) fn new(
        system: &dyn Nonlinear,
        case: &Case,
        sets: &UncertaintySets,
        disturbance: Disturbance,
        asked: &[&Direction],
    ) -> Result<Self, f64> {
        let n = case.parts();
        let times = case.grid.times();
        let shifted = |values: &[f64], centre: &[f64]| -> Vec<f64> {
            values.iter().zip(centre.iter().cycle()).map(|(x, c)| x + c).collect()
        };
        let start = shifted(&case.start, &sets.initial_set.centre);
        let inputs = shifted(&case.inputs, &sets.input_set.centre);
        let mut slopes = system.slopes();
        let substeps = substeps(&mut *slopes, case, &start);
        let nominal = simulate(system, times, substeps, &start, &inputs)?;
        let shape = Shape::of_states(2 * n, n);
        let mut grown = StateSensitivities::new(shape, times.len(), disturbance);
        let stride = times.len().div_ceil(NODES).max(1);
        let mut found = Self {
            shape,
            nominal,
            substeps,
            coefficients: Vec::with_capacity(times.len() * shape.entries()),
            nodes: Vec::new(),
            directions: vec![DirectionRow::default(); asked.len()],
        };
        grown.write_into(&mut found.coefficients);
        let between = |pair: &[f64]| {
            let (before, after) = pair.split_at(2 * n);
            before.iter().zip(after).map(|(x, y)| 0.5 * (x + y)).collect::<Vec<f64>>()
        };
        let middles: Vec<Vec<f64>> =
            (1..times.len()).map(|k| between(&found.nominal[(k - 1) * 2 * n..][..4 * n])).collect();
        let points: Vec<(&[f64], &[f64])> =
            middles.iter().map(|x| &**x).zip(inputs.chunks_exact(n)).collect();
        slopes.along(&points, &mut |at, [a, b]| {
            let k = at + 1;
            grown.advance(a, b, times[k] - times[k - 1]);
            grown.write_into(&mut found.coefficients);
            for (row, asked) in found.directions.iter_mut().zip(asked) {
                if asked.at.1 as usize == k {
                    *row = grown.along(&asked.direction);
                }
            }
            if k % stride == 0 || k + 1 == times.len() {
                found.nodes.push(grown.node(k));
            }
        });
        Ok(found)
    }

    /// Returns row i of E_k and of R_k.
    pub(super) fn row(&self, k: usize, i: usize) -> (&[f64], &[f64]) {
        let width = self.shape.radii();
        let start = k * self.shape.entries() + i * 2 * width;
        self.coefficients[start..start + 2 * width].split_at(width)
    }
}
