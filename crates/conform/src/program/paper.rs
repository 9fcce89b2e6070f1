//! The sums of the paper over the reachable set of some sets.

use crate::program::costs::distinct_shares;
use crate::program::dot::dot;
use crate::program::program::Program;
use crate::sets::UncertaintySets;

/// Sums over the interval hull of the reachable set in the units of the paper.
pub(crate) struct PaperSums {
    /// The cost as a sum over distinct sample times, each of which counts 1: (21) with |E|.
    pub of_samples: f64,
    /// Σ_k Σ_i (E_k (y1 - y2))_i, eq. (21).
    pub signed: f64,
    pub volume: f64,
}

impl Program<'_> {
    pub(crate) fn paper_sums(&self, sets: &UncertaintySets) -> PaperSums {
        let unknowns = self.unknowns(sets);
        let shares = distinct_shares(self.blocks.iter().map(|block| &*block.times));
        let mut sums = PaperSums { of_samples: 0.0, signed: 0.0, volume: 0.0 };
        for (b, (shares, parts)) in shares.iter().zip(&*self.parts).enumerate() {
            for (k, (share, part)) in shares.iter().zip(parts).enumerate() {
                let rows = || (0..self.shape.outputs).map(|i| self.row(b, k, i));
                let edges = rows().map(|(centre, _)| 2.0 * dot(centre, unknowns.radius_of(b)));
                sums.signed += share * edges.sum::<f64>();
                let radii = || rows().map(|(_, radius)| radius.dot(&unknowns.radius));
                let widths = radii()
                    .enumerate()
                    .map(|(i, radius)| 2.0 * self.weights[i] * (radius + sets.noise_radius(i)));
                sums.of_samples += share * widths.sum::<f64>();
                // Eq. (2) has one summand for each step.
                let time = if k + 1 < parts.len() { part * self.step } else { 0.0 };
                sums.volume += time * radii().map(|radius| 2.0 * radius).product::<f64>();
            }
        }
        sums
    }
}
