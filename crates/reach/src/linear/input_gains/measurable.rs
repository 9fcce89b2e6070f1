//! The integral ∫ |e^{Aτ} B| dτ, entry by entry, which is the total variation of Γ.
//!
//! Where an entry of e^{Aτ} B keeps its sign, the integral of its absolute value is the absolute
//! value of its integral, in closed form. Where the sign may change, the cell is halved until the
//! pieces without a known sign are negligible.

use std::borrow::Cow;

use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_scalar::Interval;

use crate::linear::column_sums::{ends, running_sum};
use crate::linear::input_gains::taylor_series::TaylorSeries;
use crate::linear::propagation::Propagation;
use crate::linear::step::step;
use crate::linear::system::LinearSystem;
use crate::sets::interval_matrix::{IntervalMatrix, magnitude, point, product};
use crate::upward::norm_upward;

/// Bound of an integral over a piece, relative to the largest entry of the cell, below which the
/// piece is not halved.
const NEGLIGIBLE: f64 = 1e-13;

/// Largest norm of A h for one cell; beyond it the series would lose digits to cancellation, and
/// cells are shorter than the step h.
const CELL_NORM: f64 = 2.0;

/// Largest number of cells of one step.
const MOST_CELLS: usize = 256;

/// Computes κ(t_k) = ∫₀^{t_k} |e^{Aτ} B| dτ, N x m, at every sample.
///
/// # Guarantee
///
/// Outer enclosure, directed rounding; the width is about 1e-12 of the value.
pub(crate) fn measurable_gains(propagation: &Propagation) -> Vec<IntervalMatrix> {
    Cells::new(propagation).gains()
}

/// The integral of |e^{Aτ} B| over each cell, a part of a step.
pub(super) struct Cells<'a> {
    /// The propagation at the ends of the cells: on the grid itself, or on a finer one where a step
    /// is long for the system.
    pub propagation: Cow<'a, Propagation>,
    /// Number of cells of one step of the grid.
    parts: usize,
    pub series: TaylorSeries,
    within: SecondOrder,
    /// ∫ |e^{Aτ} B| over each cell.
    integrals: Vec<IntervalMatrix>,
    /// Cells in which each entry may change sign, N x m.
    pub turning: DMatrix<Vec<usize>>,
}

impl<'a> Cells<'a> {
    pub(super) fn new(propagation: &'a Propagation) -> Self {
        let (propagation, parts) = refine(propagation);
        let system = propagation.system();
        let longest = propagation.grid().longest_step();
        let within = SecondOrder::new(system, longest);
        let series = TaylorSeries::new(system, longest);
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

    /// Computes ∫ |e^{Aτ} B| over cell k, and the entries that may change sign in it.
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

    /// Sums the cells up to each sample of the original grid.
    pub(super) fn gains(&self) -> Vec<IntervalMatrix> {
        let fine = running_sum(self.propagation.system(), self.propagation.grid().len(), |k| {
            ends(self.integrals[k].as_slice())
        });
        fine.into_iter().step_by(self.parts).collect()
    }
}

/// The expansion of e^{Aτ} B for 0 <= τ <= L to second order about L/2:
/// value + slope (τ - L/2) + curvature (τ - L/2)²/2.
struct SecondOrder {
    value: IntervalMatrix,
    slope: IntervalMatrix,
    curvature: IntervalMatrix,
    /// L in s.
    longest: f64,
}

impl SecondOrder {
    fn new(system: &LinearSystem, longest: f64) -> Self {
        let (a, b) = (point(system.a()), point(system.b()));
        let value = product(&step(system, Interval::point(0.5 * longest)).phi, &b);
        let over_cell =
            product(&step(system, Interval::ZERO.hull(Interval::point(longest))).phi, &b);
        Self {
            slope: product(&a, &value),
            curvature: product(&a, &product(&a, &over_cell)),
            value,
            longest,
        }
    }

    /// Encloses `start` e^{Aτ} B over all 0 <= τ <= L.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    fn range(&self, start: &IntervalMatrix) -> IntervalMatrix {
        let from_middle = Interval::centred(0.0, 0.5 * self.longest);
        let half_square = from_middle.sqr() * 0.5;
        product(start, &self.value)
            + product(start, &self.slope) * from_middle
            + product(start, &self.curvature) * half_square
    }
}

/// Returns the propagation on a grid whose steps are short enough for one cell, and the number of
/// its steps in one original step.
fn refine(propagation: &Propagation) -> (Cow<'_, Propagation>, usize) {
    let system = propagation.system();
    let norm = norm_upward(&magnitude(&point(system.a()))) * propagation.grid().longest_step();
    let parts =
        ((norm / CELL_NORM).ceil().clamp(1.0, MOST_CELLS as f64) as usize).next_power_of_two();
    if parts > 1
        && let Ok(finer) = Propagation::new(system, &propagation.grid().refined(parts))
    {
        return (Cow::Owned(finer), parts);
    }
    (Cow::Borrowed(propagation), 1)
}
