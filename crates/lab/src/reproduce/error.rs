//! Errors of what is reproduced.

use std::path::PathBuf;

/// The reason why a table of the paper could not be reproduced.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReproduceError {
    /// There is nothing to simulate.
    #[error("Table I: no motions or no orders to simulate; give at least 1 of each")]
    NothingToSimulate,
    /// There is no campaign or no further motion to simulate.
    #[error("coverage: no campaigns or no further motions to simulate; give at least 1 of each")]
    NoCampaigns,
    /// The campaign is one of another robot.
    #[error(
        "{}: the campaign's robot is {robot}, but Table III belongs to the LWA 4P; record it with \
         --robot lwa4p",
        folder.display()
    )]
    OtherRobot {
        /// The folder.
        folder: PathBuf,
        /// The robot's name.
        robot: String,
    },
    /// A joint cannot move within the range.
    #[error(
        "joint `{joint}` cannot move within {range} rad of the expansion point 0: its limits are \
         {limits:?} rad; choose a wider range"
    )]
    NoRange {
        /// The joint's name.
        joint: String,
        /// Largest distance from the expansion point \[rad\].
        range: f64,
        /// The joint's position limits \[rad\].
        limits: [f64; 2],
    },
    /// There is no suite to draw.
    #[error("there is no suite with two samples or more to draw")]
    NoSuite,
    /// A campaign has no suite of this name.
    #[error("the campaign has no suite {suite}; its runs.csv names the suites")]
    UnknownSuite {
        /// The suite.
        suite: String,
    },
}
