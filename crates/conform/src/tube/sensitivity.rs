//! A model linearised along its nominal motion: how far X0 and U move each state, to first order.

use nalgebra::{DMatrix, DVector};
use reachtube_abstraction::{Linearisation, PolynomialModel};
use reachtube_reach::Disturbance;
use reachtube_scalar::Lanes;

use crate::data::case::Case;
use crate::data::shape::Shape;
use crate::error::Result;
use crate::nominal::simulate::{simulate, substeps};
use crate::sets::UncertaintySets;
use crate::tube::direction::{Direction, DirectionRow};

/// Several motions that are simulated at once.
pub(super) type Many = Lanes<8>;

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

/// The signs of the sensitivities of each state at one sample.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// The sample.
    pub sample: usize,
    /// For each state, the signs of its row of Φ(t_k, 0): 2n x 2n.
    pub start: Vec<f64>,
    /// For each earlier sample, input and state, the sign of the state's derivative with respect to
    /// that input over that sample: samples x n x 2n.
    pub input: Vec<f64>,
}

impl Sensitivity {
    /// Linearises the model along `case` about the centres of `sets`, also in the directions
    /// `asked` after the first sample.
    ///
    /// # Errors
    ///
    /// The time, s, up to which the model could be followed, where it runs away.
    pub(super) fn new(
        model: &PolynomialModel,
        case: &Case,
        sets: &UncertaintySets,
        disturbance: Disturbance,
        asked: &[&Direction],
    ) -> Result<Self, f64> {
        let n = case.joints();
        let times = case.grid.times();
        let shifted = |values: &[f64], centre: &[f64]| -> Vec<f64> {
            values.iter().zip(centre.iter().cycle()).map(|(x, c)| x + c).collect()
        };
        let start = shifted(&case.start, &sets.initial_set.centre);
        let inputs = shifted(&case.inputs, &sets.input_set.centre);
        let mut linearisation = Linearisation::new(model);
        let substeps = substeps(&mut linearisation, case, &start);
        let nominal = simulate(model, times, substeps, &start, &inputs)?;
        let shape = Shape { states: 2 * n, inputs: n };
        let mut grown = Sensitivities::new(shape, times.len(), disturbance);
        let stride = times.len().div_ceil(NODES).max(1);
        let mut found = Self {
            shape,
            nominal,
            substeps,
            coefficients: Vec::new(),
            nodes: Vec::new(),
            directions: vec![DirectionRow::default(); asked.len()],
        };
        grown.write_into(&mut found.coefficients);
        for k in 1..times.len() {
            let (before, after) = found.nominal[(k - 1) * 2 * n..(k + 1) * 2 * n].split_at(2 * n);
            let middle: Vec<f64> = before.iter().zip(after).map(|(x, y)| 0.5 * (x + y)).collect();
            let (a, b) = linearisation.at(&middle, &inputs[(k - 1) * n..k * n]);
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
        }
        Ok(found)
    }

    /// Returns row i of E_k and of R_k.
    pub(super) fn row(&self, k: usize, i: usize) -> (&[f64], &[f64]) {
        let width = self.shape.radii();
        let start = k * self.shape.entries() + i * 2 * width;
        self.coefficients[start..start + 2 * width].split_at(width)
    }
}

/// The sensitivities of the state at one sample to the start and to every earlier input.
struct Sensitivities {
    shape: Shape,
    disturbance: Disturbance,
    /// Φ(t_k, 0).
    start: DMatrix<f64>,
    /// Φ(t_k, t_{j+1}) Γ_j, n columns for each sample j < k.
    inputs: DMatrix<f64>,
    spare: DMatrix<f64>,
    samples: usize,
}

impl Sensitivities {
    fn new(shape: Shape, samples: usize, disturbance: Disturbance) -> Self {
        let inputs = DMatrix::zeros(shape.states, shape.inputs * samples.saturating_sub(1));
        let start = DMatrix::identity(shape.states, shape.states);
        Self { shape, disturbance, start, spare: inputs.clone(), inputs, samples: 0 }
    }

    /// Advances by one step of length h (s) of δẋ = A δx + B δu.
    fn advance(&mut self, a: &DMatrix<f64>, b: &DMatrix<f64>, h: f64) {
        let Shape { states, inputs: n } = self.shape;
        let mut augmented = DMatrix::zeros(states + n, states + n);
        augmented.view_mut((0, 0), (states, states)).copy_from(&(a * h));
        augmented.view_mut((0, states), (states, n)).copy_from(&(b * h));
        let exponential = augmented.exp();
        let phi = exponential.view((0, 0), (states, states));
        self.start = phi * &self.start;
        let columns = n * self.samples;
        self.spare.columns_mut(0, columns).gemm(1.0, &phi, &self.inputs.columns(0, columns), 0.0);
        self.spare.columns_mut(columns, n).copy_from(&exponential.view((0, states), (states, n)));
        std::mem::swap(&mut self.inputs, &mut self.spare);
        self.samples += 1;
    }

    /// Appends the rows of E_k and R_k.
    fn write_into(&self, coefficients: &mut Vec<f64>) {
        let Shape { states, inputs: n } = self.shape;
        let (mut sum, mut total) = (DMatrix::zeros(states, n), DMatrix::zeros(states, n));
        for j in 0..self.samples {
            let gamma = self.inputs.columns(j * n, n);
            sum += gamma;
            total.zip_apply(&gamma, |total: &mut f64, x| *total += x.abs());
        }
        if self.disturbance == Disturbance::Constant {
            total = sum.abs();
        }
        for i in 0..states {
            coefficients.extend(self.start.row(i).iter().chain(sum.row(i).iter()));
            coefficients.extend(self.start.row(i).iter().map(|x| x.abs()));
            coefficients.extend(total.row(i).iter());
        }
    }

    /// The row in direction l.
    fn along(&self, l: &[f64]) -> DirectionRow {
        let l = DVector::from_column_slice(l);
        let n = self.shape.inputs;
        let start = self.start.tr_mul(&l);
        let inputs = self.inputs.columns(0, n * self.samples).tr_mul(&l);
        let (mut sum, mut total) = (vec![0.0; n], vec![0.0; n]);
        for (at, x) in inputs.iter().enumerate() {
            sum[at % n] += x;
            total[at % n] += x.abs();
        }
        if self.disturbance == Disturbance::Constant {
            total = sum.iter().map(|x| x.abs()).collect();
        }
        let radius = start.iter().map(|x| x.abs()).chain(total).collect();
        DirectionRow { centre: start.iter().copied().chain(sum).collect(), radius }
    }

    fn node(&self, sample: usize) -> Node {
        let Shape { states, inputs: n } = self.shape;
        let used = self.inputs.columns(0, n * self.samples);
        let input = match self.disturbance {
            Disturbance::Constant => {
                let mut sum = DMatrix::zeros(states, n);
                (0..self.samples).for_each(|j| sum += used.columns(j * n, n));
                sum.as_slice().repeat(self.samples)
            }
            Disturbance::Sample | Disturbance::Measurable => used.iter().copied().collect(),
        };
        let signs = |values: Vec<f64>| values.into_iter().map(f64::signum).collect();
        Node {
            sample,
            start: signs(self.start.transpose().as_slice().to_vec()),
            input: signs(input),
        }
    }
}
