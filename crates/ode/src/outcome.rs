/// How an integration ended. A solution that leaves every bound in finite time is an answer, not an
/// error.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// At the end of the time asked for.
    Reached,
    /// Before it.
    Diverged {
        /// The last time \[s\] at which the state is known to be good.
        time: f64,
        /// What stopped the integration there.
        cause: Cause,
    },
}

/// What stops an integration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// An entry of the state is NaN or beyond the bound on |x|.
    Bound,
    /// No step that time can resolve meets the tolerance: the solution or its rate has a pole, or
    /// the rate is NaN.
    StepSize,
    /// The limit of steps was met: the field is stiff, or it chatters across a discontinuity.
    StepCount,
}

impl Outcome {
    /// Whether the end was reached.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        *self == Self::Reached
    }
}

/// Whether each |x| is at most `bound`; NaN is not.
pub(crate) fn is_within(x: &[f64], bound: f64) -> bool {
    x.iter().all(|x| x.abs() <= bound)
}
