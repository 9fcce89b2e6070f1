//! How much wider the sets have to be for motions that were held out of every choice.

use crate::check::Check;

impl Check {
    /// Returns the factor by which the radii of X0 and U would have to grow so that the sets
    /// enclose all recordings of the check, 1 if they do; `None` if no factor suffices.
    #[must_use]
    pub fn factor_of_sets(&self) -> Option<f64> {
        match &self.growth {
            None if self.verdict.conformant => Some(1.0),
            None => None,
            Some(growth) => growth.both_sets,
        }
    }
}
