//! ∫ |e^{Aτ} B| dτ, entry by entry: the total variation of Γ. Where an entry of e^{Aτ} B keeps its
//! sign, the integral of its absolute value is the absolute value of its integral, in closed form;
//! where it may change sign, the cell is halved until the rest does not matter.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_scalar::Interval;

use crate::exponential::{norm_upper, step};
use crate::matrix::{IntervalMatrix, magnitude, point, product};
use crate::series::{Polynomial, Series};
use crate::sums::{ends, running_sum};
use crate::{LinearSystem, Propagation};

/// A piece of the integral is left as an interval once its outer bound is below this part of the
/// largest entry of its cell.
const NEGLIGIBLE: f64 = 1e-13;

/// Norm of A h above which the series of one cell would lose digits to cancellation, and cells are
/// made shorter than the step h.
const CELL_NORM: f64 = 2.0;

/// Cells of one step at most.
const MOST_CELLS: usize = 256;

/// κ(t_k) = ∫₀^{t_k} |e^{Aτ} B| dτ at every sample.
///
/// # Guarantee
///
/// Outer enclosure, directed rounding; the width is about 1e-12 of the value.
pub(crate) fn measurable_gains(propagation: &Propagation) -> Vec<IntervalMatrix> {
    Cells::new(propagation).gains()
}

/// The integral, cell by cell.
struct Cells<'a> {
    /// Of the grid itself, or of a finer one where a step is long for the system.
    propagation: Cow<'a, Propagation>,
    /// Cells of one step of the grid.
    parts: usize,
    series: Series,
    within: Within,
    /// ∫ |e^{Aτ} B| over each cell.
    integrals: Vec<IntervalMatrix>,
    /// For each entry, the cells in which it may change sign.
    turning: DMatrix<Vec<usize>>,
}

impl<'a> Cells<'a> {
    fn new(propagation: &'a Propagation) -> Self {
        let (propagation, parts) = refine(propagation);
        let system = propagation.system();
        let longest = propagation.grid().longest_step();
        let within = Within::new(system, longest);
        let series = Series::new(system, longest);
        let turning = DMatrix::from_element(system.states(), system.inputs(), Vec::new());
        let mut cells = Self { parts, series, within, integrals: Vec::new(), turning, propagation };
        let count = cells.propagation.grid().len().saturating_sub(1);
        let (integrals, turns): (Vec<_>, Vec<_>) =
            (0..count).into_par_iter().map(|k| cells.cell(k)).unzip();
        cells.integrals = integrals;
        for (k, entries) in turns.into_iter().enumerate() {
            entries.into_iter().for_each(|entry| cells.turning[entry].push(k));
        }
        cells
    }

    /// ∫ |e^{Aτ} B| over cell k, and the entries that may change sign in it.
    fn cell(&self, k: usize) -> (IntervalMatrix, Vec<(usize, usize)>) {
        let start = &self.propagation.exponential(k);
        let h = self.propagation.grid().interval(k);
        let range = self.within.range(start);
        let change = self.propagation.increment(k);
        let scale = range.iter().fold(0.0, |max: f64, x| max.max(x.mag()));
        let negligible = NEGLIGIBLE * scale * h.hi();
        let mut turns = Vec::new();
        let integral = IntervalMatrix::from_fn(range.nrows(), range.ncols(), |i, j| {
            let range = range[(i, j)];
            if !range.contains_zero() || range == Interval::ZERO {
                return change[(i, j)].abs();
            }
            let entry = self.series.entry(start, i, j);
            if entry.may_turn(Interval::ZERO.hull(h), negligible) {
                turns.push((i, j));
            }
            entry.integral_of_absolute(Interval::ZERO, h, negligible)
        });
        (integral, turns)
    }

    /// The sum of the cells up to each sample.
    fn gains(&self) -> Vec<IntervalMatrix> {
        let fine = running_sum(self.propagation.system(), self.propagation.grid().len(), |k| {
            ends(self.integrals[k].as_slice())
        });
        fine.into_iter().step_by(self.parts).collect()
    }

    /// A lower bound of Σ_j |Γ(t_k - t_j) - Γ(t_k - t_{j+1})| in entry (i, j), for every sample k
    /// of a grid with these `times`.
    fn variation_at_least(&self, times: &[f64], (i, j): (usize, usize)) -> Vec<f64> {
        let mut integral =
            IntegralEntry { cells: self, entry: (i, j), polynomials: BTreeMap::new() };
        let total = |k: usize| {
            let nodes =
                nodes_around(times, k, &self.turning[(i, j)], self.propagation.grid().times());
            let values: Vec<Interval> =
                nodes.iter().map(|&l| integral.between(times[l], times[k])).collect();
            values.windows(2).fold(Interval::ZERO, |sum, v| sum + (v[1] - v[0]).abs()).lo()
        };
        (0..times.len()).map(total).collect()
    }
}

/// e^{Aτ} B for 0 <= τ <= L, to second order about L/2: value + slope (τ - L/2) + bend (τ -
/// L/2)²/2.
struct Within {
    value: IntervalMatrix,
    slope: IntervalMatrix,
    bend: IntervalMatrix,
    /// L.
    longest: f64,
}

impl Within {
    fn new(system: &LinearSystem, longest: f64) -> Self {
        let (a, b) = (point(system.a()), point(system.b()));
        let value = product(&step(system, Interval::point(0.5 * longest)).phi, &b);
        let over_cell =
            product(&step(system, Interval::ZERO.hull(Interval::point(longest))).phi, &b);
        Self {
            slope: product(&a, &value),
            bend: product(&a, &product(&a, &over_cell)),
            value,
            longest,
        }
    }

    /// `start` e^{Aτ} B over all of 0 <= τ <= L.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    fn range(&self, start: &IntervalMatrix) -> IntervalMatrix {
        let from_middle = Interval::centered(0.0, 0.5 * self.longest);
        let half_square = from_middle.sqr() * 0.5;
        product(start, &self.value)
            + product(start, &self.slope) * from_middle
            + product(start, &self.bend) * half_square
    }
}

/// The propagation on a grid of shorter steps where those given are long, and the number of steps
/// that one becomes.
fn refine(propagation: &Propagation) -> (Cow<'_, Propagation>, usize) {
    let system = propagation.system();
    let norm = norm_upper(&magnitude(&point(system.a()))) * propagation.grid().longest_step();
    let parts =
        ((norm / CELL_NORM).ceil().clamp(1.0, MOST_CELLS as f64) as usize).next_power_of_two();
    if parts > 1
        && let Ok(finer) = Propagation::new(system, &propagation.grid().refined(parts))
    {
        return (Cow::Owned(finer), parts);
    }
    (Cow::Borrowed(propagation), 1)
}

/// κ(t_k) = Σ_j |Γ(t_k - t_j) - Γ(t_k - t_{j+1})| on a grid that need not be uniform.
///
/// The sum telescopes wherever the entry of Γ is monotonic, so it is enough to visit the nodes t_k
/// - t_j around the sign changes of e^{Aτ} B.
///
/// # Guarantee
///
/// Outer enclosure, directed rounding. The lower end is the sum itself up to rounding (leaving out
/// a node can only lower it); the upper end is that of [`measurable_gains`].
pub(crate) fn sample_gains_on_any_grid(propagation: &Propagation) -> Vec<IntervalMatrix> {
    let cells = Cells::new(propagation);
    let (states, inputs) = cells.turning.shape();
    let times = propagation.grid().times();
    let lower = |at: usize| cells.variation_at_least(times, (at / inputs, at % inputs));
    let lower: Vec<Vec<f64>> = (0..states * inputs).into_par_iter().map(lower).collect();
    let gain = |(k, upper): (usize, IntervalMatrix)| {
        IntervalMatrix::from_fn(states, inputs, |i, j| {
            let highest = upper[(i, j)].hi();
            Interval::new(lower[i * inputs + j][k].clamp(0.0, highest), highest)
                .unwrap_or(Interval::ENTIRE)
        })
    };
    cells.gains().into_iter().enumerate().map(gain).collect()
}

/// Indices l, descending, of the nodes s = t_k - t_l to visit: both ends, and those within and next
/// to each turning cell.
fn nodes_around(times: &[f64], k: usize, turning: &[usize], cells: &[f64]) -> Vec<usize> {
    let mut nodes = BTreeSet::from([0, k]);
    for &cell in turning.iter().take_while(|&&cell| cells[cell] < times[k]) {
        let (from, to) = (times[k] - cells[cell + 1], times[k] - cells[cell]);
        let first = times.partition_point(|&t| t < from).saturating_sub(1);
        let last = times.partition_point(|&t| t <= to).min(k);
        nodes.extend(first..=last);
    }
    nodes.into_iter().rev().collect()
}

/// One entry of Γ at any time within the horizon.
struct IntegralEntry<'a> {
    cells: &'a Cells<'a>,
    entry: (usize, usize),
    /// e^{Aτ} B within the cells visited so far.
    polynomials: BTreeMap<usize, Polynomial>,
}

impl IntegralEntry<'_> {
    /// Γ(to - from), for samples from <= to.
    fn between(&mut self, from: f64, to: f64) -> Interval {
        let propagation = &self.cells.propagation;
        let times = propagation.grid().times();
        let s = Interval::point(to) - Interval::point(from);
        let base = times.partition_point(|&t| t <= s.lo()).saturating_sub(1);
        let integral = propagation.integral(base)[self.entry];
        let sigma = s - Interval::point(times[base]);
        if sigma == Interval::ZERO {
            return integral;
        }
        let (i, j) = self.entry;
        let series = || self.cells.series.entry(&propagation.exponential(base), i, j);
        integral + self.polynomials.entry(base).or_insert_with(series).integral(sigma)
    }
}
