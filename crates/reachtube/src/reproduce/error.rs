//! Errors of what is reproduced.

/// The reason why a table of the paper could not be reproduced.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReproduceError {
    /// There is nothing to simulate.
    #[error("Table I: no motions or no orders to simulate; give at least 1 of each")]
    NothingToSimulate,
    /// There is no campaign to simulate.
    #[error("coverage: no campaigns to simulate; give at least 1")]
    NoCampaigns,
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
}
