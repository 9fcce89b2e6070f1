use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::add_up;

use crate::exponential::{Step, step};
use crate::matrix::{IntervalMatrix, IntervalVector, dot_upward, mul_upward};
use crate::powers::bound_within_step;
use crate::samples::Samples;
use crate::sums::{absolute_ends, running_sum};
use crate::{LinearSystem, ReachError, TimeGrid, Trajectory};

/// e^{A t_k} and Γ(t_k) = ∫₀^{t_k} e^{Aτ} B dτ at every sample of a grid, and the solutions of the
/// system on it.
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
    samples: Samples,
    integral: Vec<IntervalMatrix>,
    /// M >= |e^{A(t_k - t_j)}| for every j <= k.
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
        let (samples, within_step) = match grid.step() {
            Some(h) => {
                let samples = Samples::uniform(system, &steps[0], Interval::point(h), grid.len());
                (samples, DMatrix::identity(system.states(), system.states()))
            }
            None => {
                let within_step = bound_within_step(system, grid.longest_step());
                (Samples::after(system, &steps, grid.len(), &within_step), within_step)
            }
        };
        let (largest, integral) = rayon::join(
            || samples.largest(),
            || running_sum(system, grid.len(), |k| samples.increment_ends(k)),
        );
        let bound = mul_upward(&largest, &within_step);
        let last = integral.last().into_iter().flat_map(|last| last.iter().map(|x| x.mag()));
        if !bound.iter().copied().chain(last).all(f64::is_finite) {
            return Err(ReachError::Horizon { time: grid.times().last().copied().unwrap_or(0.0) });
        }
        Ok(Self { system: system.clone(), grid: grid.clone(), steps, samples, integral, bound })
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
    pub fn exponential(&self, k: usize) -> IntervalMatrix {
        self.samples.exponential(k)
    }

    /// Γ(t_k) = ∫₀^{t_k} e^{Aτ} B dτ, N x m.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn integral(&self, k: usize) -> &IntervalMatrix {
        &self.integral[k]
    }

    /// e^{A t_k} Γ(h_k) = ∫ e^{Aτ} B dτ over step k, N x m.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn increment(&self, k: usize) -> IntervalMatrix {
        self.samples.increment(k)
    }

    /// Σ_{j<k} |e^{A t_j} Γ(h_j)| at every sample k.
    pub(crate) fn absolute_sums(&self) -> Vec<IntervalMatrix> {
        running_sum(&self.system, self.grid.len(), |k| {
            self.samples.increment_ends(k).map(absolute_ends)
        })
    }

    /// The lower and upper ends of column j of e^{A t_k}.
    pub(crate) fn exponential_ends(&self, k: usize, j: usize) -> impl Iterator<Item = (f64, f64)> {
        self.samples.ends(k, j..j + 1)
    }

    /// Φ, Γ and γ of the step from sample k to k + 1.
    pub fn step(&self, k: usize) -> &Step {
        if self.grid.step().is_some() { &self.steps[0] } else { &self.steps[k] }
    }

    /// The solution from `start` (N) under the piecewise constant input `inputs` (one row of m
    /// entries a sample, in effect until the next sample; the row of the last sample is not used).
    /// Its length is the number of rows, at most that of the grid (without inputs, that of the
    /// grid).
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: for every start in `start`, the exact solution at each sample lies
    /// in the trajectory.
    pub fn solve(&self, start: &IntervalVector, inputs: &[f64]) -> Trajectory {
        let (n, m) = (self.system.states(), self.system.inputs());
        let rows = inputs.len().checked_div(m).unwrap_or(usize::MAX);
        let samples = rows.min(self.grid.len());
        let mut mid: Vec<f64> = start.iter().map(|x| x.mid()).collect();
        let mut error = SolutionError::new(start);
        let mut states = Vec::with_capacity(samples * n);
        let mut next = vec![Interval::ZERO; n];
        for k in 0..samples {
            states.extend(
                mid.iter().zip(&error.radius).map(|(&mid, &rad)| Interval::centered(mid, rad)),
            );
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
        let (phi, exponential) = (&propagation.step(k).phi, propagation.exponential(k + 1));
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

#[cfg(test)]
mod tests {
    use nalgebra::{dmatrix, dvector};

    use super::*;

    fn rotation(omega: f64) -> LinearSystem {
        LinearSystem::new(dmatrix![0.0, omega; -omega, 0.0], dmatrix![0.0; 1.0], dvector![0.0, 0.0])
            .unwrap()
    }

    #[test]
    fn the_bound_holds_over_the_horizon_and_is_close() {
        let times: Vec<f64> = (0..400).map(|k| 0.01 * f64::from(k)).chain([3.999]).collect();
        let recorded = TimeGrid::from_times(&times).unwrap();
        for (grid, least) in [(recorded, 1.0), (TimeGrid::uniform(0.01, 400), 0.9999)] {
            let propagation = Propagation::new(&rotation(2.0), &grid).unwrap();
            assert!(
                propagation.bound.iter().all(|m| (least..1.1).contains(m)),
                "{}",
                propagation.bound
            );
            for k in 0..grid.len() {
                let below = propagation
                    .exponential(k)
                    .zip_map(&propagation.bound, |x, bound| x.mag() <= bound);
                assert!(below.iter().all(|&holds| holds), "sample {k}");
            }
        }
    }
}
