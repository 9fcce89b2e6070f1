//! The repair of the solver's answer: sets that satisfy every row up to rounding.

use crate::linear::program::{Program, ROUNDING, RowIndex, dot};
use crate::sets::UncertaintySets;

impl Program<'_> {
    /// Returns the cost of the sets once they satisfy every row.
    pub(super) fn repaired_cost(&self, sets: &UncertaintySets) -> f64 {
        self.cost(&self.repaired(sets))
    }

    /// Returns the sets with radii that are larger, so that every row holds up to rounding: all by
    /// the worst ratio, or each by a term of the same cost, whichever costs less. The solver meets
    /// a row to a part of the largest row, so a small one may miss most of its reach.
    #[must_use]
    pub fn repaired(&self, sets: &UncertaintySets) -> UncertaintySets {
        let scaled = sets.inflated(self.worst_ratio(sets), 0.0);
        let widened = self.widened(sets);
        if self.cost(&widened) < self.cost(&scaled) { widened } else { scaled }
    }

    /// The sets with radii that are larger by terms of the same cost, so that every row holds.
    fn widened(&self, sets: &UncertaintySets) -> UncertaintySets {
        let unknowns = self.unknowns(sets);
        let largest = self.cost.iter().copied().fold(0.0, f64::max);
        let terms: Vec<f64> =
            self.cost.iter().map(|w| if *w > 0.0 { largest / w } else { 0.0 }).collect();
        let needed = |index: RowIndex| {
            let gain = dot(self.row(index.0, index.1, index.2).1, &terms);
            let excess = self.excess(index, &unknowns);
            if excess > ROUNDING * self.scale { excess / gain } else { 0.0 }
        };
        let factor = self.indices(1).map(needed).fold(0.0, f64::max);
        let mut widened = sets.clone();
        let UncertaintySets { initial_set, input_set, .. } = &mut widened;
        let radii = initial_set.radius.iter_mut().chain(&mut input_set.radius);
        radii.zip(&terms).for_each(|(radius, term)| *radius += factor * term);
        widened
    }

    /// The factor by which the radii must grow so that every row holds, at least 1: the largest
    /// ratio of what a row needs to what the radii give it.
    fn worst_ratio(&self, sets: &UncertaintySets) -> f64 {
        let unknowns = self.unknowns(sets);
        let ratio = |index: RowIndex| {
            let (b, k, i, _) = index;
            let given = dot(self.row(b, k, i).1, &unknowns.radius);
            if given > ROUNDING * self.scale {
                1.0 + self.excess(index, &unknowns) / given
            } else {
                1.0
            }
        };
        self.indices(1).map(ratio).fold(1.0, f64::max)
    }
}
