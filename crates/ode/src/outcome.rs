/// The outcome of an integration.
///
/// A solution that leaves every bound in finite time is an outcome, not an error.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The integration reached the end of the requested time.
    Reached,
    /// The integration stopped before the end of the requested time.
    Diverged {
        /// The last time \[s\] with a valid state.
        time: f64,
        /// The reason.
        cause: Cause,
    },
}

/// The reason why an integration stopped early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// An entry of the state is NaN or beyond the bound on |x|.
    Bound,
    /// No step above the resolution of time meets the tolerance. The solution or its rate has a
    /// pole, or the rate is NaN.
    StepSize,
    /// The integration reached its step limit. The field is stiff, or it chatters across a
    /// discontinuity.
    StepCount,
}

impl Outcome {
    /// Returns whether the integration reached the end.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        *self == Self::Reached
    }
}

/// Returns whether each |x| is at most `bound`; false for NaN.
pub(crate) fn is_within(x: &[f64], bound: f64) -> bool {
    x.iter().all(|x| x.abs() <= bound)
}
