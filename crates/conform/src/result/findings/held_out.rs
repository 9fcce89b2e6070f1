//! Findings about the next motion from motions that were held out of every choice.

use reachtube_scalar::number::{counted, two_digits_up};

use crate::check::Check;

/// Fewer motions bound nothing that is worth a sentence.
const FEWEST: usize = 2;

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

    /// Returns what follows for the next motion, in a few words, if the recordings of the check are
    /// `motions` whole motions that took part in no choice; `None` if motions are held out in part.
    ///
    /// The factor of the radii of X0 and U that a motion needs is its gauge. If the motions are
    /// exchangeable, the next one has a larger gauge than all n held-out ones with probability at
    /// most 1/(n + 1), on average over the draw of all n + 1 (docs/method.md, section 9).
    #[must_use]
    pub fn next_motion_in_brief(&self, motions: Option<usize>) -> String {
        let motions = match motions {
            None => return "no guarantee: no whole motion was held out".into(),
            Some(few) if few < FEWEST => {
                return format!("no guarantee: {} held out is too few", counted(few, "motion"));
            }
            Some(motions) => motions,
        };
        let (of, held_out) = (motions + 1, counted(motions, "motion"));
        match self.factor_of_sets() {
            None => "no guarantee: no factor makes the sets enclose what was held out".into(),
            Some(factor) if factor <= 1.0 => {
                format!("at most 1 in {of} leaves the sets ({held_out} held out of every choice)")
            }
            Some(factor) => format!(
                "at most 1 in {of} leaves X0 and U times {} ({held_out} held out of every choice)",
                two_digits_up(factor)
            ),
        }
    }
}
