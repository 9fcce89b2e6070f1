use glob::Pattern;

/// Returns the names that `pattern` selects, in their order: the name itself, or else the names
/// that it matches. In a pattern, `*` stands for any text and `?` for one character.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::matching;
///
/// let names = ["A1", "A2", "B1", "B*"];
/// assert_eq!(matching("A?", names), ["A1", "A2"]);
/// assert_eq!(matching("*1", names), ["A1", "B1"]);
/// // A name is never a pattern.
/// assert_eq!(matching("B*", names), ["B*"]);
/// ```
#[must_use]
pub fn matching<'a>(pattern: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let names: Vec<&str> = names.into_iter().collect();
    if let Some(name) = names.iter().find(|name| **name == pattern) {
        return vec![name];
    }
    let Some(pattern) = compiled(pattern) else { return Vec::new() };
    names.into_iter().filter(|name| pattern.matches(name)).collect()
}

/// Returns a pattern with `*` and `?` only: brackets and repeated stars have no meaning of their
/// own.
fn compiled(pattern: &str) -> Option<Pattern> {
    if !pattern.contains(['*', '?']) {
        return None;
    }
    let mut plain = String::new();
    for c in pattern.chars() {
        match c {
            '[' => plain.push_str("[[]"),
            '*' if plain.ends_with('*') => {}
            c => plain.push(c),
        }
    }
    Pattern::new(&plain).ok()
}

#[cfg(test)]
mod tests {
    use super::matching;

    #[test]
    fn only_stars_and_question_marks_are_special() {
        let names = ["A[1]", "A1", "a/b", "Ä"];
        assert_eq!(matching("A[1]", names), ["A[1]"]);
        assert_eq!(matching("A[*", names), ["A[1]"]);
        assert_eq!(matching("***", names), names);
        assert_eq!(matching("?", names), ["Ä"]);
        assert_eq!(matching("a*b", names), ["a/b"]);
        assert!(matching("B", names).is_empty() && matching("A", names).is_empty());
    }
}
