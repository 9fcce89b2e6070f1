//! Words that several findings share.

use crate::data::settings::Notion;

/// Returns a list as people write it.
pub(crate) fn listed(all: &[String]) -> String {
    all.join(", ")
}

/// Returns which states must lie in the reachable set together.
pub(crate) fn notion_words(notion: Notion) -> &'static str {
    match notion {
        Notion::Hull => "each state by itself",
        Notion::PhasePlane => "position and velocity of each joint together",
        Notion::Exact | Notion::Trace => "all states together",
    }
}
