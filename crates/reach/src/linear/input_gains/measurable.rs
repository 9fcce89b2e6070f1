//! The integral ∫ |e^{Aτ} B| dτ, entry by entry, which is the total variation of Γ.
//!
//! Where an entry of e^{Aτ} B keeps its sign, the integral of its absolute value is the absolute
//! value of its integral, in closed form. Where the sign may change, the cell is halved until the
//! pieces without a known sign are negligible.

use std::borrow::Cow;

use nalgebra::{DMatrix, DMatrixView};
use rayon::prelude::*;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::linear::column_sums::{ends, running_sum};
use crate::linear::input_gains::taylor_series::{NOISE, TaylorSeries, between};
use crate::linear::propagation::Propagation;
use crate::linear::sparsity::always_zero;
use crate::linear::step::step;
use crate::linear::system::LinearSystem;
use crate::sets::interval_matrix::{IntervalMatrix, magnitude, midpoint, point, product};
use crate::upward::{UNDERFLOW, norm_upward, relative_error, round_up_sum};

/// Bound of an integral over a piece, relative to the largest entry of the cell, below which the
/// piece is not halved.
const NEGLIGIBLE: f64 = 1e-13;

/// Largest norm of A h for one cell; beyond it the series would lose digits to cancellation, and
/// cells are shorter than the step h.
const CELL_NORM: f64 = 2.0;

/// Largest number of cells of one step.
const MOST_CELLS: usize = 256;

/// Size of the last term of an expansion, relative to the first, that is below every rounding.
const BELOW_ROUNDING: f64 = 1e-18;

/// Largest order of an expansion.
const MOST_ORDER: usize = 16;

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
    within: Expansion,
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
        let within = Expansion::new(system, longest);
        let series = TaylorSeries::new(system, longest);
        let turning = DMatrix::from_element(system.states(), system.inputs(), Vec::new());
        let mut cells = Self { parts, series, within, integrals: Vec::new(), turning, propagation };
        let count = cells.propagation.grid().len().saturating_sub(1);
        let products = || cells.within.products();
        let all = (0..count).into_par_iter();
        let (integrals, turns): (Vec<_>, Vec<_>) =
            all.map_init(products, |products, k| cells.cell(k, products)).unzip();
        cells.integrals = integrals;
        for (k, entries) in turns.into_iter().enumerate() {
            entries.into_iter().for_each(|entry| cells.turning[entry].push(k));
        }
        cells
    }

    /// Computes ∫ |e^{Aτ} B| over cell k, and the entries that may change sign in it.
    fn cell(&self, k: usize, products: &mut Products) -> (IntervalMatrix, Vec<(usize, usize)>) {
        let (mid, rad) = self.propagation.exponential_ball(k);
        self.within.multiply(mid, rad, products);
        let mut integral = self.propagation.increment(k);
        // Entries that keep their sign, and the others with bounds of their integral.
        let h = self.propagation.grid().interval(k);
        let (mut scale, mut unsure) = (0.0_f64, Vec::new());
        for (at, integral) in integral.as_mut_slice().iter_mut().enumerate() {
            let (range, point_width) = self.within.range(products, at);
            scale = scale.max(range.mag());
            *integral = integral.abs();
            if range.contains_zero() && range != Interval::ZERO {
                let outer = mul_up(range.mag(), h.hi());
                *integral = between(integral.lo().min(outer), outer);
                if range.mag() > NOISE * point_width {
                    unsure.push((at, outer));
                }
            }
        }
        // Halving decides where the sign may change and the bounds are not close enough.
        let (negligible, rows) = (NEGLIGIBLE * scale * h.hi(), integral.nrows());
        unsure.retain(|(_, outer)| *outer > negligible);
        if unsure.is_empty() {
            return (integral, Vec::new());
        }
        let (start, mut turns) = (self.propagation.exponential(k), Vec::new());
        for (i, j) in unsure.into_iter().map(|(at, _)| (at % rows, at / rows)) {
            let entry = self.series.entry(&start, i, j);
            if entry.may_turn(Interval::ZERO.hull(h), negligible) {
                turns.push((i, j));
            }
            integral[(i, j)] = entry.integral_of_absolute(Interval::ZERO, h, negligible);
        }
        (integral, turns)
    }

    /// Sums the cells up to each sample of the original grid.
    pub(super) fn gains(&self) -> Vec<IntervalMatrix> {
        let fine = running_sum(self.turning.shape(), self.propagation.grid().len(), |k| {
            ends(self.integrals[k].as_slice())
        });
        fine.into_iter().step_by(self.parts).collect()
    }
}

/// The expansion Σ A^k V (τ - L/2)^k / k! of e^{Aτ} B for 0 <= τ <= L about L/2.
///
/// V is e^{AL/2} B, and in the last term e^{Aτ} B over the whole cell. The last term is below the
/// rounding of the first: entries that decay while others do not keep a known sign until they are
/// rounding alone.
///
/// Products of interval matrices would take an interval product per term. Midpoints and radii take
/// two floating-point matrix products (Rump, Fast and parallel interval arithmetic, BIT 39, 1999).
struct Expansion {
    /// Midpoints of the terms A^k V (L/2)^k / k!, N x (order + 1) m.
    mid: DMatrix<f64>,
    /// For the first term, and for the sum of the others: their errors rad + (N + 1) u |mid|, above
    /// their magnitudes |mid| + rad, 2N x 2m.
    spread: DMatrix<f64>,
    /// Entries that are zero at every time, N x m.
    zero: DMatrix<bool>,
}

/// Scratch memory of the products for one cell.
struct Products {
    /// Products with the midpoints, N x (order + 1) m.
    mid: DMatrix<f64>,
    /// \[|midpoints|, radii\] of the exponential, N x 2N.
    sizes: DMatrix<f64>,
    /// Errors of the products: of the first term, and of the others in sum, N x 2m.
    error: DMatrix<f64>,
}

impl Expansion {
    fn new(system: &LinearSystem, longest: f64) -> Self {
        let (a, b) = (point(system.a()), point(system.b()));
        let (n, m) = b.shape();
        let value = product(&step(system, Interval::point(0.5 * longest)).phi, &b);
        let over_cell =
            product(&step(system, Interval::ZERO.hull(Interval::point(longest))).phi, &b);
        let terms = terms(&a, value, over_cell, Interval::point(longest) * 0.5);
        let mut mid = DMatrix::zeros(n, terms.len() * m);
        let mut spread = DMatrix::zeros(2 * n, 2 * m);
        for (part, term) in terms.iter().enumerate() {
            mid.columns_mut(part * m, m).copy_from(&midpoint(term));
            for (at, x) in (0..n * m).zip(term) {
                let (i, j) = (at % n, at / n + part.min(1) * m);
                let rounding = mul_up(relative_error(n), x.mid().abs());
                for (row, size) in [(i, add_up(rounding, x.rad())), (n + i, x.mag())] {
                    spread[(row, j)] = add_up(spread[(row, j)], size);
                }
            }
        }
        let zero = always_zero(system).columns(n, m).into_owned();
        Self { mid, spread, zero }
    }

    fn products(&self) -> Products {
        let (n, m) = self.zero.shape();
        Products {
            mid: DMatrix::zeros(n, self.mid.ncols()),
            sizes: DMatrix::zeros(n, 2 * n),
            error: DMatrix::zeros(n, 2 * m),
        }
    }

    /// Multiplies E, which is within `rad` of `mid` (N x N, column by column), by the terms.
    ///
    /// With the floating-point product Ẽ P̃ of the midpoints,
    /// |E P - Ẽ P̃| <= |Ẽ| (rad P + (N + 1) u |P̃|) + rad E (|P̃| + rad P).
    fn multiply(&self, mid: &[f64], rad: &[f64], products: &mut Products) {
        let n = self.zero.nrows();
        let (sizes, errors) = products.sizes.as_mut_slice().split_at_mut(n * n);
        sizes.iter_mut().zip(mid).for_each(|(size, x)| *size = x.abs());
        errors.copy_from_slice(rad);
        products.mid.gemm(1.0, &DMatrixView::from_slice(mid, n, n), &self.mid, 0.0);
        products.error.gemm(1.0, &products.sizes, &self.spread, 0.0);
    }

    /// Encloses entry `at`, column by column, of E e^{Aτ} B over all 0 <= τ <= L, and returns the
    /// width of its enclosure at one time.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    fn range(&self, products: &Products, at: usize) -> (Interval, f64) {
        let (entries, terms) = (self.zero.len(), 2 * self.zero.nrows());
        if self.zero.as_slice()[at] {
            return (Interval::ZERO, 0.0);
        }
        let part = |part: usize| products.mid.as_slice()[part * entries + at];
        let error = |part: usize| {
            round_up_sum(products.error.as_slice()[part * entries + at], terms) + UNDERFLOW
        };
        let parts = self.mid.ncols() / self.zero.ncols();
        let beyond = (1..parts).map(|k| part(k).abs()).sum::<f64>();
        let radius = round_up_sum(beyond + error(0) + error(1), parts + 1);
        (Interval::centred(part(0), radius), 2.0 * error(0))
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

/// Returns the terms A^k V `half`^k / k!, where V is `value`, and `over_cell` in the last one.
fn terms(
    a: &IntervalMatrix,
    value: IntervalMatrix,
    over_cell: IntervalMatrix,
    half: Interval,
) -> Vec<IntervalMatrix> {
    let largest = |of: &IntervalMatrix| of.iter().map(|x| x.mag()).fold(0.0, f64::max);
    let negligible = BELOW_ROUNDING * largest(&value);
    let (mut terms, mut last) = (vec![value], over_cell);
    for k in 1.. {
        let factor = half / Interval::point(k as f64);
        last = product(a, &last) * factor;
        if k == MOST_ORDER || largest(&last) <= negligible {
            terms.push(last);
            break;
        }
        terms.push(product(a, &terms[k - 1]) * factor);
    }
    terms
}
