//! The interface between the flowpipe and the methods that propagate a set.

use reachtube_scalar::Interval;

use crate::sets::zonotope::Zonotope;

/// A reachable set that a method propagates from step to step.
pub(crate) trait SetPropagator {
    /// Propagates the set over a step of length h (s), under any input in `u` (m).
    fn advance(&mut self, h: Interval, u: &[Interval]) -> Result<(), StepFailure>;

    /// Appends a box of all states over the last step to `out`, N intervals.
    fn tube(&self, out: &mut Vec<Interval>);

    /// Appends the interval hull of the set to `out`, N intervals.
    fn hull(&self, out: &mut Vec<Interval>);

    /// Returns a copy of the set as a zonotope.
    fn zonotope(&self) -> Zonotope;
}

/// A step without a verified enclosure.
#[derive(Debug)]
pub(crate) struct StepFailure {
    /// State whose tube grew the most.
    pub state: usize,
    /// Widths of the last tube, N entries.
    pub widths: Vec<f64>,
}
