//! The exact discretisation of a linear model over the spans of a sample grid, in floating point.

use std::collections::HashMap;

use nalgebra::DMatrix;
use reachtube_reach::LinearSystem;
use reachtube_scalar::{Dispatch, Kernel, Lanes, Lanewise};

/// Rows of a map that are computed at once.
const ROWS: usize = 4;

/// An entry of each of some rows.
type Rows = Lanes<ROWS>;

/// e^{Ah} and ∫e^{Aτ}B dτ for each span of a grid, rounded to nearest.
#[derive(Debug, Clone)]
pub(crate) struct LinearSteps {
    states: usize,
    inputs: usize,
    /// The distinct maps (x, u, 1) -> x, each 2n x (3n + 1): some rows after the other, and in them
    /// column by column.
    maps: Vec<Vec<Rows>>,
    of_span: Vec<usize>,
}

impl LinearSteps {
    /// Discretises `system` over the spans between `times` (s). Spans that differ by less than a
    /// picosecond share a map.
    pub(crate) fn new(system: &LinearSystem, times: &[f64]) -> Self {
        let (states, inputs) = (system.states(), system.inputs());
        let (mut maps, mut known) = (Vec::new(), HashMap::new());
        let of_span = times
            .windows(2)
            .map(|pair| {
                let span = pair[1] - pair[0];
                *known.entry((span * 1e12).round() as i64).or_insert_with(|| {
                    maps.push(map(system, span));
                    maps.len() - 1
                })
            })
            .collect();
        Self { states, inputs, maps, of_span }
    }

    /// Computes the state after span `k` from the state `x` under the input `u` into `next`.
    pub(crate) fn advance(&self, k: usize, x: &[f64], u: &[f64], next: &mut [f64]) {
        Rows::dispatch(Advance { map: &self.maps[self.of_span[k]], x, u, next });
    }

    /// Returns the entries of E_k and R_k of a linear program at every `stride`-th sample, for
    /// `samples` samples: as a [`Block`](crate::program::Block) has them, but rounded to nearest,
    /// and exact for spans of one length only. A disturbance that is measurable counts as one that
    /// is constant over samples.
    pub(crate) fn coefficients(&self, samples: usize, stride: usize, constant: bool) -> Vec<f64> {
        let (states, inputs) = (self.states, self.inputs);
        let mut coefficients = Vec::with_capacity(samples.div_ceil(stride) * states * 6 * inputs);
        let maps: Vec<DMatrix<f64>> = self.maps.iter().map(|map| self.matrix(map)).collect();
        let mut exponential = DMatrix::<f64>::identity(states, states);
        let mut integral = DMatrix::<f64>::zeros(states, inputs);
        let mut gains = integral.clone();
        let mut moved = DMatrix::zeros(states, states + inputs);
        for k in 0..samples {
            if k % stride == 0 {
                for i in 0..states {
                    let (e, g) = (exponential.row(i), integral.row(i));
                    coefficients.extend(e.iter().chain(g.iter()));
                    coefficients.extend(e.iter().map(|x| x.abs()));
                    match constant {
                        true => coefficients.extend(g.iter().map(|x| x.abs())),
                        false => coefficients.extend(gains.row(i).iter()),
                    }
                }
            }
            if k + 1 < samples {
                exponential.mul_to(&maps[self.of_span[k]], &mut moved);
                integral += moved.columns(states, inputs);
                gains.zip_apply(&moved.columns(states, inputs), |sum, x| *sum += x.abs());
                exponential.copy_from(&moved.columns(0, states));
            }
        }
        coefficients
    }

    /// The map (x, u) -> x of one span, 2n x 3n.
    fn matrix(&self, map: &[Rows]) -> DMatrix<f64> {
        let width = self.states + self.inputs;
        let entry = |i: usize, j: usize| map[i / ROWS * (width + 1) + j].lane(i % ROWS);
        DMatrix::from_fn(self.states, width, entry)
    }
}

/// The arguments of [`LinearSteps::advance`].
struct Advance<'a> {
    map: &'a [Rows],
    x: &'a [f64],
    u: &'a [f64],
    next: &'a mut [f64],
}

impl Kernel for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { map, x, u, next } = self;
        let (states, inputs) = (next.len(), u.len());
        let rows = map.chunks_exact(states + inputs + 1);
        for (next, columns) in next.chunks_mut(ROWS).zip(rows) {
            let (of_state, rest) = columns.split_at(states);
            let (of_input, drift) = rest.split_at(inputs);
            let sum = weighted(of_state, x) + weighted(of_input, u) + drift[0];
            next.iter_mut().enumerate().for_each(|(i, next)| *next = sum.lane(i));
        }
    }
}

#[inline(always)]
fn weighted(columns: &[Rows], factors: &[f64]) -> Rows {
    let mut sum = Rows::from(0.0);
    for (column, factor) in columns.iter().zip(factors) {
        sum += *column * Rows::from(*factor);
    }
    sum
}

/// The map (x, u, 1) -> x(h) of ẋ = A x + B u + d.
fn map(system: &LinearSystem, h: f64) -> Vec<Rows> {
    let (states, inputs) = (system.states(), system.inputs());
    let width = states + inputs + 1;
    let mut augmented = DMatrix::zeros(width, width);
    augmented.view_mut((0, 0), (states, states)).copy_from(&(system.a() * h));
    augmented.view_mut((0, states), (states, inputs)).copy_from(&(system.b() * h));
    augmented.view_mut((0, states + inputs), (states, 1)).copy_from(&(system.drift() * h));
    let map = augmented.exp();
    let entry = |i: usize, j: usize| if i < states { map[(i, j)] } else { 0.0 };
    let places = (0..states).step_by(ROWS).flat_map(|i| (0..width).map(move |j| (i, j)));
    places.map(|(first, j)| Rows::from_lanes(|lane| entry(first + lane, j))).collect()
}
