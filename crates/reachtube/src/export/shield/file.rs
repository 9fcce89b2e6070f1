//! A file of the shield.

use reachtube_files::MARK;

/// A file of the shield that is to be changed.
#[derive(Debug, Clone)]
pub struct ShieldFile {
    /// Its name, which the changed file keeps.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// Puts a comment above a file, in place of one that stood there from an earlier export.
pub(super) fn marked(about: &str, text: &str) -> String {
    let earlier = text.starts_with(&format!("# {MARK}"));
    let rest = match text.split_once("\n\n") {
        Some((_, rest)) if earlier => rest,
        _ => text,
    };
    format!("{about}\n{rest}")
}
