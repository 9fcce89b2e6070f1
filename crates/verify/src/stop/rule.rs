use crate::stop::brakes::Brakes;
use crate::stop::category::Category;

/// Rule for the stop in a scenario: its category, brakes and trigger.
#[derive(Debug, Clone, PartialEq)]
pub struct StopRule {
    /// The brakes.
    pub brakes: Brakes,
    /// The stop category.
    pub category: Category,
    /// The stop begins at the first sample at which the capsule of a link is at most this far from
    /// an obstacle that concerns it, m; `None` if it may begin at any sample.
    pub distance: Option<f64>,
}
