//! The sums of the paper over the reachable set of some sets.

use crate::program::program::{Program, dot};
use crate::sets::UncertaintySets;

impl Program<'_> {
    /// Returns two sums over the interval hull of the reachable set in the units of the paper:
    /// Σ_k Σ_i (E_k (y1 - y2))_i of eq. (21), and Σ_k Δt Π_i 2 (R_k r)_i of eq. (2).
    #[must_use]
    pub(crate) fn paper_sums(&self, sets: &UncertaintySets) -> (f64, f64) {
        let unknowns = self.unknowns(sets);
        let (mut signed, mut volume) = (0.0, 0.0);
        for (b, shares) in self.shares.iter().enumerate() {
            let times = &self.blocks[b].times;
            for (k, share) in shares.iter().enumerate() {
                let rows = (0..self.shape.states).map(|i| self.row(b, k, i));
                let edges = rows.clone().map(|(centre, _)| 2.0 * dot(centre, &unknowns.radius));
                signed += share * edges.sum::<f64>();
                let product: f64 =
                    rows.map(|(_, radius)| 2.0 * dot(radius, &unknowns.radius)).product();
                volume += share * product * (times.get(k + 1).unwrap_or(&times[k]) - times[k]);
            }
        }
        (signed, volume)
    }
}
