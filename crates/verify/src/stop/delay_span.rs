//! Whether the span of the brakes' delay is what leaves stops open.

use std::fmt;

use crate::error::Result;
use crate::stop::along::{WorstStop, proved};
use crate::stop::brakes::Brakes;

/// The span of the brakes' delay, within which they may hold or not.
pub(super) struct DelaySpan {
    /// The earliest and the latest delay, s.
    delay: [f64; 2],
    /// Number of samples from which a standstill is proved for the latest delay alone, and is not
    /// for the span.
    pub with_one_delay: usize,
}

impl DelaySpan {
    /// Makes the span of `brakes`. Where a stop is open, all are tried anew by `along`, with
    /// brakes of the latest delay alone.
    ///
    /// # Errors
    ///
    /// As `along`.
    pub(super) fn new(
        stops: &[WorstStop],
        brakes: &Brakes,
        along: impl Fn(&Brakes) -> Result<Vec<WorstStop>>,
    ) -> Result<Self> {
        let ([samples, before], [earliest, latest]) = (proved(stops), brakes.delay);
        let with_one_delay = if before < samples && earliest < latest {
            let one = Brakes { delay: [latest; 2], ..brakes.clone() };
            proved(&along(&one)?)[1].saturating_sub(before)
        } else {
            0
        };
        Ok(Self { delay: brakes.delay, with_one_delay })
    }
}

impl fmt::Display for DelaySpan {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (Self { with_one_delay: count, .. }, [earliest, latest]) = (self, self.delay);
        write!(
            f,
            "with `delay = [{latest}, {latest}]` one is proved from {count} of them: give `delay` \
             a shorter span than {earliest} to {latest} s"
        )
    }
}
