//! Words that several findings share.

use crate::data::settings::Notion;

/// Returns the word in the number that `count` asks for.
pub(crate) fn plural(count: usize, word: &str) -> String {
    format!("{word}{}", if count == 1 { "" } else { "s" })
}

/// Returns a number with its word.
pub(crate) fn counted(count: usize, word: &str) -> String {
    format!("{count} {}", plural(count, word))
}

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
