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
    /// The factors of `shape`, for each motion, with which the sets of the others enclose it: the
    /// factor of its radii of X0, which first samples need, and then the factor of its radii of U;
    /// 0 if they do without. `None` if no factors suffice.
    pub factors: Vec<Option<[f64; 2]>>,
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
        let states = starts.len();
        let factors = missing.iter().map(|missing| factors_for(missing, &shape, states)).collect();
        Self { shape, factors }
    }
}

/// Returns the factors of a shape that rows need which are missed, the radii of X0 first, `states`
/// of them: of X0 for rows of first samples, where U has no effect yet, and then of U for all other
/// rows. `None` if no factors suffice.
pub(crate) fn factors_for(missing: &Missing, shape: &[f64], states: usize) -> Option<[f64; 2]> {
    let (of_start, of_input) = shape.split_at(states);
    let rows = |is_first: bool| {
        let own = missing.iter().filter(move |((_, k, _), _)| (*k == 0) == is_first);
        own.map(|(_, (excess, gains))| (excess, gains.split_at(states)))
    };
    let needed = |(excess, (gains, _)): (&f64, (&[f64], &[f64]))| excess / dot(gains, of_start);
    let initial = rows(true).map(needed).fold(0.0, f64::max);
    let needed = |(excess, (gains, of_rest)): (&f64, (&[f64], &[f64]))| {
        let rest = excess - initial * dot(gains, of_start);
        if rest > 0.0 { rest / dot(of_rest, of_input) } else { 0.0 }
    };
    let input = rows(false).map(needed).fold(0.0, f64::max);
    (initial.is_finite() && input.is_finite()).then_some([initial, input])
}
