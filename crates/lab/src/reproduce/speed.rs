//! The two speeds of Table I.

use serde::Serialize;

/// The speed of the robot along its paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Speed {
    /// Each joint peaks at a third of its speed limit: 0.4 rad/s for the LWA 4P.
    Slow,
    /// Each joint peaks at its speed limit: 1.2 rad/s for the LWA 4P.
    Fast,
}

impl Speed {
    /// Both speeds.
    pub const ALL: [Self; 2] = [Self::Slow, Self::Fast];

    /// Returns the duration of a motion over its duration at full speed.
    pub(super) fn slowness(self) -> f64 {
        match self {
            Self::Slow => 3.0,
            Self::Fast => 1.0,
        }
    }

    /// Returns `slow` or `fast`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Slow => "slow",
            Self::Fast => "fast",
        }
    }
}
