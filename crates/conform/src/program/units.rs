//! The units of the program's unknowns, in which the solver sees them.

use crate::program::layout::Layout;
use crate::program::program::Program;
use crate::sets::UncertaintySets;

/// An unknown that contributes less than this part to the cost gets the unit that would.
const NEGLIGIBLE_PART: f64 = 1e-7;

impl Program<'_> {
    /// The unit of each unknown: such that all cost the same, or about its value in the sets
    /// `near`, where an earlier solution is known, but never more than its limit. With units of the
    /// first kind the solver may miss what small unknowns do to small rows; with the second, every
    /// row that decides has terms of about its own size.
    pub(crate) fn units(&self, layout: &Layout, near: Option<&UncertaintySets>) -> Vec<f64> {
        let largest = layout.cost.iter().copied().fold(0.0, f64::max);
        let cheapest = |sets: &UncertaintySets| {
            let cost = self.cost_in_steps(sets).max(self.negligible_in_steps());
            NEGLIGIBLE_PART * cost / self.scale
        };
        let unit = |(j, w): (usize, &f64)| {
            let unit = match near {
                None => largest / w,
                Some(sets) => (layout.value(sets, j) / self.scale).max(cheapest(sets) / w),
            };
            unit.min(layout.limit_of(&self.limits, j) / self.scale)
        };
        layout.cost.iter().enumerate().map(unit).collect()
    }
}
