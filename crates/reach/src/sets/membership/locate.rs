use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use reachtube_scalar::Kernel;

use crate::sets::membership::blocks::{Blocks, Lanes, total, vectorised};
use crate::sets::membership::rows::GeneratorRows;

/// Steps with the matrix of all generators, which is factored once, before the steps of Newton's
/// method.
const SIMPLE_STEPS: usize = 8;

/// Steps for one point at most.
const STEPS: usize = 400;

/// Newton steps after which a residual that has not halved will not: the digits of Gᵀ y are used
/// up, as happens for points on the boundary.
const STALLED: usize = 20;

/// A direction separates when the point is further along it by this part.
const SEPARATED: f64 = 1e-12;

/// Part of all generators that is added to the generators with free factors, so that a Newton step
/// exists.
const RIDGE: f64 = 1e-9;

/// Accuracy of a growth factor.
const GROWTH: f64 = 0.05;

/// Halvings and doublings of a Newton step at most.
const LINE_STEPS: usize = 50;

/// Position of a point relative to a set.
#[derive(Debug, Clone, PartialEq)]
pub enum Place {
    /// In the set, or in the set grown by the tolerance; the workspace has the factors.
    Inside,
    /// Outside: lᵀ d > Σ_j |lᵀ g_j| in floating point, for this direction l.
    Outside {
        /// l, one entry for each state.
        direction: Vec<f64>,
        /// lᵀ d / Σ_j |lᵀ g_j|. The set would have to grow at least by this factor.
        ratio: f64,
    },
    /// No answer within a number of steps: the point is too close to the boundary to tell in
    /// floating point, or the generators do not span the states.
    Unknown,
}

/// A zonotope about 0, made ready to be asked for many points.
///
/// A point d lies in it where factors |α_j| <= 1 give d = Σ_j α_j g_j. Among all such factors the
/// ones of least norm are α_j = clip(g_jᵀ y) for some y, which maximises the concave function
///
/// ```text
/// dᵀ y - Σ_j H(g_jᵀ y),   H(z) = z²/2 for |z| <= 1, |z| - 1/2 beyond
/// ```
///
/// (the dual of the least squares problem with bounds). Its gradient is the residual d - G α, and
/// Newton's method finds y in a few steps. If there is no such y, the function grows without a
/// bound along a direction that separates d from the set.
#[derive(Debug, Clone)]
pub struct Membership {
    pub(super) blocks: Blocks,
    /// The number of generators.
    pub(super) count: usize,
    /// Powers of two by which the states were multiplied.
    pub(super) scale: Vec<f64>,
    /// For each scaled state, Σ_j |g_j|, the largest |g_j|, and what the generators may be wrong by
    /// in sum.
    pub(super) sums: Vec<f64>,
    pub(super) longest: Vec<f64>,
    pub(super) errors: Vec<f64>,
    /// G Gᵀ of the scaled states, and its factor.
    pub(super) gram: DMatrix<f64>,
    factor: Option<Cholesky<f64, Dyn>>,
}

/// Memory for [`Membership::locate`], and the factors that it found.
#[derive(Debug, Clone)]
pub struct MembershipWorkspace {
    /// y of the last point, in scaled states.
    y: Vec<f64>,
    /// z = Gᵀ y.
    along: Vec<Lanes>,
    /// Gᵀ p of a step p.
    change: Vec<Lanes>,
    pub(super) factors: Vec<Lanes>,
    pub(super) product: Vec<Lanes>,
    hessian: Vec<Lanes>,
    residual: DVector<f64>,
    point: Vec<f64>,
}

impl Membership {
    /// Prepares a zonotope.
    #[must_use]
    pub fn new(rows: &GeneratorRows) -> Self {
        let dimension = rows.dimension();
        let of_rows = |of: fn(&[f64]) -> f64| (0..dimension).map(move |i| of(rows.row(i)));
        let sums: Vec<f64> = of_rows(|row| row.iter().map(|x| x.abs()).sum()).collect();
        let longest = of_rows(|row| row.iter().fold(0.0, |max, x| max.max(x.abs())));
        // Scale: bring each state to the order of 1.
        let power = |sum: &f64| if *sum > 0.0 { (-sum.log2().round()).exp2() } else { 1.0 };
        let scale: Vec<f64> = sums.iter().map(power).collect();
        let blocks = Blocks::new(rows, &scale);
        let along = vec![[0.0; 8]; blocks.len()];
        let gram = gram_of_free(&blocks, &along, dimension, &mut Vec::new());
        Self {
            count: rows.count(),
            sums: sums.iter().zip(&scale).map(|(sum, scale)| sum * scale).collect(),
            longest: longest.zip(&scale).map(|(x, scale)| x * scale).collect(),
            errors: (0..dimension).map(|i| rows.error(i) * scale[i]).collect(),
            factor: Cholesky::new(gram.clone()),
            blocks,
            scale,
            gram,
        }
    }

    /// Returns memory for [`locate`](Self::locate).
    #[must_use]
    pub fn workspace(&self) -> MembershipWorkspace {
        let (dimension, none) = (self.scale.len(), [0.0; 8]);
        let lanes = || vec![none; self.blocks.len()];
        MembershipWorkspace {
            y: vec![0.0; dimension],
            along: lanes(),
            change: lanes(),
            factors: lanes(),
            product: vec![none; dimension],
            hessian: Vec::new(),
            residual: DVector::zeros(dimension),
            point: vec![0.0; dimension],
        }
    }

    /// Returns whether `point`, one entry for each state, lies in the set grown by the factor 1 +
    /// `tolerance`, or outside the set.
    ///
    /// # Guarantee
    ///
    /// None: floating point. [`MembershipProof`](crate::MembershipProof) proves factors.
    pub fn locate(&self, point: &[f64], tolerance: f64, work: &mut MembershipWorkspace) -> Place {
        self.take_point(point, 1.0, work);
        let Some(factor) = &self.factor else { return Place::Unknown };
        let start = factor.solve(&DVector::from_column_slice(&work.point));
        work.y.copy_from_slice(start.as_slice());
        self.search(factor, tolerance, SIMPLE_STEPS, work)
    }

    /// Returns the factor by which the set would have to grow to contain a `point` outside, from
    /// below and to `tolerance` or 5 % of the growth, with the direction that shows it; `None` for
    /// a point inside.
    pub fn gauge(
        &self,
        point: &[f64],
        tolerance: f64,
        work: &mut MembershipWorkspace,
    ) -> Option<(f64, Vec<f64>)> {
        let Place::Outside { direction, ratio } = self.locate(point, tolerance, work) else {
            return None;
        };
        let mut best = (ratio, direction);
        for _ in 0..STEPS {
            let grown = best.0 + tolerance.max(GROWTH * (best.0 - 1.0));
            self.take_point(point, 1.0 / grown, work);
            let Some(factor) = &self.factor else { break };
            match self.search(factor, tolerance, 0, work) {
                Place::Outside { direction, ratio } => best = (grown * ratio, direction),
                Place::Inside | Place::Unknown => break,
            }
        }
        Some(best)
    }

    fn take_point(&self, point: &[f64], factor: f64, work: &mut MembershipWorkspace) {
        let scaled = point.iter().zip(&self.scale).map(|(x, scale)| factor * x * scale);
        work.point.iter_mut().zip(scaled).for_each(|(place, x)| *place = x);
    }

    /// Maximises from the y of the workspace on: some steps with the matrix of all generators,
    /// which lies above the Hessian, so that each step goes uphill; then Newton steps.
    fn search(
        &self,
        factor: &Cholesky<f64, Dyn>,
        tolerance: f64,
        simple_steps: usize,
        work: &mut MembershipWorkspace,
    ) -> Place {
        let (mut least, mut least_at) = (f64::INFINITY, simple_steps);
        for at in 0..STEPS {
            let MembershipWorkspace { y, along, factors, product, point, .. } = work;
            let reach = self.blocks.pass(y, along, factors, product);
            let at_point: f64 = point.iter().zip(&*y).map(|(d, y)| d * y).sum();
            if at_point > reach * (1.0 + SEPARATED) && reach > 0.0 {
                let ratio = at_point / reach;
                return Place::Outside { direction: self.unscaled(y), ratio };
            }
            let step = work.towards_point(factor);
            if work.is_within(&step, tolerance) {
                return Place::Inside;
            }
            let residual = work.residual.dot(&step);
            if residual <= 0.5 * least {
                (least, least_at) = (residual, at.max(simple_steps));
            } else if at >= least_at + STALLED {
                return Place::Unknown;
            }
            if at < simple_steps {
                work.y.iter_mut().zip(step.iter()).for_each(|(y, p)| *y += p);
                continue;
            }
            let Some(step) = self.newton_step(work) else { return Place::Unknown };
            self.blocks.along(step.as_slice(), &mut work.change);
            let at_step = work.point.iter().zip(step.iter()).map(|(d, p)| d * p).sum();
            let length = line_search(at_step, &work.along, &work.change);
            if length == 1.0 && self.corrects(factor, tolerance, work) {
                return Place::Inside;
            }
            work.y.iter_mut().zip(step.iter()).for_each(|(y, p)| *y += length * p);
        }
        Place::Unknown
    }

    /// A direction of scaled states in the states themselves, its largest entry 1.
    fn unscaled(&self, y: &[f64]) -> Vec<f64> {
        let direction = || y.iter().zip(&self.scale).map(|(y, scale)| y * scale);
        let largest = direction().fold(0.0f64, |max, l| max.max(l.abs()));
        direction().map(|l| l / largest).collect()
    }

    /// The step H⁻¹ (d - G α), with H = Σ g gᵀ over the generators whose factors are free.
    fn newton_step(&self, work: &mut MembershipWorkspace) -> Option<DVector<f64>> {
        let dimension = self.scale.len();
        let free = gram_of_free(&self.blocks, &work.along, dimension, &mut work.hessian);
        Some(Cholesky::new(free + &self.gram * RIDGE)?.solve(&work.residual))
    }

    /// Near the boundary y is large and Gᵀ y loses digits. Changes the free factors by the Newton
    /// step itself, and returns whether they then reach the point.
    fn corrects(
        &self,
        factor: &Cholesky<f64, Dyn>,
        tolerance: f64,
        work: &mut MembershipWorkspace,
    ) -> bool {
        let MembershipWorkspace { along, change, factors, product, .. } = work;
        for ((factors, change), along) in factors.iter_mut().zip(&*change).zip(&*along) {
            for lane in 0..factors.len() {
                let step = if along[lane].abs() < 1.0 { change[lane] } else { 0.0 };
                factors[lane] = (factors[lane] + step).clamp(-1.0, 1.0);
            }
        }
        self.blocks.product(factors, product);
        let step = work.towards_point(factor);
        work.is_within(&step, tolerance)
    }
}

impl MembershipWorkspace {
    /// Returns the number y_i for each state of `set` for which the factors of the last point are
    /// clip(gᵀ y), up to a last correction.
    #[must_use]
    pub fn multipliers(&self, set: &Membership) -> Vec<f64> {
        self.y.iter().zip(&set.scale).map(|(y, scale)| y * scale).collect()
    }

    /// Sets the residual e = d - G α and returns (G Gᵀ)⁻¹ e.
    fn towards_point(&mut self, factor: &Cholesky<f64, Dyn>) -> DVector<f64> {
        for (residual, (point, product)) in
            self.residual.iter_mut().zip(self.point.iter().zip(&self.product))
        {
            *residual = point - total(product);
        }
        factor.solve(&self.residual)
    }

    /// Whether the residual can be absorbed by factors of at most `tolerance`: the factors of least
    /// norm have the norm √(eᵀ (G Gᵀ)⁻¹ e).
    fn is_within(&self, step: &DVector<f64>, tolerance: f64) -> bool {
        self.residual.dot(step) <= tolerance * tolerance
    }
}

/// Σ g gᵀ over the generators with |z| < 1.
fn gram_of_free(
    blocks: &Blocks,
    along: &[Lanes],
    dimension: usize,
    sums: &mut Vec<Lanes>,
) -> DMatrix<f64> {
    sums.clear();
    sums.resize(dimension * (dimension + 1) / 2, [0.0; 8]);
    blocks.add_gram_of_free(along, sums);
    DMatrix::from_fn(dimension, dimension, |i, l| {
        let (i, l) = (i.max(l), i.min(l));
        total(&sums[i * (i + 1) / 2 + l])
    })
}

/// The length t of a step for which the derivative along it, pᵀ d - Σ clip(z + t w) w, is small: 1
/// if it is there, less where the derivative changed its sign, and more where it did not. The
/// function itself never falls: its derivative does, so that a derivative above 0 shows a rise.
fn line_search(at_step: f64, along: &[Lanes], change: &[Lanes]) -> f64 {
    let slope = |t: f64| at_step - vectorised(AlongStep { t, along, change });
    let (mut low, mut high) = (0.0, 1.0);
    let (start, at_one) = (slope(0.0).abs(), slope(1.0));
    // The derivative falls. Where it is below 0 at the end, it is no lower in the second half, and
    // in the first half no lower than at 1/2.
    if at_one.abs() <= 0.5 * start && (at_one >= 0.0 || slope(0.5) + at_one >= 0.0) {
        return 1.0;
    }
    let mut at_high = at_one;
    while at_high > 0.0 {
        (low, high) = (high, 4.0 * high);
        if high > 1e12 {
            return low;
        }
        at_high = slope(high);
    }
    for _ in 0..LINE_STEPS {
        let middle = 0.5 * (low + high);
        let at = slope(middle);
        if at > 0.0 {
            low = middle
        } else {
            high = middle
        }
        if (0.0..=0.1 * start).contains(&at) || high - low <= 1e-3 * high {
            return low;
        }
    }
    low
}

/// pᵀ G clip(z + t w), with w = Gᵀ p.
struct AlongStep<'a> {
    t: f64,
    along: &'a [Lanes],
    change: &'a [Lanes],
}

impl Kernel for AlongStep<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let mut sums = [0.0; 8];
        for (z, w) in self.along.iter().zip(self.change) {
            for lane in 0..sums.len() {
                sums[lane] += (z[lane] + self.t * w[lane]).clamp(-1.0, 1.0) * w[lane];
            }
        }
        total(&sums)
    }
}
