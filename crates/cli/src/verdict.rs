//! Sentences that several commands print about a model.

use reachtube::conform::{Lost, Notion};

/// Reports where a reachable set ended before its suite.
pub fn lost(lost: &Lost) -> String {
    format!(
        "{}: the reachable set could not be computed beyond {:.3} s, where {} grew fastest; later \
         samples are not enclosed (--until {:.3} uses only the samples before)",
        lost.case, lost.time, lost.state, lost.time
    )
}

/// Says in which directions recorded points must lie in the reachable set.
pub fn notion_words(notion: Notion) -> &'static str {
    match notion {
        Notion::Hull => "each state by itself",
        Notion::PhasePlane => "position and velocity of each joint together",
        Notion::Exact => "all states together",
    }
}
