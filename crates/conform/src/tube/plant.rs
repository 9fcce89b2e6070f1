//! A model over recordings, and its reachable set at one sample.

use reachtube_reach::GeneratorRows;

use crate::error::Result;
use crate::program::program::{Program, RowIndex};
use crate::sets::UncertaintySets;
use crate::tube::judged::{At, Judged};
use crate::tube::state::SearchState;
use crate::tube::tube::Tube;

/// A model over recordings. It poses programs for the smallest sets, and computes the reachable
/// sets under some sets.
pub(crate) trait Plant: Sync {
    /// Returns whether its reachable sets have the rows of its program.
    fn is_exact(&self) -> bool;

    /// Poses the program of the rows that recordings ask, and of the directions of `state`. An
    /// exact plant continues from the round `before`: its rows do not depend on the sets.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`](crate::Problem::run); when the model cannot be followed along a case.
    fn round<'a>(&'a self, state: &mut SearchState, before: Option<Round<'a>>)
    -> Result<Round<'a>>;

    /// Computes the reachable sets under `sets`, and shows each slice to `watch`; returns what that
    /// found, merged. Slices are not kept: a long motion's take gigabytes.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`](crate::Problem::run); when a solution cannot be enclosed.
    fn tube(&self, sets: &UncertaintySets, watch: Option<&Watch>) -> Result<(Tube, Judged)>;

    /// Returns the centre of a reachable set at a sample, in floating point.
    fn centre(&self, tube: &Tube, at: At) -> Vec<f64>;

    /// Returns what reachable sets cost.
    ///
    /// # Errors
    ///
    /// As [`Problem::run`](crate::Problem::run).
    fn costs(&self, tube: &Tube) -> Result<Costs>;
}

/// A program, as it is posed in one round of a search.
pub(crate) struct Round<'a> {
    pub program: Program<'a>,
    /// The rows to begin with. The rows that the program generates join them.
    pub rows: Vec<RowIndex>,
    /// Where a worst-case motion under the sets of the round before diverged: case and time, s.
    pub runs_away: Option<(String, f64)>,
}

/// Cost of reachable sets; infinite if a set was lost.
pub(crate) struct Costs {
    /// The integral over time of Σ_i s_i width_i of the sets with the noise set, where strands at
    /// one time count by their mean.
    pub cost: f64,
    /// The same as a sum over distinct sample times, each of which counts 1, as in the paper.
    pub of_samples: f64,
    /// The paper's sum (21), for a linear model.
    pub paper: Option<f64>,
    /// Σ_k Δt Π_i width_i(t_k), eq. (2) of the paper.
    pub volume: f64,
}

impl Costs {
    /// The costs of no set.
    pub(crate) const NONE: Self = Self { cost: 0.0, of_samples: 0.0, paper: None, volume: 0.0 };

    /// The costs if a set was lost.
    pub(crate) const LOST: Self =
        Self { cost: f64::INFINITY, of_samples: f64::INFINITY, paper: None, volume: f64::INFINITY };
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
