//! One step of Taylor models.

use reachtube_scalar::{Interval, MapWorkspace, PolynomialMap, TaylorModel};

use crate::polynomial::propagator::StepFailure;
use crate::polynomial::system::PolynomialSystem;
use crate::polynomial::taylor::monomials::Monomials;
use crate::polynomial::taylor::set::TaylorSet;
use crate::polynomial::taylor::time_series::TimeSeries;
use crate::polynomial::taylor::transition::transition;
use crate::sets::interval_matrix::{IntervalMatrix, add_product};

/// Largest number of guesses of the tube of the offset before a step counts as failed.
const TRIES: usize = 25;

/// Enlargement of a guess, relative to its width.
const ENLARGEMENT: f64 = 0.1;

/// Smallest enlargement of a guess.
const LEAST_ENLARGEMENT: f64 = 1e-290;

/// The steps of Taylor models, with reused memory.
#[derive(Debug)]
pub(crate) struct TaylorStep {
    monomials: Monomials,
    /// ∂f/∂x and then ∂f/∂u, column by column.
    derivatives: PolynomialMap<Interval>,
    workspace: MapWorkspace<Interval>,
    order: usize,
    tube: Vec<Interval>,
}

/// Bounds over the tube of a step of length h.
struct Bounds {
    /// h ∂f/∂x, N x N.
    a: IntervalMatrix,
    /// h ∂f/∂u times the uncertain input, N.
    input: Vec<Interval>,
}

impl TaylorStep {
    pub(crate) fn new(system: &PolynomialSystem, order: u32) -> Self {
        let variables = system.states() + system.inputs();
        let components = &system.components;
        let derivatives: Vec<_> =
            (0..variables).flat_map(|z| components.iter().map(move |f| f.derivative(z))).collect();
        let derivatives = PolynomialMap::new(variables, &derivatives);
        let workspace = derivatives.workspace();
        let monomials = Monomials::new(variables, components);
        Self { monomials, derivatives, workspace, order: order as usize, tube: Vec::new() }
    }

    /// Returns the ranges of the states over the last step, N intervals.
    pub(crate) fn tube(&self) -> &[Interval] {
        &self.tube
    }

    /// Advances the set over a step of length h under the input u, which may change within it.
    ///
    /// With the power series P in time and e = x - P, ė = A e + B (u - u*) + d. Here d is the
    /// defect of P, and A and B are among the derivatives of f between P and x. Containment proves
    /// the tube of e of this linear system.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn advance(
        &mut self,
        set: &mut TaylorSet,
        h: Interval,
        u: &[Interval],
    ) -> Result<(), StepFailure> {
        // Power series in time under the middle of the input, and its defect.
        let middle: Vec<f64> = u.iter().map(|u| u.mid()).collect();
        let series = TimeSeries::new(&self.monomials, set, &middle, h, self.order);
        let n = set.polynomials.len();
        let defect: Vec<_> = (0..n).map(|i| series.defect(i)).collect();
        // Bounds over a verified tube of the offset.
        let bounds =
            self.verified_bounds(&series, &set.offset.hull().collect::<Vec<_>>(), &defect, h, u)?;
        // State transition of the offset, and the effect of its drive over the step.
        let (flow, change) = transition(&bounds.a);
        let drive: Vec<_> = defect.iter().zip(&bounds.input).map(|(d, b)| *d + *b).collect();
        let later = applied(&change, &drive);
        // Polynomials at the end of the step; their errors become offsets.
        let mut errors = Vec::with_capacity(n);
        for (i, polynomial) in set.polynomials.iter_mut().enumerate() {
            let end = series.end(i);
            let moved = end.remainder() + series.defect_integral(i) + bounds.input[i] + later[i];
            let next = TaylorModel::from(end.polynomial().clone()) + TaylorModel::from(moved.mid());
            errors.push((next.remainder() + (moved - moved.mid())).mag());
            *polynomial = TaylorModel::from(next.polynomial().clone());
        }
        set.ranges = set.polynomials.iter().map(TaylorModel::tight_range).collect();
        set.offset.map(&flow, &errors);
        Ok(())
    }

    /// Computes the bounds over a tube of offsets that contains itself.
    fn verified_bounds(
        &mut self,
        series: &TimeSeries,
        start: &[Interval],
        defect: &[Interval],
        h: Interval,
        u: &[Interval],
    ) -> Result<Bounds, StepFailure> {
        let range: Vec<_> = (0..start.len()).map(|i| series.range(i)).collect();
        let mut guess: Vec<Interval> =
            start.iter().zip(defect).map(|(e, d)| enlarged(*e + d.hull(Interval::ZERO))).collect();
        for _ in 0..TRIES {
            let bounds = self.bounds(&range, &guess, h, u);
            let found = offsets_over_step(&bounds, start, defect, &guess);
            if found.iter().any(|e| !e.width().is_finite()) {
                break;
            }
            if guess.iter().zip(&found).all(|(guess, found)| guess.encloses(found)) {
                // Tighten the bounds once with the tube found.
                let bounds = self.bounds(&range, &found, h, u);
                let offsets = offsets_over_step(&bounds, start, defect, &found);
                self.tube = range.iter().zip(offsets).map(|(x, e)| *x + e).collect();
                return Ok(bounds);
            }
            guess =
                guess.iter().zip(found).map(|(guess, found)| enlarged(guess.hull(found))).collect();
        }
        let widths: Vec<f64> = range.iter().zip(&guess).map(|(x, e)| (*x + *e).width()).collect();
        let growth = |i: usize| guess[i].width() / (start[i].width() + LEAST_ENLARGEMENT);
        let state = (0..widths.len()).max_by(|i, j| growth(*i).total_cmp(&growth(*j))).unwrap_or(0);
        Err(StepFailure { state, widths })
    }

    /// Computes the bounds over the offsets `e` from the `range` of P, and the input u.
    fn bounds(
        &mut self,
        range: &[Interval],
        e: &[Interval],
        h: Interval,
        u: &[Interval],
    ) -> Bounds {
        let n = range.len();
        let at: Vec<_> =
            range.iter().zip(e).map(|(x, e)| *x + *e).chain(u.iter().copied()).collect();
        let mut values = vec![Interval::ZERO; self.derivatives.components()];
        self.derivatives.evaluate_into(&at, &mut self.workspace, &mut values);
        values.iter_mut().for_each(|value| *value *= h);
        let slopes = IntervalMatrix::from_vec(n, at.len(), values);
        let deviation: Vec<_> = u.iter().map(|u| *u - u.mid()).collect();
        Bounds {
            input: applied(&slopes.columns(n, u.len()).into_owned(), &deviation),
            a: slopes.columns(0, n).into_owned(),
        }
    }
}

/// Encloses all offsets over the step from `start`, provided that they stay in `tube`.
fn offsets_over_step(
    bounds: &Bounds,
    start: &[Interval],
    defect: &[Interval],
    tube: &[Interval],
) -> Vec<Interval> {
    let rate = applied(&bounds.a, tube);
    let rates = rate.iter().zip(&bounds.input).zip(defect);
    start
        .iter()
        .zip(rates)
        .map(|(e, ((a, b), d))| *e + (*a + *b + *d).hull(Interval::ZERO))
        .collect()
}

/// Computes `matrix` times `vector`.
fn applied(matrix: &IntervalMatrix, vector: &[Interval]) -> Vec<Interval> {
    let mut out = vec![Interval::ZERO; matrix.nrows()];
    add_product(&mut out, matrix, vector);
    out
}

fn enlarged(x: Interval) -> Interval {
    x + Interval::centred(0.0, x.width() * ENLARGEMENT + LEAST_ENLARGEMENT)
}
