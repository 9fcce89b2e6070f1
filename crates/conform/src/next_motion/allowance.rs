//! How much wider sets have to be for motions that they were not found on.

use std::collections::BTreeMap;

use crate::data::problem::Problem;
use crate::program::dot::dot;
use crate::program::program::Program;
use crate::program::reached::Reached;
use crate::sets::UncertaintySets;

/// Rows of recordings that lie beyond the reach of sets, by block, sample and state: by how much,
/// and what each radius of X0 and U adds to the reach.
pub(crate) type Missing = BTreeMap<(usize, usize, usize), (f64, Vec<f64>)>;

impl Program<'_> {
    pub(crate) fn missing(&self, sets: &UncertaintySets, missing: &mut Missing) {
        let unknowns = self.unknowns(sets);
        for row in self.all_reached(&unknowns) {
            if self.is_missed(&row) {
                let Reached { index: (block, k, i, _), excess, .. } = row;
                let gains = || (0.0, self.row(block, k, i).1.iter().collect());
                let own = missing.entry((block, k, i)).or_insert_with(gains);
                own.0 = own.0.max(excess);
            }
        }
    }
}

/// Growth of the sets for motions that are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct AllowanceNeeded {
    /// Radii that may be added to X0 and U, 3n. The radii of U are in proportion to the error
    /// of the input, and the radii of X0 to X0; these are 0 where the noise of the sensors limits
    /// X0.
    pub shape: Vec<f64>,
    /// The factor of `shape`, for each motion, with which the sets of the others enclose it: 0 if
    /// they do without. `None` if no factor suffices.
    pub factors: Vec<Option<f64>>,
}

impl AllowanceNeeded {
    /// Compares what motions miss with the input that the robot does not explain, n: there motions
    /// differ.
    pub(crate) fn new(
        problem: &Problem,
        sets: &UncertaintySets,
        input_error: &[f64],
        missing: &[Missing],
    ) -> Self {
        let starts = match problem.settings().nominal.is_measured() {
            true => vec![0.0; sets.initial_set.dimension()],
            false => sets.initial_set.radius.clone(),
        };
        let shape = [&starts[..], input_error].concat();
        let factors = missing.iter().map(|missing| factor_for(missing, &shape)).collect();
        Self { shape, factors }
    }
}

/// Returns the factor of `shape`, 3n, with which wider sets cover all rows that are missing; `None`
/// if none suffices.
pub(crate) fn factor_for(missing: &Missing, shape: &[f64]) -> Option<f64> {
    let needed = |(excess, gains): &(f64, Vec<f64>)| excess / dot(gains, shape);
    let factor = missing.values().map(needed).fold(0.0, f64::max);
    factor.is_finite().then_some(factor)
}
