//! Conditions on recordings beyond the rows.

use crate::claim::look::Look;
use crate::error::Result;
use crate::sets::UncertaintySets;
use crate::tube::judged::{Along, At};
use crate::tube::plant::Plant;
use crate::tube::tube::Tube;

/// Conditions on recordings beyond the rows.
pub(crate) trait Claim: Sync {
    /// Computes the reachable sets of `plant` under `sets`, and what was found about the recordings
    /// in them.
    ///
    /// # Guarantee
    ///
    /// Under [`Look::Proof`], each point that is not among the unproved ones lies in the exact
    /// reachable set of a linear model, and in the computed outer set of any other.
    ///
    /// # Errors
    ///
    /// As [`Plant::tube`].
    fn judge(&self, plant: &dyn Plant, sets: &UncertaintySets, look: &Look) -> Result<Tube>;

    /// Returns the recorded point that is furthest along each direction, of all at its sample,
    /// which must have a point.
    fn furthest(&self, directions: &[(At, Vec<f64>)]) -> Vec<Along>;

    /// Returns the part by which sets may have to grow for a point before a search continues;
    /// `None` if only the rows are claimed.
    fn tolerance(&self) -> Option<f64>;
}

/// The rows alone: the notion hull.
pub(crate) struct Rows;

impl Claim for Rows {
    fn judge(&self, plant: &dyn Plant, sets: &UncertaintySets, _: &Look) -> Result<Tube> {
        Ok(plant.tube(sets, None)?.0)
    }

    fn furthest(&self, _: &[(At, Vec<f64>)]) -> Vec<Along> {
        Vec::new()
    }

    fn tolerance(&self) -> Option<f64> {
        None
    }
}
