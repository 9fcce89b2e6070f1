//! Simulated solutions, by which the settings of a flowpipe are chosen. Nothing is proved here.

use reachtube_ode::{Ensemble, InitialValueProblem};
use reachtube_scalar::{Interval, Lanes, PolynomialMap, SineCosine};

use crate::grid::TimeGrid;
use crate::polynomial::flowpipe::Flowpipe;
use crate::polynomial::system::PolynomialSystem;

/// Number of simulated solutions, a power of two.
const RUNS: usize = 32;

/// Number of integration steps between two samples.
const SUBSTEPS: usize = 4;

/// Largest number of variables of a map.
const MOST_VARIABLES: usize = 120;

type Eight = Lanes<8>;

/// Properties of a system from simulated solutions that start at vertices of the initial set.
pub(crate) struct Simulated {
    /// Widths at each sample, N for each.
    widths: Vec<f64>,
    /// Largest width of each state over all samples, N entries.
    largest: Vec<f64>,
    /// Mean change of the velocity from one step to the next relative to the velocity, of the
    /// state where it is largest.
    pub bend: f64,
}

impl Simulated {
    /// Simulates solutions from vertices of the box with the given sides, under inputs that are
    /// held from sample to sample.
    ///
    /// Returns `None` if a solution diverges, or for a system without variables or with too many.
    pub(crate) fn new(
        system: &PolynomialSystem,
        grid: &TimeGrid,
        sides: &[Interval],
        inputs: &[f64],
    ) -> Option<Self> {
        let (n, angles) = (system.states(), &system.angles.states);
        let variables = n + system.inputs() + 2 * angles.len();
        if !(1..=MOST_VARIABLES).contains(&variables) {
            return None;
        }
        let f: Vec<_> = system.components.iter().map(|f| f.map_coefficients(|c| c.mid())).collect();
        let map = PolynomialMap::new(variables, &f);
        let (mut ws, mut at) = (map.workspace(), Vec::new());
        let mut rate = |_: f64, x: &[Eight], u: &[Eight], dx: &mut [Eight]| {
            at.clear();
            at.extend(x.iter().chain(u).copied());
            at.extend(angles.iter().map(|i| x[*i].sin_cos().0));
            at.extend(angles.iter().map(|i| x[*i].sin_cos().1));
            map.evaluate_into(&at, &mut ws, dx);
        };
        let starts: Vec<_> = (0..RUNS).map(|run| vertex(sides, run)).collect();
        let runs: Vec<_> =
            starts.iter().map(|start| InitialValueProblem { start, inputs }).collect();
        let mut trace = Trace::new(n, grid.len());
        let observe = |run: usize, sample: usize, x: &[f64]| trace.record(run, sample, x);
        let mut ensemble = Ensemble::<Eight>::new(n);
        let outcomes = ensemble.integrate(&mut rate, grid.times(), SUBSTEPS, &runs, observe);
        outcomes.iter().all(|outcome| outcome.is_reached()).then(|| trace.summary())
    }

    /// Returns how many times as wide as the simulated solutions a flowpipe over all samples is.
    ///
    /// Widths are summed over samples and states, relative to the largest simulated width of the
    /// state. States without a width do not count.
    pub(crate) fn ratio(&self, flowpipe: &Flowpipe) -> f64 {
        let n = self.largest.len();
        let relative = |width: f64, i: usize| {
            if self.largest[i] > 0.0 { width / self.largest[i] } else { 0.0 }
        };
        let enclosed = (0..flowpipe.len()).flat_map(|k| flowpipe.sample(k).iter().enumerate());
        let enclosed: f64 = enclosed.map(|(i, side)| relative(side.width(), i)).sum();
        let simulated: f64 =
            self.widths.iter().enumerate().map(|(at, width)| relative(*width, at % n)).sum();
        if simulated > 0.0 { enclosed / simulated } else { 1.0 }
    }
}

/// Sums and bounds over simulated states at samples.
struct Trace {
    n: usize,
    /// Smallest and largest value of each state at each sample.
    ends: Vec<[f64; 2]>,
    /// State and change since the sample before, of each run.
    last: Vec<Vec<[f64; 2]>>,
    /// Sums of |x_{k+1} - x_k| and of its change from step to step, for each state.
    sums: Vec<[f64; 2]>,
}

impl Trace {
    fn new(n: usize, samples: usize) -> Self {
        Self {
            n,
            ends: vec![[f64::INFINITY, f64::NEG_INFINITY]; n * samples],
            last: vec![vec![[0.0; 2]; n]; RUNS],
            sums: vec![[0.0; 2]; n],
        }
    }

    fn record(&mut self, run: usize, sample: usize, x: &[f64]) {
        let ends = &mut self.ends[sample * self.n..];
        let states = ends.iter_mut().zip(&mut self.last[run]).zip(&mut self.sums);
        for ((([low, high], [last, step]), [travel, turn]), x) in states.zip(x) {
            (*low, *high) = (low.min(*x), high.max(*x));
            let moved = if sample > 0 { x - *last } else { 0.0 };
            *travel += moved.abs();
            if sample > 1 {
                *turn += (moved - *step).abs();
            }
            (*last, *step) = (*x, moved);
        }
    }

    fn summary(&self) -> Simulated {
        let widths: Vec<f64> = self.ends.iter().map(|[low, high]| high - low).collect();
        let of_state = |i: usize| widths[i..].iter().step_by(self.n).copied();
        let largest = (0..self.n).map(|i| of_state(i).fold(0.0, f64::max)).collect();
        let bends = self.sums.iter().filter(|[travel, _]| *travel > 0.0).map(|[t, turn]| turn / t);
        let bend = bends.fold(0.0, f64::max);
        Simulated { widths, largest, bend }
    }
}

/// Returns vertex `run` of a box. The vertices halve along each side, and are all vertices if there
/// are no more than runs.
fn vertex(sides: &[Interval], run: usize) -> Vec<f64> {
    let mut uncertain = 0..;
    let end = |side: &Interval| {
        if side.lo() == side.hi() {
            return side.lo();
        }
        let j = uncertain.next().unwrap_or(0) % (RUNS - 1);
        let mask = if 1 << j < RUNS { 1 << j } else { RUNS - 1 - j };
        if (run & mask).count_ones().is_multiple_of(2) { side.lo() } else { side.hi() }
    };
    sides.iter().map(end).collect()
}
