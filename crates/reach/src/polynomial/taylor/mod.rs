//! Taylor models: the state as a polynomial in where it started, and a small rest.

mod offset;
mod series;

use std::sync::Arc;

use reachtube_scalar::{
    Interval, MapWorkspace, PolynomialMap, TaylorBox, TaylorModel, TaylorPolynomial, TaylorSpace,
};

use self::offset::Offset;
use self::series::{Monomials, TimeSeries};
use super::PolynomialSystem;
use super::step::Exhausted;
use crate::Zonotope;
use crate::exponential::norm_upper;
use crate::matrix::{IntervalMatrix, add_product, magnitude, product};

/// Guesses of the offset's tube before a step counts as failed.
const TRIES: usize = 25;

/// What a guess is enlarged by: relative to its width, and in any case.
const ENLARGED: f64 = 0.1;
const LEAST: f64 = 1e-290;

/// The set {p(s) + e : s in [-1, 1]^N, e in E}: polynomials in the coordinates of the initial box,
/// and offsets.
#[derive(Debug, Clone)]
pub(super) struct TaylorSet {
    /// Without remainders.
    polynomials: Vec<TaylorModel>,
    /// Their ranges.
    ranges: Vec<Interval>,
    offset: Offset,
}

impl TaylorSet {
    /// A box, with polynomials to the order of the space to come; beyond that many generators of
    /// offsets, the oldest become a box.
    pub fn new(space: &Arc<TaylorSpace>, sides: &[Interval], most_generators: usize) -> Self {
        let polynomials = TaylorBox::new(space, sides).variables();
        let ranges = polynomials.iter().map(TaylorModel::range).collect();
        Self { polynomials, ranges, offset: Offset::zero(sides.len(), most_generators) }
    }

    /// Its hull, N intervals.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn hull(&self) -> impl Iterator<Item = Interval> {
        self.ranges.iter().zip(self.offset.hull()).map(|(p, e)| *p + e)
    }

    /// A zonotope around it: the linear terms, the offsets, and a box for the rest of the
    /// polynomials.
    pub fn zonotope(&self) -> Zonotope {
        let n = self.ranges.len();
        let (mut center, mut columns) = (vec![0.0; n], vec![0.0; 2 * n * n]);
        for (i, model) in self.polynomials.iter().enumerate() {
            let mut rest = model.clone();
            for term in model.polynomial().truncated(1).terms() {
                let Some(z) = term.exponents.iter().position(|e| *e == 1) else { continue };
                columns[z * n + i] = term.coefficient;
                let space = model.polynomial().space().expect("a variable occurs");
                rest -= TaylorModel::from(TaylorPolynomial::from_terms(space, [term]));
            }
            let rest = rest.tight_range() + Interval::centered(0.0, self.offset.along_axis(i));
            center[i] = rest.mid();
            columns[n * n + i * n + i] = rest.rad();
        }
        columns.extend(self.offset.generators());
        Zonotope::new(center, columns)
    }

    /// Generators of the offsets.
    pub fn generators(&self) -> usize {
        self.offset.count()
    }
}

/// Steps of a system, one after another.
#[derive(Debug)]
pub(super) struct TaylorStepper {
    monomials: Monomials,
    /// ∂f/∂x and then ∂f/∂u, column by column.
    derivatives: PolynomialMap<Interval>,
    workspace: MapWorkspace<Interval>,
    order: usize,
    tube: Vec<Interval>,
}

/// Bounds over the tube of a step of length h: h ∂f/∂x, and what the offset is driven by, the
/// defect and the uncertain input.
struct Bounds {
    a: IntervalMatrix,
    input: Vec<Interval>,
}

impl TaylorStepper {
    pub fn new(system: &PolynomialSystem, order: u32) -> Self {
        let variables = system.states() + system.inputs();
        let components = &system.components;
        let derivatives: Vec<_> =
            (0..variables).flat_map(|z| components.iter().map(move |f| f.derivative(z))).collect();
        let derivatives = PolynomialMap::new(variables, &derivatives);
        let workspace = derivatives.workspace();
        let monomials = Monomials::new(variables, components);
        Self { monomials, derivatives, workspace, order: order as usize, tube: Vec::new() }
    }

    /// All states over the step just made, N intervals.
    pub fn tube(&self) -> &[Interval] {
        &self.tube
    }

    /// The set after a step of length h under the input u, which may change within it.
    ///
    /// With P the series in time and e = x - P, ė = A e + B (u - u*) + d for some A and B among the
    /// derivatives of f between P and x and the defect d: a linear system, of which the tube of e
    /// is found by containment.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn advance(
        &mut self,
        set: &mut TaylorSet,
        h: Interval,
        u: &[Interval],
    ) -> Result<(), Exhausted> {
        let middle: Vec<f64> = u.iter().map(|u| u.mid()).collect();
        let series = TimeSeries::new(&self.monomials, set, &middle, h, self.order);
        let n = set.polynomials.len();
        let defect: Vec<_> = (0..n).map(|i| series.defect(i)).collect();
        let bounds =
            self.contain(&series, &set.offset.hull().collect::<Vec<_>>(), &defect, h, u)?;
        let (flow, change) = flow(&bounds.a);
        let driven: Vec<_> = defect.iter().zip(&bounds.input).map(|(d, b)| *d + *b).collect();
        let later = applied(&change, &driven);
        let mut more = Vec::with_capacity(n);
        for (i, polynomial) in set.polynomials.iter_mut().enumerate() {
            let end = series.end(i);
            let rest = end.remainder() + series.defect_integral(i) + bounds.input[i] + later[i];
            let moved = TaylorModel::from(end.polynomial().clone()) + TaylorModel::from(rest.mid());
            more.push((moved.remainder() + (rest - rest.mid())).mag());
            *polynomial = TaylorModel::from(moved.polynomial().clone());
        }
        set.ranges = set.polynomials.iter().map(TaylorModel::tight_range).collect();
        set.offset.map(&flow, &more);
        Ok(())
    }

    /// The bounds over a tube of offsets that contains itself.
    fn contain(
        &mut self,
        series: &TimeSeries,
        start: &[Interval],
        defect: &[Interval],
        h: Interval,
        u: &[Interval],
    ) -> Result<Bounds, Exhausted> {
        let range: Vec<_> = (0..start.len()).map(|i| series.range(i)).collect();
        let mut guess: Vec<Interval> =
            start.iter().zip(defect).map(|(e, d)| enlarged(*e + d.hull(Interval::ZERO))).collect();
        for _ in 0..TRIES {
            let bounds = self.bounds(&range, &guess, h, u);
            let found = driven(&bounds, start, defect, &guess);
            if found.iter().any(|e| !e.width().is_finite()) {
                break;
            }
            if guess.iter().zip(&found).all(|(guess, found)| guess.encloses(found)) {
                let bounds = self.bounds(&range, &found, h, u);
                self.tube = range
                    .iter()
                    .zip(driven(&bounds, start, defect, &found))
                    .map(|(x, e)| *x + e)
                    .collect();
                return Ok(bounds);
            }
            guess =
                guess.iter().zip(found).map(|(guess, found)| enlarged(guess.hull(found))).collect();
        }
        let widths: Vec<f64> = range.iter().zip(&guess).map(|(x, e)| (*x + *e).width()).collect();
        let grown = |i: usize| guess[i].width() / (start[i].width() + LEAST);
        let state = (0..widths.len()).max_by(|i, j| grown(*i).total_cmp(&grown(*j))).unwrap_or(0);
        Err(Exhausted { state, widths })
    }

    /// Over the offsets `e` from the `range` of P, and the input u.
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
        let off: Vec<_> = u.iter().map(|u| *u - u.mid()).collect();
        Bounds {
            input: applied(&slopes.columns(n, u.len()).into_owned(), &off),
            a: slopes.columns(0, n).into_owned(),
        }
    }
}

/// All offsets over the step, from `start`, where they do not leave `tube`.
fn driven(
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

/// `matrix` times `vector`.
fn applied(matrix: &IntervalMatrix, vector: &[Interval]) -> Vec<Interval> {
    let mut out = vec![Interval::ZERO; matrix.nrows()];
    add_product(&mut out, matrix, vector);
    out
}

fn enlarged(x: Interval) -> Interval {
    x + Interval::centered(0.0, x.width() * ENLARGED + LEAST)
}

/// Terms of the series of [`flow`] before its remainder.
const TERMS: usize = 4;

/// Ψ(1, 0) of Ψ̇ = A(τ) Ψ for any A(τ) in `a` at each time, 0 <= τ <= 1; and Ψ(1, τ) - I for every
/// τ.
///
/// # Guarantee
///
/// Outer, directed rounding: each product of A at different times lies in that of the interval
/// matrices, and so do means of them. What is left out is at most |A|^p / p! / (1 - |A| / (p + 1))
/// in the norm.
fn flow(a: &IntervalMatrix) -> (IntervalMatrix, IntervalMatrix) {
    let n = a.nrows();
    let identity = IntervalMatrix::identity(n, n);
    let (mut power, mut sum, mut change) =
        (identity.clone(), identity, IntervalMatrix::from_element(n, n, Interval::ZERO));
    for i in 1..TERMS {
        power = product(&power, a).map(|x| x / Interval::point(i as f64));
        sum += &power;
        change += power.map(|x| x.hull(Interval::ZERO));
    }
    let norm = Interval::point(norm_upper(&magnitude(a)));
    let left_out =
        (1..=TERMS).fold(Interval::ONE, |term, i| term * norm / Interval::point(i as f64));
    let tail = left_out / (Interval::ONE - norm / Interval::point(TERMS as f64 + 1.0));
    let tail = if tail.lo() >= 0.0 { Interval::centered(0.0, tail.hi()) } else { Interval::ENTIRE };
    (sum.map(|x| x + tail), change.map(|x| x + tail))
}
