use rayon::prelude::*;
use reachtube_scalar::Interval;

use crate::linear::column_sums::{ColumnSums, absolute_ends, column_ends};
use crate::linear::propagation::Propagation;
use crate::sets::hyperrectangle::Hyperrectangle;
use crate::sets::interval_matrix::IntervalMatrix;

/// Smallest number of samples in one task of a thread.
const SAMPLES_PER_TASK: usize = 64;

/// Interval hulls of the reachable sets of the deviation δẋ = A δx + B δu, δx(0) ∈ X0, δu ∈ U, at
/// the samples of a grid.
///
/// Each hull has a centre c_k and a radius r_k. The hull plus the nominal motion is the hull of
/// the reachable set of the system.
#[derive(Debug, Clone, PartialEq)]
pub struct ReachSets {
    dimension: usize,
    centre: Vec<Interval>,
    radius: Vec<Interval>,
}

impl ReachSets {
    /// Computes the hulls for the initial set X0 (N), the input set U (m) and the input gains κ of
    /// a [`Disturbance`](crate::Disturbance) on the same grid.
    ///
    /// c_k = e^{A t_k} c_x + Γ(t_k) c_u and r_k = |e^{A t_k}| r_x + κ(t_k) r_u.
    ///
    /// # Guarantee
    ///
    /// Centre and radius of the exact hull are enclosed with directed rounding.
    /// [`upper_outer`](Self::upper_outer) and [`lower_outer`](Self::lower_outer) bound the hull
    /// from outside, [`upper_inner`](Self::upper_inner) and [`lower_inner`](Self::lower_inner) from
    /// inside. The formulas are exact for the hull: some admissible disturbance reaches each face.
    pub fn new(
        propagation: &Propagation,
        input_gains: &[IntervalMatrix],
        initial_set: &Hyperrectangle,
        input_set: &Hyperrectangle,
    ) -> Self {
        let dimension = propagation.system().states();
        let mut centre = vec![Interval::ZERO; input_gains.len() * dimension];
        let mut radius = centre.clone();
        let hull =
            |sums: &mut ColumnSums,
             (k, (centre, radius)): (usize, (&mut [Interval], &mut [Interval]))| {
                let exponential = |j: usize| propagation.exponential_ends(k, j);
                sums.clear();
                sums.add(&initial_set.centre, exponential);
                sums.add(&input_set.centre, |j| column_ends(propagation.integral(k), j));
                centre.iter_mut().zip(sums.enclosed()).for_each(|(centre, sum)| *centre = sum);
                sums.clear();
                sums.add(&initial_set.radius, |j| exponential(j).map(absolute_ends));
                sums.add(&input_set.radius, |j| column_ends(&input_gains[k], j));
                radius.iter_mut().zip(sums.enclosed()).for_each(|(radius, sum)| *radius = sum);
            };
        let states = dimension.max(1);
        let samples = centre
            .par_chunks_exact_mut(states)
            .zip(radius.par_chunks_exact_mut(states))
            .enumerate();
        samples.with_min_len(SAMPLES_PER_TASK).for_each_init(|| ColumnSums::new(dimension), hull);
        Self { dimension, centre, radius }
    }

    /// Returns the number of samples.
    pub fn len(&self) -> usize {
        self.centre.len() / self.dimension.max(1)
    }

    /// Encloses the centre of the hull at sample k in state i.
    pub(crate) fn centre(&self, k: usize, i: usize) -> Interval {
        self.centre[k * self.dimension + i]
    }

    /// Encloses the radius of the hull at sample k in state i.
    pub fn radius(&self, k: usize, i: usize) -> Interval {
        self.radius[k * self.dimension + i]
    }

    /// Returns an upper bound of the highest reachable deviation at sample k in state i.
    ///
    /// # Guarantee
    ///
    /// Outer.
    pub fn upper_outer(&self, k: usize, i: usize) -> f64 {
        (self.centre(k, i) + self.radius(k, i)).hi()
    }

    /// Returns a lower bound of the lowest reachable deviation at sample k in state i.
    ///
    /// # Guarantee
    ///
    /// Outer.
    pub fn lower_outer(&self, k: usize, i: usize) -> f64 {
        (self.centre(k, i) - self.radius(k, i)).lo()
    }

    /// Returns a lower bound of the highest reachable deviation at sample k in state i.
    ///
    /// # Guarantee
    ///
    /// Inner.
    pub fn upper_inner(&self, k: usize, i: usize) -> f64 {
        (self.centre(k, i) + self.radius(k, i)).lo()
    }

    /// Returns an upper bound of the lowest reachable deviation at sample k in state i.
    ///
    /// # Guarantee
    ///
    /// Inner.
    pub fn lower_inner(&self, k: usize, i: usize) -> f64 {
        (self.centre(k, i) - self.radius(k, i)).hi()
    }
}
