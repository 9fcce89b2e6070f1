//! The gain of disturbances that are constant over each sampling step, on any grid.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;
use reachtube_scalar::Interval;

use crate::linear::input_gains::measurable::Cells;
use crate::linear::input_gains::taylor_series::TimePolynomial;
use crate::linear::propagation::Propagation;
use crate::sets::interval_matrix::IntervalMatrix;

/// Computes κ(t_k) = Σ_j |Γ(t_k - t_j) - Γ(t_k - t_{j+1})|, N x m, on a grid that need not be
/// uniform.
///
/// The sum telescopes wherever the entry of Γ is monotonic. Only the nodes t_k - t_j around the
/// sign changes of e^{Aτ} B are evaluated.
///
/// # Guarantee
///
/// Outer enclosure, directed rounding. The lower end is the sum itself up to rounding, since a
/// skipped node can only lower it. The upper end comes from
/// [`measurable_gains`](super::measurable::measurable_gains).
pub(crate) fn sample_gains_on_any_grid(propagation: &Propagation) -> Vec<IntervalMatrix> {
    let cells = Cells::new(propagation);
    let (states, inputs) = cells.turning.shape();
    let times = propagation.grid().times();
    let lower = |entry: usize| variation_at_least(&cells, times, (entry / inputs, entry % inputs));
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

/// Bounds Σ_j |Γ(t_k - t_j) - Γ(t_k - t_{j+1})| in entry (i, j) from below, for every sample k of a
/// grid with these `times`.
fn variation_at_least(cells: &Cells<'_>, times: &[f64], (i, j): (usize, usize)) -> Vec<f64> {
    let mut integral = IntegralEntry { cells, entry: (i, j), polynomials: BTreeMap::new() };
    let total = |k: usize| {
        let nodes =
            nodes_around(times, k, &cells.turning[(i, j)], cells.propagation.grid().times());
        let values: Vec<Interval> =
            nodes.iter().map(|&l| integral.between(times[l], times[k])).collect();
        values.windows(2).fold(Interval::ZERO, |sum, v| sum + (v[1] - v[0]).abs()).lo()
    };
    (0..times.len()).map(total).collect()
}

/// Returns the indices l, descending, of the nodes s = t_k - t_l to evaluate: both ends, and the
/// nodes in or next to each turning cell.
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
    /// Polynomials of e^{Aτ} B within the cells evaluated so far.
    polynomials: BTreeMap<usize, TimePolynomial>,
}

impl IntegralEntry<'_> {
    /// Encloses Γ(to - from), for samples from <= to.
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
