use nalgebra::DMatrix;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::exponential::{Step, step};
use crate::matrix::{
    IntervalMatrix, IntervalVector, accumulate_upward, ball, magnitude, midpoint, mul_upward, point,
};
use crate::{LinearSystem, ReachError, TimeGrid, Trajectory};

/// e^{A t_k} and Γ(t_k) = ∫₀^{t_k} e^{Aτ} B dτ at every sample of a grid, and the solutions of the system on it.
///
/// Intervals are never multiplied step after step, which would let them grow with every step. The steps are done in floating point, the
/// defect of each is enclosed, δ_k = Ẽ_k Φ_k - Ẽ_{k+1}, and the error is e_k = Σ_j δ_j e^{A(t_k - t_{j+1})}, hence |e_k| <= (Σ_j |δ_j|) M
/// with M >= |e^{Aτ}| over the whole horizon: it grows linearly. M itself is found a posteriori (see `bound_exponential`).
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
        let phi = |k: usize| if grid.step().is_some() { &steps[0] } else { &steps[k] };
        let rounded = RoundedPowers::new(system.states(), grid.len(), &phi);
        let longest = Interval::new(0.0, grid.longest_step()).unwrap_or(Interval::ENTIRE);
        let within_step = magnitude(&step(system, longest).phi);
        let horizon = || ReachError::Horizon { time: grid.times().last().copied().unwrap_or(0.0) };
        let bound = bound_exponential(&rounded, &within_step).ok_or_else(horizon)?;
        let (exponential, integral) = enclose(system, rounded, &phi, &bound);
        let finite = |m: &IntervalMatrix| m.iter().all(|x| x.mag().is_finite());
        if !exponential.iter().all(finite) || !integral.iter().all(finite) {
            return Err(horizon());
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
    /// sample; the row of the last sample is not used). Its length is the number of rows, at most that of the grid.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: for every start in `start`, the exact solution at each sample lies in the trajectory.
    pub fn solve(&self, start: &IntervalVector, inputs: &[f64]) -> Trajectory {
        let (n, m) = (self.system.states(), self.system.inputs());
        let samples = if m == 0 { self.grid.len() } else { inputs.len() / m };
        let mut mid: Vec<f64> = start.iter().map(|x| x.mid()).collect();
        let mut defect: Vec<f64> = start.iter().map(|x| x.rad()).collect();
        let mut states = Vec::with_capacity(samples * n);
        let mut next = vec![Interval::point(0.0); n];
        for k in 0..samples {
            let spread = |i: usize| dot_upward(&self.bound, i, &defect);
            states.extend((0..n).map(|i| Interval::centered(mid[i], spread(i))));
            if k + 1 == samples {
                break;
            }
            advance(self.step(k), &mid, &inputs[k * m..(k + 1) * m], &mut next);
            for i in 0..n {
                mid[i] = next[i].mid();
                defect[i] = add_up(defect[i], next[i].rad());
            }
        }
        Trajectory::new(n, states)
    }
}

/// One step of the solution, enclosed: Φ x + Γ u + γ.
fn advance(step: &Step, x: &[f64], u: &[f64], next: &mut [Interval]) {
    next.iter_mut().zip(&step.drift).for_each(|(entry, drift)| *entry = *drift);
    for (j, &value) in x.iter().enumerate() {
        next.iter_mut().zip(step.phi.column(j).iter()).for_each(|(entry, &phi)| *entry += phi * value);
    }
    for (j, &value) in u.iter().enumerate() {
        next.iter_mut().zip(step.gamma.column(j).iter()).for_each(|(entry, &gamma)| *entry += gamma * value);
    }
}

fn dot_upward(matrix: &DMatrix<f64>, row: usize, vector: &[f64]) -> f64 {
    vector.iter().enumerate().fold(0.0, |sum, (j, &x)| add_up(sum, mul_up(matrix[(row, j)], x)))
}

fn steps_of(system: &LinearSystem, grid: &TimeGrid) -> Vec<Step> {
    let count = match (grid.step(), grid.len()) {
        (Some(_), _) => 1,
        (None, samples) => samples.saturating_sub(1),
    };
    (0..count).map(|k| step(system, grid.interval(k))).collect()
}

/// Floating-point e^{A t_k} and the running sum of its defects.
struct RoundedPowers {
    mid: Vec<DMatrix<f64>>,
    /// Σ_{j<k} |δ_j|, rounded upward.
    defects: Vec<DMatrix<f64>>,
}

impl RoundedPowers {
    fn new<'a>(states: usize, samples: usize, phi: &impl Fn(usize) -> &'a Step) -> Self {
        let mut mid = vec![DMatrix::identity(states, states)];
        let mut defects = vec![DMatrix::zeros(states, states)];
        for k in 1..samples {
            let product = point(&mid[k - 1]) * &phi(k - 1).phi;
            let mut defect = defects[k - 1].clone();
            accumulate_upward(&mut defect, &product.map(|x| x.rad()));
            mid.push(midpoint(&product));
            defects.push(defect);
        }
        Self { mid, defects }
    }
}

/// M >= |e^{Aτ}| entrywise for every τ of the horizon.
///
/// With P >= |e^{As}| over one step, D = Σ|δ_j| and M̃ = max_k |Ẽ_k|, any M with (M̃ + D M) P <= M bounds it, by induction over the samples:
/// |e^{A t_k}| <= |Ẽ_k| + D M as long as M holds before t_k, and between samples another factor P covers it.
fn bound_exponential(powers: &RoundedPowers, within_step: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let largest = powers.mid.iter().skip(1).fold(powers.mid[0].abs(), |max, e| max.sup(&e.abs()));
    let defects = powers.defects.last()?;
    let mut candidate = mul_upward(&largest, within_step) * 2.0;
    for _ in 0..8 {
        let mut inside = mul_upward(defects, &candidate);
        accumulate_upward(&mut inside, &largest);
        let image = mul_upward(&inside, within_step);
        if image.iter().zip(&candidate).all(|(i, c)| i <= c && c.is_finite()) {
            return Some(candidate);
        }
        candidate = candidate.sup(&image) * 2.0;
    }
    None
}

fn enclose<'a>(
    system: &LinearSystem,
    powers: RoundedPowers,
    phi: &impl Fn(usize) -> &'a Step,
    bound: &DMatrix<f64>,
) -> (Vec<IntervalMatrix>, Vec<IntervalMatrix>) {
    let exponential: Vec<IntervalMatrix> =
        powers.mid.iter().zip(&powers.defects).map(|(mid, d)| ball(mid, &mul_upward(d, bound))).collect();
    let zero = DMatrix::zeros(system.states(), system.inputs());
    let (mut mid, mut rad) = (zero.clone(), zero);
    let mut integral = vec![ball(&mid, &rad)];
    for k in 1..exponential.len() {
        let sum = point(&mid) + &exponential[k - 1] * &phi(k - 1).gamma;
        mid = midpoint(&sum);
        accumulate_upward(&mut rad, &sum.map(|x| x.rad()));
        integral.push(ball(&mid, &rad));
    }
    (exponential, integral)
}
