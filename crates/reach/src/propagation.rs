use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::exponential::{Step, norm_upper, step};
use crate::matrix::{
    IntervalMatrix, IntervalVector, accumulate_upward, ball, dot_upward, magnitude, midpoint, mul_upward,
    point, product, radius,
};
use crate::{LinearSystem, ReachError, TimeGrid, Trajectory};

/// Norm of A s up to which e^{As} is enclosed for all shorter times at once.
const SHORT_STEP_NORM: f64 = 0.5;

/// Parts of one step at most; beyond, the bound is valid but large.
const MOST_SHORT_STEPS: f64 = 4096.0;

/// e^{A t_k} and Γ(t_k) = ∫₀^{t_k} e^{Aτ} B dτ at every sample of a grid, and the solutions of the system on it.
///
/// Intervals are never multiplied step after step, which would let them grow with every step. The steps are done in floating point, the
/// defect of each is bounded, δ_k = Ẽ_k Φ_k - Ẽ_{k+1}, and the error of Ẽ_k is e_k = Σ_j δ_j e^{A(t_k - t_{j+1})}. Two bounds hold, and the
/// smaller one is taken entry by entry:
///
/// - |e_k| <= (Σ_j |δ_j|) M with M >= |e^{Aτ}| over the whole horizon, which grows linearly (M is found a posteriori, see
///   `bound_exponential`);
/// - |e_{k+1}| <= |e_k| |Φ_k| + |δ_k|, which follows the growth or decay of a system whose entries keep their signs.
///
/// # Examples
///
/// ```
/// use nalgebra::{dmatrix, dvector};
/// use reachtube_reach::{LinearSystem, Propagation, TimeGrid};
///
/// let decay = LinearSystem::new(dmatrix![-1.0], dmatrix![1.0], dvector![0.0])?;
/// let propagation = Propagation::new(&decay, &TimeGrid::uniform(0.01, 101))?;
/// assert!(propagation.exponential(100)[(0, 0)].contains((-1.0f64).exp()));
/// assert!(propagation.exponential(100)[(0, 0)].width() < 1e-13);
/// # Ok::<(), reachtube_reach::ReachError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Propagation {
    system: LinearSystem,
    grid: TimeGrid,
    steps: Vec<Step>,
    exponential: Vec<IntervalMatrix>,
    integral: Vec<IntervalMatrix>,
    bound: DMatrix<f64>,
}

impl Propagation {
    /// Encloses the solutions of `system` on `grid`.
    ///
    /// # Errors
    ///
    /// [`ReachError::Horizon`] when no finite enclosure is found.
    pub fn new(system: &LinearSystem, grid: &TimeGrid) -> Result<Self, ReachError> {
        let steps = steps_of(system, grid);
        let step_at = |k: usize| if grid.step().is_some() { &steps[0] } else { &steps[k] };
        let powers = RoundedPowers::new(system.states(), grid.len(), &step_at);
        let bound = bound_exponential(&powers, &bound_within_step(system, grid.longest_step()));
        let errors = powers.errors(&step_at, &bound);
        let mut exponential: Vec<_> =
            powers.mid.iter().zip(&errors).map(|(mid, rad)| ball(mid, rad)).collect();
        exponential.truncate(grid.len());
        let integral = integrals(system, &exponential, &step_at);
        let finite = |m: &IntervalMatrix| m.iter().all(|x| x.mag().is_finite());
        if !exponential.iter().chain(&integral).all(finite) {
            return Err(ReachError::Horizon { time: grid.times().last().copied().unwrap_or(0.0) });
        }
        Ok(Self { system: system.clone(), grid: grid.clone(), steps, exponential, integral, bound })
    }

    /// The system.
    pub fn system(&self) -> &LinearSystem {
        &self.system
    }

    /// The grid.
    pub fn grid(&self) -> &TimeGrid {
        &self.grid
    }

    /// e^{A t_k}, N x N.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn exponential(&self, k: usize) -> &IntervalMatrix {
        &self.exponential[k]
    }

    /// Γ(t_k) = ∫₀^{t_k} e^{Aτ} B dτ, N x m.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn integral(&self, k: usize) -> &IntervalMatrix {
        &self.integral[k]
    }

    /// Φ, Γ and γ of the step from sample k to k + 1.
    pub fn step(&self, k: usize) -> &Step {
        if self.grid.step().is_some() { &self.steps[0] } else { &self.steps[k] }
    }

    /// The solution from `start` (N) under the piecewise constant input `inputs` (one row of m entries a sample, in effect until the next
    /// sample; the row of the last sample is not used). Its length is the number of rows, at most that of the grid (without inputs,
    /// that of the grid).
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: for every start in `start`, the exact solution at each sample lies in the trajectory.
    pub fn solve(&self, start: &IntervalVector, inputs: &[f64]) -> Trajectory {
        let (n, m) = (self.system.states(), self.system.inputs());
        let rows = inputs.len().checked_div(m).unwrap_or(usize::MAX);
        let samples = rows.min(self.grid.len());
        let mut mid: Vec<f64> = start.iter().map(|x| x.mid()).collect();
        let mut error = SolutionError::new(start);
        let mut states = Vec::with_capacity(samples * n);
        let mut next = vec![Interval::ZERO; n];
        for k in 0..samples {
            states.extend(mid.iter().zip(&error.radius).map(|(&mid, &rad)| Interval::centered(mid, rad)));
            if k + 1 < samples {
                advance(self.step(k), &mid, &inputs[k * m..(k + 1) * m], &mut next);
                error.advance(self, k, &next);
                mid.iter_mut().zip(&next).for_each(|(mid, next)| *mid = next.mid());
            }
        }
        Trajectory::new(n, states)
    }
}

/// One step of the solution, enclosed: Φ x + Γ u + γ.
fn advance(step: &Step, x: &[f64], u: &[f64], next: &mut [Interval]) {
    next.copy_from_slice(step.drift.as_slice());
    for (matrix, vector) in [(&step.phi, x), (&step.gamma, u)] {
        for (column, &value) in matrix.column_iter().zip(vector) {
            let value = Interval::point(value);
            next.iter_mut()
                .zip(column.iter())
                .filter(|(_, x)| **x != Interval::ZERO)
                .for_each(|(sum, &x)| *sum += x * value);
        }
    }
}

/// The error of a floating-point solution, bounded in the same two ways as that of the exponential.
struct SolutionError {
    start: Vec<f64>,
    /// Sum of the defects so far.
    defects: Vec<f64>,
    /// The error carried over from the sample before.
    followed: Vec<f64>,
    /// The smaller of the two bounds.
    radius: Vec<f64>,
}

impl SolutionError {
    fn new(start: &IntervalVector) -> Self {
        let radius: Vec<f64> = start.iter().map(|x| x.rad()).collect();
        let zero = vec![0.0; radius.len()];
        Self { start: radius.clone(), defects: zero.clone(), followed: zero, radius }
    }

    /// To sample k + 1, where the rounded step was `next`.
    fn advance(&mut self, propagation: &Propagation, k: usize, next: &[Interval]) {
        let (phi, exponential) = (&propagation.step(k).phi, &propagation.exponential[k + 1]);
        for (i, next) in next.iter().enumerate() {
            self.defects[i] = add_up(self.defects[i], next.rad());
            self.followed[i] =
                add_up(dot_upward(phi.row(i).iter().map(|x| x.mag()), &self.radius), next.rad());
        }
        for i in 0..next.len() {
            let start = dot_upward(exponential.row(i).iter().map(|x| x.mag()), &self.start);
            let defects = dot_upward(propagation.bound.row(i).iter().copied(), &self.defects);
            self.radius[i] = self.followed[i].min(add_up(start, defects));
        }
    }
}

fn steps_of(system: &LinearSystem, grid: &TimeGrid) -> Vec<Step> {
    let count = if grid.step().is_some() { 1 } else { grid.len().saturating_sub(1) };
    (0..count).into_par_iter().map(|k| step(system, grid.interval(k))).collect()
}

/// Floating-point e^{A t_k}, and bounds of the defects |δ_k| of its steps.
struct RoundedPowers {
    mid: Vec<DMatrix<f64>>,
    defects: Vec<DMatrix<f64>>,
}

impl RoundedPowers {
    fn new<'a>(states: usize, samples: usize, step_at: &impl Fn(usize) -> &'a Step) -> Self {
        let mut mid = vec![DMatrix::identity(states, states)];
        let mut defects = Vec::new();
        for k in 1..samples {
            let phi = &step_at(k - 1).phi;
            defects.push(mul_upward(&mid[k - 1].abs(), &product_error(phi)));
            mid.push(&mid[k - 1] * midpoint(phi));
        }
        Self { mid, defects }
    }

    /// The bounds of |e_k|.
    fn errors<'a>(&self, step_at: &impl Fn(usize) -> &'a Step, bound: &DMatrix<f64>) -> Vec<DMatrix<f64>> {
        let mut total = self.mid[0].map(|_| 0.0);
        let mut errors = vec![total.clone()];
        for (k, defect) in self.defects.iter().enumerate() {
            accumulate_upward(&mut total, defect);
            let mut followed = mul_upward(&errors[k], &magnitude(&step_at(k).phi));
            accumulate_upward(&mut followed, defect);
            errors.push(followed.zip_map(&mul_upward(&total, bound), f64::min));
        }
        errors
    }
}

/// W >= 0 such that the floating-point product of any matrix X with the midpoint of Φ is within |X| W of the exact X Φ.
///
/// W = (N + 1) u |mid Φ| + rad Φ with the unit roundoff u: the sum of N products, in any order and with or without fused operations, has
/// an error of at most N u / (1 - N u) times the sum of the absolute products (Higham, Accuracy and Stability of Numerical Algorithms,
/// section 3.1). Where a product underflows, the rounding of |X| W by at least one unit for each product covers it.
fn product_error(phi: &IntervalMatrix) -> DMatrix<f64> {
    let relative = (phi.nrows() + 1) as f64 * f64::EPSILON / 2.0;
    phi.map(|x| add_up(mul_up(relative, x.mid().abs()), x.rad()))
}

/// P >= |e^{As}| entrywise for 0 <= s <= h: a horizon in itself, of steps so short that one enclosure over each is good enough.
fn bound_within_step(system: &LinearSystem, h: f64) -> DMatrix<f64> {
    let norm = norm_upper(&magnitude(&point(system.a())));
    // `max` is 1 for NaN too: an infinite norm over no time.
    let parts = MOST_SHORT_STEPS.min((norm * h / SHORT_STEP_NORM).ceil().max(1.0));
    let short = Interval::point(h) / parts;
    let short_step = step(system, short);
    let powers = RoundedPowers::new(system.states(), parts as usize, &|_| &short_step);
    bound_exponential(&powers, &magnitude(&step(system, Interval::ZERO.hull(short)).phi))
}

/// M >= |e^{Aτ}| entrywise for every τ of the horizon; infinite when none is found.
///
/// With P >= |e^{As}| over one step, D = Σ|δ_j| and M̃ = max_k |Ẽ_k|, any M with (M̃ + D M) P <= M bounds it, by induction over the samples:
/// |e^{A t_k}| <= |Ẽ_k| + D M as long as M holds up to t_k, and from there to the next sample another factor P covers it. The left side
/// of the inequality then is such an M as well, and a smaller one.
fn bound_exponential(powers: &RoundedPowers, within_step: &DMatrix<f64>) -> DMatrix<f64> {
    let mut largest = powers.mid[0].clone();
    let mut defects = powers.mid[0].map(|_| 0.0);
    for (mid, defect) in powers.mid.iter().skip(1).zip(&powers.defects) {
        largest.zip_apply(mid, |max, x| *max = max.max(x.abs()));
        accumulate_upward(&mut defects, defect);
    }
    let mut candidate = mul_upward(&largest, within_step) * 2.0;
    for _ in 0..8 {
        let mut inside = mul_upward(&defects, &candidate);
        accumulate_upward(&mut inside, &largest);
        let image = mul_upward(&inside, within_step);
        if image.iter().zip(&candidate).all(|(i, c)| i <= c && c.is_finite()) {
            return image;
        }
        candidate = candidate.sup(&image) * 2.0;
    }
    candidate.map(|_| f64::INFINITY)
}

/// Γ(t_{k+1}) = Γ(t_k) + e^{A t_k} Γ(h_k), again with the error apart from a floating-point sum.
fn integrals<'a>(
    system: &LinearSystem,
    exponential: &[IntervalMatrix],
    step_at: &(impl Fn(usize) -> &'a Step + Sync),
) -> Vec<IntervalMatrix> {
    let increment = |k: usize| product(&exponential[k], &step_at(k).gamma);
    let increments: Vec<_> =
        (0..exponential.len().saturating_sub(1)).into_par_iter().map(increment).collect();
    let zero = DMatrix::zeros(system.states(), system.inputs());
    let (mut mid, mut rad) = (zero.clone(), zero);
    let mut integral = vec![ball(&mid, &rad)];
    for increment in increments {
        let sum = point(&mid) + increment;
        mid = midpoint(&sum);
        accumulate_upward(&mut rad, &radius(&sum));
        integral.push(ball(&mid, &rad));
    }
    integral.truncate(exponential.len());
    integral
}

#[cfg(test)]
mod tests {
    use nalgebra::{dmatrix, dvector};

    use super::*;

    fn rotation(omega: f64) -> LinearSystem {
        LinearSystem::new(dmatrix![0.0, omega; -omega, 0.0], dmatrix![0.0; 1.0], dvector![0.0, 0.0]).unwrap()
    }

    #[test]
    fn the_bound_holds_over_the_horizon_and_is_close() {
        let propagation = Propagation::new(&rotation(2.0), &TimeGrid::uniform(0.01, 400)).unwrap();
        assert!(propagation.bound.iter().all(|&m| (1.0..1.1).contains(&m)), "{}", propagation.bound);
    }

    #[test]
    fn the_bound_within_a_long_step_does_not_grow_with_its_norm() {
        let bound = bound_within_step(&rotation(100.0), 0.5);
        assert!(bound.iter().all(|&p| (1.0..2.0).contains(&p)), "{bound}");
        let decay = LinearSystem::new(dmatrix![-80.0], dmatrix![1.0], dvector![0.0]).unwrap();
        assert!((1.0..2.0).contains(&bound_within_step(&decay, 1.0)[(0, 0)]));
    }

    #[test]
    fn no_bound_is_infinite_not_wrong() {
        let growth = LinearSystem::new(dmatrix![60.0], dmatrix![1.0], dvector![0.0]).unwrap();
        let propagation = Propagation::new(&growth, &TimeGrid::uniform(0.01, 101)).unwrap();
        assert_eq!(propagation.bound[(0, 0)], f64::INFINITY);
        assert!(propagation.exponential(100)[(0, 0)].contains(60f64.exp()));
    }
}
