//! A model over recordings, and its reachable set at one sample.

use reachtube_reach::GeneratorRows;

use crate::error::Result;
use crate::hulls::Hulls;
use crate::sets::UncertaintySets;
use crate::tube::judged::{At, Judged};

/// A model over recordings, whose reachable sets under some sets can be computed.
pub(crate) trait Plant: Sync {
    /// Returns whether its reachable sets have the rows of its program.
    fn is_exact(&self) -> bool;

    /// Computes the reachable sets under `sets`, and shows each slice to `watch`; returns what that
    /// found, merged. Slices are not kept: a long motion's take gigabytes.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`](crate::Problem::run); when a solution cannot be enclosed.
    fn tube(&self, sets: &UncertaintySets, watch: Option<&Watch>) -> Result<(Hulls, Judged)>;
}

/// What looks at each slice while reachable sets are computed.
pub(crate) type Watch<'a> = dyn Fn(&dyn Slice) -> Judged + Sync + 'a;

/// The reachable set at one sample.
pub(crate) trait Slice: Sync {
    /// Returns strand and sample.
    fn at(&self) -> At;

    /// Returns the centre of the set, and how far it may be off, 2n each.
    fn centre(&self) -> (Vec<f64>, Vec<f64>);

    /// Returns the generators of the set with the noise set in the entries `states`. Disturbances
    /// are held over `held` steps in a row: 1, or more for a smaller set of fewer generators.
    ///
    /// # Guarantee
    ///
    /// Inner, as [`SampleGenerators::at`](reachtube_reach::SampleGenerators::at) and
    /// [`GeneratorRows::merged`]: what lies in their zonotope about the centre lies in the set.
    fn generators(&self, states: &[usize], held: usize) -> GeneratorRows;

    /// Returns `held` of the smaller sets that most points lie in, the smallest first.
    fn coarse(&self) -> Vec<usize>;

    /// Returns max lᵀ x over the set without the noise set, in floating point.
    fn support(&self, direction: &[f64]) -> f64;
}
