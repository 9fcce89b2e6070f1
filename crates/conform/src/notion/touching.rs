//! The recorded points that decide the sets.

use std::collections::HashSet;

use crate::data::problem::Problem;
use crate::found::TOUCHING;
use crate::linear::program::Program;
use crate::notion::ask::PointOutside;
use crate::notion::smallest_sets::Added;
use crate::notion::sweep::Sweep;
use crate::notion::verdict::PointWitness;
use crate::sets::UncertaintySets;
use crate::verdict::Witness;

impl Sweep<'_> {
    /// Returns the points that touch the boundary of the reachable set in the direction of a cut,
    /// the closest first, each once, under the state that counts most in the direction.
    pub(super) fn touching(
        &self,
        problem: &Problem,
        program: &Program,
        sets: &UncertaintySets,
        cuts: &[Added],
    ) -> Vec<Witness> {
        let mut seen = HashSet::new();
        let mut touching = Vec::new();
        for (added, cut) in cuts.iter().zip(&program.cuts) {
            let point = &added.furthest.point;
            let (from_centre, reach) = program.reach(cut, sets);
            let ratio = from_centre / reach;
            if ratio < 1.0 - TOUCHING || !seen.insert((added.at, point.owner)) {
                continue;
            }
            let touch =
                PointOutside { point: point.clone(), direction: added.direction.clone(), ratio };
            let witness = PointWitness::of_sweep(problem, self, sets, added.at, &touch);
            touching.push(witness.into_witness());
        }
        touching.sort_by(|a, b| (b.excess / b.radius).total_cmp(&(a.excess / a.radius)));
        touching
    }
}
