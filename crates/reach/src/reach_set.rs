use rayon::prelude::*;
use reachtube_scalar::Interval;

use crate::matrix::IntervalMatrix;
use crate::sums::{ColumnSums, absolute_ends, column_ends};
use crate::{Hyperrectangle, Propagation};

/// So many samples at least are worth a thread.
const TOGETHER: usize = 64;

/// An enclosed solution at the samples of a grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    dimension: usize,
    states: Vec<Interval>,
}

impl Trajectory {
    pub(crate) fn new(dimension: usize, states: Vec<Interval>) -> Self {
        Self { dimension, states }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.states.len() / self.dimension.max(1)
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// The state at sample k, N entries.
    pub fn state(&self, k: usize) -> &[Interval] {
        &self.states[k * self.dimension..(k + 1) * self.dimension]
    }
}

/// The reachable set of the deviation δẋ = A δx + B δu, δx(0) ∈ X0, δu ∈ U, at the samples of a
/// grid: the interval hull, centre c_k and radius r_k. Adding the nominal solution gives the
/// reachable set of the system.
#[derive(Debug, Clone, PartialEq)]
pub struct ReachSets {
    dimension: usize,
    center: Vec<Interval>,
    radius: Vec<Interval>,
}

impl ReachSets {
    /// The hulls for the initial set X0 (N), the input set U (m), and the gains κ of a
    /// [`Disturbance`](crate::Disturbance) on the same grid: c_k = e^{A t_k} c_x + Γ(t_k) c_u, r_k
    /// = |e^{A t_k}| r_x + κ(t_k) r_u.
    ///
    /// # Guarantee
    ///
    /// Centre and radius of the exact hull are enclosed with directed rounding:
    /// [`upper_outer`](Self::upper_outer) and [`lower_outer`](Self::lower_outer) bound the hull
    /// from outside, [`upper_inner`](Self::upper_inner) and [`lower_inner`](Self::lower_inner) from
    /// inside. The hull itself is exact as a hull: each face is touched by some admissible
    /// disturbance.
    pub fn new(
        propagation: &Propagation,
        gains: &[IntervalMatrix],
        initial_set: &Hyperrectangle,
        input_set: &Hyperrectangle,
    ) -> Self {
        let dimension = propagation.system().states();
        let mut center = vec![Interval::ZERO; gains.len() * dimension];
        let mut radius = center.clone();
        let hull =
            |sums: &mut ColumnSums,
             (k, (center, radius)): (usize, (&mut [Interval], &mut [Interval]))| {
                let exponential = |j: usize| propagation.exponential_ends(k, j);
                sums.clear();
                sums.add(&initial_set.center, exponential);
                sums.add(&input_set.center, |j| column_ends(propagation.integral(k), j));
                center.iter_mut().zip(sums.enclosed()).for_each(|(center, sum)| *center = sum);
                sums.clear();
                sums.add(&initial_set.radius, |j| exponential(j).map(absolute_ends));
                sums.add(&input_set.radius, |j| column_ends(&gains[k], j));
                radius.iter_mut().zip(sums.enclosed()).for_each(|(radius, sum)| *radius = sum);
            };
        let states = dimension.max(1);
        let samples = center
            .par_chunks_exact_mut(states)
            .zip(radius.par_chunks_exact_mut(states))
            .enumerate();
        samples.with_min_len(TOGETHER).for_each_init(|| ColumnSums::new(dimension), hull);
        Self { dimension, center, radius }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.center.len() / self.dimension.max(1)
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.center.is_empty()
    }

    /// The centre of the hull at sample k in state i, enclosed.
    pub fn center(&self, k: usize, i: usize) -> Interval {
        self.center[k * self.dimension + i]
    }

    /// The radius of the hull at sample k in state i, enclosed.
    pub fn radius(&self, k: usize, i: usize) -> Interval {
        self.radius[k * self.dimension + i]
    }

    /// An upper bound of the highest reachable deviation.
    ///
    /// # Guarantee
    ///
    /// Outer.
    pub fn upper_outer(&self, k: usize, i: usize) -> f64 {
        (self.center(k, i) + self.radius(k, i)).hi()
    }

    /// A lower bound of the lowest reachable deviation.
    ///
    /// # Guarantee
    ///
    /// Outer.
    pub fn lower_outer(&self, k: usize, i: usize) -> f64 {
        (self.center(k, i) - self.radius(k, i)).lo()
    }

    /// A lower bound of the highest reachable deviation: what is below it is reachable in this
    /// state.
    ///
    /// # Guarantee
    ///
    /// Inner.
    pub fn upper_inner(&self, k: usize, i: usize) -> f64 {
        (self.center(k, i) + self.radius(k, i)).lo()
    }

    /// An upper bound of the lowest reachable deviation.
    ///
    /// # Guarantee
    ///
    /// Inner.
    pub fn lower_inner(&self, k: usize, i: usize) -> f64 {
        (self.center(k, i) - self.radius(k, i)).hi()
    }
}
