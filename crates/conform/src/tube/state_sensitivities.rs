//! The sensitivities of the state at one sample to the start and to every earlier input.

use nalgebra::DMatrix;
use reachtube_reach::Disturbance;

use crate::data::shape::Shape;
use crate::nominal::transition::Transition;
use crate::tube::direction::DirectionRow;

/// Number of samples whose sensitivities lie side by side, so that one pass of vector instructions
/// advances them.
const SIDE_BY_SIDE: usize = 8;

/// The sensitivities of some samples.
type Block = [f64; SIDE_BY_SIDE];

/// The signs of the sensitivities of each state at one sample.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub sample: usize,
    /// For each state, the signs of its row of Φ(t_k, 0): 2n x 2n.
    pub start: Vec<f64>,
    /// For each earlier sample, input and state, the sign of the state's derivative with respect to
    /// that input over that sample: samples x n x 2n.
    pub input: Vec<f64>,
}

/// Φ(t_k, 0), and Φ(t_k, t_{j+1}) Γ_j for each sample j < k. Unrounded: no proof rests on it.
pub(super) struct StateSensitivities {
    shape: Shape,
    disturbance: Disturbance,
    transition: Transition,
    /// Row-major, states x states.
    start: Vec<f64>,
    /// For each input, each block of samples and each state, the sensitivities; 0 for samples to
    /// come.
    inputs: Vec<Block>,
    /// Number of blocks of each input.
    blocks: usize,
    samples: usize,
    /// The sums over the samples and the sums of the magnitudes, row-major, states x inputs.
    sums: [Vec<f64>; 2],
    /// Scratch memory: `start` and a block of all states before the step, and the sums of each
    /// state over the samples that lie at the same place of their blocks.
    start_before: Vec<f64>,
    before: Vec<Block>,
    partial: Vec<[Block; 2]>,
}

impl StateSensitivities {
    pub(super) fn new(shape: Shape, samples: usize, disturbance: Disturbance) -> Self {
        let Shape { states, inputs, .. } = shape;
        let blocks = samples.div_ceil(SIDE_BY_SIDE);
        Self {
            shape,
            disturbance,
            transition: Transition::new(states, inputs),
            start: DMatrix::identity(states, states).as_slice().to_vec(),
            inputs: vec![[0.0; SIDE_BY_SIDE]; inputs * blocks * states],
            blocks,
            samples: 0,
            sums: [vec![0.0; states * inputs], vec![0.0; states * inputs]],
            start_before: vec![0.0; states * states],
            before: vec![[0.0; SIDE_BY_SIDE]; states],
            partial: vec![[[0.0; SIDE_BY_SIDE]; 2]; states],
        }
    }

    /// Advances by one step of length h (s) of δẋ = A δx + B δu.
    pub(super) fn advance(&mut self, a: &DMatrix<f64>, b: &DMatrix<f64>, h: f64) {
        let Shape { states, inputs, .. } = self.shape;
        self.transition.update(a, b, h);
        let Transition { phi, gamma, .. } = &self.transition;
        self.start_before.copy_from_slice(&self.start);
        for (row, phi) in self.start.chunks_exact_mut(states).zip(phi.chunks_exact(states)) {
            row.fill(0.0);
            for (x, start) in phi.iter().zip(self.start_before.chunks_exact(states)) {
                row.iter_mut().zip(start).for_each(|(row, start)| *row += x * start);
            }
        }
        let used = self.samples.div_ceil(SIDE_BY_SIDE) * states;
        for (j, of_input) in self.inputs.chunks_exact_mut(self.blocks * states).enumerate() {
            self.partial.fill([[0.0; SIDE_BY_SIDE]; 2]);
            for block in of_input[..used].chunks_exact_mut(states) {
                self.before.copy_from_slice(block);
                let rows = block.iter_mut().zip(phi.chunks_exact(states)).zip(&mut self.partial);
                for ((after, phi), [sum, total]) in rows {
                    *after = combined(phi, &self.before);
                    for (lane, x) in after.iter().enumerate() {
                        sum[lane] += x;
                        total[lane] += x.abs();
                    }
                }
            }
            let (block, lane) = (self.samples / SIDE_BY_SIDE, self.samples % SIDE_BY_SIDE);
            for (i, [sum, total]) in self.partial.iter().enumerate() {
                let at = i * inputs + j;
                of_input[block * states + i][lane] = gamma[at];
                self.sums[0][at] = sum.iter().sum::<f64>() + gamma[at];
                self.sums[1][at] = total.iter().sum::<f64>() + gamma[at].abs();
            }
        }
        self.samples += 1;
    }

    /// Appends the rows of E_k and R_k.
    pub(super) fn write_into(&self, coefficients: &mut Vec<f64>) {
        let Shape { states, inputs, .. } = self.shape;
        let rows = self.sums.each_ref().map(|sums| sums.chunks_exact(inputs));
        let [sums, totals] = rows;
        for ((start, sum), total) in self.start.chunks_exact(states).zip(sums).zip(totals) {
            coefficients.extend(start.iter().chain(sum));
            coefficients.extend(start.iter().map(|x| x.abs()));
            match self.disturbance {
                Disturbance::Constant => coefficients.extend(sum.iter().map(|x| x.abs())),
                Disturbance::Sample | Disturbance::Measurable => coefficients.extend(total),
            }
        }
    }

    pub(super) fn along(&self, l: &[f64]) -> DirectionRow {
        let Shape { states, inputs, .. } = self.shape;
        let weighted = |column: &mut dyn Iterator<Item = f64>| -> f64 {
            l.iter().zip(column).map(|(l, x)| l * x).sum()
        };
        let column = |j: usize| (0..states).map(move |i| self.start[i * states + j]);
        let start: Vec<f64> = (0..states).map(|j| weighted(&mut column(j))).collect();
        let (mut sum, mut total) = (vec![0.0; inputs], vec![0.0; inputs]);
        for j in 0..inputs {
            for sample in 0..self.samples {
                let x = weighted(&mut (0..states).map(|i| self.input(j, sample, i)));
                sum[j] += x;
                total[j] += x.abs();
            }
        }
        if self.disturbance == Disturbance::Constant {
            total = sum.iter().map(|x| x.abs()).collect();
        }
        let radius = start.iter().map(|x| x.abs()).chain(total).collect();
        DirectionRow { centre: start.into_iter().chain(sum).collect(), radius }
    }

    pub(super) fn node(&self, sample: usize) -> Node {
        let Shape { states, inputs, .. } = self.shape;
        let places = (0..self.samples)
            .flat_map(|at| (0..inputs).flat_map(move |j| (0..states).map(move |i| (at, j, i))));
        let sign = |(at, j, i): (usize, usize, usize)| match self.disturbance {
            Disturbance::Constant => self.sums[0][i * inputs + j].signum(),
            Disturbance::Sample | Disturbance::Measurable => self.input(j, at, i).signum(),
        };
        Node {
            sample,
            start: self.start.iter().map(|x| x.signum()).collect(),
            input: places.map(sign).collect(),
        }
    }

    fn input(&self, j: usize, sample: usize, i: usize) -> f64 {
        let block = j * self.blocks + sample / SIDE_BY_SIDE;
        self.inputs[block * self.shape.states + i][sample % SIDE_BY_SIDE]
    }
}

/// Returns Σ factors · blocks.
#[inline]
fn combined(factors: &[f64], blocks: &[Block]) -> Block {
    let mut sum = [0.0; SIDE_BY_SIDE];
    for (factor, block) in factors.iter().zip(blocks) {
        sum.iter_mut().zip(block).for_each(|(sum, x)| *sum += factor * x);
    }
    sum
}
