use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_scalar::Interval;

use crate::error::ReachError;
use crate::grid::TimeGrid;
use crate::linear::column_sums::{absolute_ends, running_sum};
use crate::linear::exponential::powers::bound_within_step;
use crate::linear::exponential::samples::SampleMatrices;
use crate::linear::step::{PropagationStep, step};
use crate::linear::system::LinearSystem;
use crate::sets::interval_matrix::{IntervalMatrix, midpoint};
use crate::upward::mul_upward;

/// Enclosures of e^{A t_k} and Γ(t_k) = ∫₀^{t_k} e^{Aτ} B dτ at every sample of a grid, from which
/// solutions of the system are computed.
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
    steps: Vec<PropagationStep>,
    samples: SampleMatrices,
    integral: Vec<IntervalMatrix>,
    /// M >= |e^{A(t_k - t_j)}| for every j <= k.
    bound: DMatrix<f64>,
}

impl Propagation {
    /// Encloses e^{A t_k} and Γ(t_k) of `system` on `grid`.
    ///
    /// # Errors
    ///
    /// Returns [`ReachError::Horizon`] when the enclosure is not finite.
    pub fn new(system: &LinearSystem, grid: &TimeGrid) -> Result<Self, ReachError> {
        // Enclose each distinct step, then the exponentials at all samples.
        let steps = distinct_steps(system, grid);
        let (samples, within_step) = match grid.step() {
            Some(h) => {
                let samples =
                    SampleMatrices::uniform(system, &steps[0], Interval::point(h), grid.len());
                (samples, DMatrix::identity(system.states(), system.states()))
            }
            None => {
                let within_step = bound_within_step(system, grid.longest_step());
                (SampleMatrices::after(system, &steps, grid.len(), &within_step), within_step)
            }
        };
        Self::of(system.clone(), grid.clone(), steps, samples, &within_step)
    }

    /// Encloses Φᵏ and Σ_{j<k} Φʲ Γ of a step x ↦ Φ x + Γ u + γ that is repeated every `h` s, for
    /// `count` samples: of a discrete system, or of one whose input acts within a step. The system
    /// of the result has the middles of Φ, Γ and γ in place of A, B and d.
    ///
    /// # Errors
    ///
    /// Returns [`ReachError::Shape`] when the shapes do not fit, [`ReachError::NotFinite`], and
    /// [`ReachError::Horizon`] when the enclosure is not finite.
    ///
    /// # Panics
    ///
    /// As [`TimeGrid::uniform`].
    ///
    /// # Examples
    ///
    /// ```
    /// use nalgebra::{dmatrix, dvector};
    /// use reachtube_reach::{Propagation, PropagationStep};
    ///
    /// let [phi, gamma] = [0.5, 1.0].map(|x: f64| dmatrix![x.into()]);
    /// let step = PropagationStep { phi, gamma, drift: dvector![0.0.into()] };
    /// let halving = Propagation::of_step(step, 1.0, 4)?;
    /// assert!(halving.exponential(3)[(0, 0)].contains(0.125));
    /// assert!(halving.integral(3)[(0, 0)].contains(1.75));
    /// # Ok::<(), reachtube_reach::ReachError>(())
    /// ```
    pub fn of_step(step: PropagationStep, h: f64, count: usize) -> Result<Self, ReachError> {
        let PropagationStep { phi, gamma, drift } = &step;
        let system =
            LinearSystem::new(midpoint(phi), midpoint(gamma), drift.map(|entry| entry.mid()))?;
        let samples = SampleMatrices::of_step(&system, &step, count);
        let within_step = DMatrix::identity(system.states(), system.states());
        Self::of(system, TimeGrid::uniform(h, count), vec![step], samples, &within_step)
    }

    /// Sums the increments to Γ and bounds all exponentials of the horizon.
    fn of(
        system: LinearSystem,
        grid: TimeGrid,
        steps: Vec<PropagationStep>,
        samples: SampleMatrices,
        within_step: &DMatrix<f64>,
    ) -> Result<Self, ReachError> {
        let shape = (system.states(), system.inputs());
        let (largest, integral) = rayon::join(
            || samples.largest(),
            || running_sum(shape, grid.len(), |k| samples.increment_ends(k)),
        );
        let bound = mul_upward(&largest, within_step);
        let last = integral.last().into_iter().flat_map(|last| last.iter().map(|x| x.mag()));
        if !bound.iter().copied().chain(last).all(f64::is_finite) {
            return Err(ReachError::Horizon { time: grid.times().last().copied().unwrap_or(0.0) });
        }
        Ok(Self { system, grid, steps, samples, integral, bound })
    }

    /// Returns the system.
    pub fn system(&self) -> &LinearSystem {
        &self.system
    }

    /// Returns the grid.
    pub fn grid(&self) -> &TimeGrid {
        &self.grid
    }

    /// Returns e^{A t_k}, N x N.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn exponential(&self, k: usize) -> IntervalMatrix {
        self.samples.exponential(k)
    }

    /// Returns midpoints and radii of e^{A t_k}, each N x N, column by column.
    ///
    /// # Guarantee
    ///
    /// Outer: the exact entry is within the radius of the midpoint.
    pub(crate) fn exponential_ball(&self, k: usize) -> (&[f64], &[f64]) {
        self.samples.exponential_ball(k)
    }

    /// Returns Γ(t_k) = ∫₀^{t_k} e^{Aτ} B dτ, N x m.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub fn integral(&self, k: usize) -> &IntervalMatrix {
        &self.integral[k]
    }

    /// Returns e^{A t_k} Γ(h_k) = ∫ e^{Aτ} B dτ over step k, N x m.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn increment(&self, k: usize) -> IntervalMatrix {
        self.samples.increment(k)
    }

    /// Encloses Σ_{j<k} |e^{A t_j} Γ(h_j)| at every sample k.
    pub(crate) fn absolute_sums(&self) -> Vec<IntervalMatrix> {
        running_sum((self.system.states(), self.system.inputs()), self.grid.len(), |k| {
            self.samples.increment_ends(k).map(absolute_ends)
        })
    }

    /// Iterates over the lower and upper ends of column j of e^{A t_k}.
    pub(crate) fn exponential_ends(&self, k: usize, j: usize) -> impl Iterator<Item = (f64, f64)> {
        self.samples.ends(k, j..j + 1)
    }

    /// Returns M >= |e^{A(t_k - t_j)}| for every j <= k, N x N.
    pub(crate) fn horizon_bound(&self) -> &DMatrix<f64> {
        &self.bound
    }

    /// Returns Φ, Γ and γ of the step from sample k to k + 1.
    pub fn step(&self, k: usize) -> &PropagationStep {
        if self.grid.step().is_some() { &self.steps[0] } else { &self.steps[k] }
    }
}

/// Computes one step for a uniform grid, and otherwise every step of the grid.
fn distinct_steps(system: &LinearSystem, grid: &TimeGrid) -> Vec<PropagationStep> {
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
