//! Healthy motion, from which the numbers that faults change get their ranges.

use crate::monitor::statistics::{Range, Shape};

/// Room beyond the ranges that the scored recordings need.
const MARGIN: f64 = 1.5;

/// What numbers that faults change are in healthy motion.
///
/// Every other recording, from the first on, shapes the ranges: the speed from which on a part is
/// judged, the ripple of its torque, and the range of each number. The others scale the ranges of
/// sudden torques by the largest factor that one of them needs, and likewise the ranges of drags
/// and the payload. All grow by a margin of 1.5.
#[derive(Debug, Clone, PartialEq)]
pub struct HealthyMotion {
    pub(crate) shape: Shape,
    /// The ranges of the recordings that shape; `None` if a number was never known.
    pub(crate) ranges: Vec<Option<Range>>,
    /// The largest factors that a scored recording needs, at least 1: for sudden torques, and for
    /// drags and the payload.
    pub(crate) factors: [f64; 2],
    /// Number of scored recordings.
    pub(crate) scored: usize,
}

impl HealthyMotion {
    /// Returns the bound of the probability that one more healthy recording raises an alarm.
    ///
    /// # Guarantee
    ///
    /// 2/(n + 1) for the n recordings that scale the ranges by two factors, on average over the
    /// draw of these and of the next one, if they are exchangeable: their order does not matter.
    /// The margin beyond that is not proved.
    #[must_use]
    pub fn bound(&self) -> f64 {
        (2.0 / (self.scored as f64 + 1.0)).min(1.0)
    }

    /// Returns the least and the largest value without an alarm: of sudden torques of the parts
    /// \[N m\], then of their drags \[N m\], then of the payload \[kg\]; `None` if the recordings
    /// move a part too little. 2n + 1.
    #[must_use]
    pub fn ranges(&self) -> Vec<Option<[f64; 2]>> {
        let parts = self.ranges.len() / 2;
        let widened = |(index, range): (usize, &Option<Range>)| {
            let [low, high] = (*range)?;
            let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
            let half = MARGIN * self.factors[usize::from(index >= parts)] * half;
            Some([centre - half, centre + half])
        };
        self.ranges.iter().enumerate().map(widened).collect()
    }
}
