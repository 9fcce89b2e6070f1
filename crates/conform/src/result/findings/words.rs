//! Words that several findings share.

/// Returns a list as people write it.
pub(crate) fn listed(all: &[String]) -> String {
    all.join(", ")
}
