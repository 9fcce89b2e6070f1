//! The exact discretisation of a linear model over the spans of a sample grid, in floating point.

use std::collections::HashMap;

use nalgebra::DMatrix;
use reachtube_reach::LinearSystem;

/// e^{Ah} and ∫e^{Aτ}B dτ for each span of a grid, rounded to nearest.
#[derive(Debug, Clone)]
pub(crate) struct Steps {
    states: usize,
    inputs: usize,
    /// The distinct maps (x, u, 1) -> x, each 2n x (3n + 1), row by row.
    maps: Vec<Vec<f64>>,
    /// Which map each span has.
    of_span: Vec<usize>,
}

impl Steps {
    /// Discretises `system` over the spans between `times` (s). Spans that differ by less than a
    /// picosecond share a map.
    #[must_use]
    pub fn new(system: &LinearSystem, times: &[f64]) -> Self {
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
    pub fn advance(&self, k: usize, x: &[f64], u: &[f64], next: &mut [f64]) {
        let width = self.states + self.inputs + 1;
        let rows = self.maps[self.of_span[k]].chunks_exact(width);
        for (next, row) in next.iter_mut().zip(rows) {
            let (of_state, rest) = row.split_at(self.states);
            let state: f64 = of_state.iter().zip(x).map(|(a, x)| a * x).sum();
            let input: f64 = rest.iter().zip(u).map(|(b, u)| b * u).sum();
            *next = state + input + rest[self.inputs];
        }
    }
}

/// The map (x, u, 1) -> x(h) of ẋ = A x + B u + d.
fn map(system: &LinearSystem, h: f64) -> Vec<f64> {
    let (states, inputs) = (system.states(), system.inputs());
    let width = states + inputs + 1;
    let mut augmented = DMatrix::zeros(width, width);
    augmented.view_mut((0, 0), (states, states)).copy_from(&(system.a() * h));
    augmented.view_mut((0, states), (states, inputs)).copy_from(&(system.b() * h));
    augmented.view_mut((0, states + inputs), (states, 1)).copy_from(&(system.drift() * h));
    augmented.exp().rows(0, states).transpose().as_slice().to_vec()
}
