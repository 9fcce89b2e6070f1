//! ∫ |e^{Aτ} B| dτ, entry by entry: the total variation of Γ. Where an entry of e^{Aτ} B keeps its sign, the integral of its absolute value is the
//! absolute value of its integral, in closed form; where it may change sign, the cell is halved until the rest does not matter.

use std::collections::BTreeSet;

use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::mul_up;

use crate::Propagation;
use crate::disturbance::running_sum;
use crate::matrix::IntervalMatrix;
use crate::series::{Polynomial, Series};

/// A piece of the integral is left as an interval once its outer bound is below this part of the largest entry of its cell.
const NEGLIGIBLE: f64 = 1e-13;

/// κ(t_k) = ∫₀^{t_k} |e^{Aτ} B| dτ at every sample.
///
/// # Guarantee
///
/// Outer enclosure, directed rounding; the width is about 1e-12 of the value.
pub(crate) fn measurable_gains(propagation: &Propagation) -> Vec<IntervalMatrix> {
    Cells::new(propagation).gains
}

/// The gains, and for each entry the cells in which it may change sign.
struct Cells {
    gains: Vec<IntervalMatrix>,
    turning: DMatrix<Vec<usize>>,
}

impl Cells {
    fn new(propagation: &Propagation) -> Self {
        let system = propagation.system();
        let mut turning = DMatrix::from_element(system.states(), system.inputs(), Vec::new());
        let series = Series::new(system, propagation.grid().longest_step());
        let gains = running_sum(propagation, |k| {
            let h = propagation.grid().interval(k);
            cell(propagation.exponential(k), &series, h, |i, j| turning[(i, j)].push(k))
        });
        Self { gains, turning }
    }
}

/// ∫ |e^{Aτ} B| over one cell of length `h` that starts at e^{A t_k} = `start`.
fn cell(
    start: &IntervalMatrix,
    series: &Series,
    h: Interval,
    mut turns: impl FnMut(usize, usize),
) -> IntervalMatrix {
    let (rows, columns) = (start.nrows(), series.terms[0].ncols());
    let entry = |at: usize| series.entry(start, at / columns, at % columns);
    let integrands: Vec<Polynomial> = (0..rows * columns).map(entry).collect();
    let cell = Interval::ZERO.hull(h);
    let scale = integrands.iter().map(|f| f.range(cell).mag()).fold(0.0, f64::max);
    let negligible = NEGLIGIBLE * scale * h.hi();
    IntervalMatrix::from_fn(rows, columns, |i, j| {
        let f = &integrands[i * columns + j];
        let range = f.range(cell);
        if range.contains_zero() && mul_up(range.mag(), h.hi()) > negligible {
            turns(i, j);
        }
        f.integral_of_absolute(Interval::ZERO, h, negligible, 0)
    })
}

/// κ(t_k) = Σ_j |Γ(t_k - t_j) - Γ(t_k - t_{j+1})| on a grid that need not be uniform.
///
/// The sum telescopes wherever the entry of Γ is monotonic, so it is enough to visit the nodes t_k - t_j around the sign changes of e^{Aτ} B.
///
/// # Guarantee
///
/// Outer enclosure, directed rounding. The lower end is the sum itself up to rounding (leaving out a node can only lower it); the upper end is that of
/// [`measurable_gains`].
pub(crate) fn sample_gains_on_any_grid(propagation: &Propagation) -> Vec<IntervalMatrix> {
    let cells = Cells::new(propagation);
    let series = Series::new(propagation.system(), propagation.grid().longest_step());
    let gain = |(k, upper): (usize, &IntervalMatrix)| {
        IntervalMatrix::from_fn(upper.nrows(), upper.ncols(), |i, j| {
            let nodes = nodes_around(propagation.grid().times(), k, &cells.turning[(i, j)]);
            let values: Vec<Interval> = nodes.iter().map(|&l| gamma_between(propagation, &series, (k, l), (i, j))).collect();
            let sum = values.windows(2).fold(Interval::ZERO, |sum, v| sum + (v[1] - v[0]).abs());
            let highest = upper[(i, j)].hi();
            Interval::new(sum.lo().min(highest), highest).unwrap_or(Interval::ENTIRE)
        })
    };
    cells.gains.par_iter().enumerate().map(gain).collect()
}

/// Indices l, descending, of the nodes s = t_k - t_l to visit: both ends, and those within and next to each turning cell.
fn nodes_around(times: &[f64], k: usize, turning: &[usize]) -> Vec<usize> {
    let mut nodes = BTreeSet::from([0, k]);
    for &cell in turning.iter().take_while(|&&cell| cell < k) {
        let (from, to) = (times[k] - times[cell + 1], times[k] - times[cell]);
        let first = times.partition_point(|&t| t < from).saturating_sub(1);
        let last = times.partition_point(|&t| t <= to).min(k);
        nodes.extend(first..=last);
    }
    nodes.into_iter().rev().collect()
}

/// Γ_ij(t_k - t_l), from the sample before it.
fn gamma_between(propagation: &Propagation, series: &Series, (k, l): (usize, usize), (i, j): (usize, usize)) -> Interval {
    let times = propagation.grid().times();
    if l == 0 || l == k {
        return propagation.integral(k - l)[(i, j)];
    }
    let s = Interval::point(times[k]) - Interval::point(times[l]);
    let base = times.partition_point(|&t| t <= s.lo()) - 1;
    let sigma = s - Interval::point(times[base]);
    propagation.integral(base)[(i, j)] + series.entry(propagation.exponential(base), i, j).integral(sigma)
}
