//! The file that marks a folder as a campaign.

/// The file that marks the folder of a campaign and holds its options.
pub(super) const MARK: &str = "campaign.json";
