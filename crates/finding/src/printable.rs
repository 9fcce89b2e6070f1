/// Largest number of columns of a line.
pub(crate) const COLUMNS: usize = 100;

/// Returns text in which control characters are written as escapes, except the ends of lines. Names
/// in files can hold codes that would move the cursor of a terminal or change its colours.
///
/// # Examples
///
/// ```
/// assert_eq!(reachtube_finding::printable("arm\u{1b}[2J"), "arm\\u{1b}[2J");
/// ```
#[must_use]
pub fn printable(text: &str) -> String {
    let escaped = |c: char| match c {
        '\n' => c.to_string(),
        c if c.is_control() => format!("\\u{{{:x}}}", u32::from(c)),
        c => c.to_string(),
    };
    if text.chars().any(|c| c.is_control() && c != '\n') {
        text.chars().map(escaped).collect()
    } else {
        text.into()
    }
}

#[cfg(test)]
mod tests {
    use super::printable;

    #[test]
    fn control_characters_are_escaped() {
        assert_eq!(printable("q̇ ± 1\n"), "q̇ ± 1\n");
        assert_eq!(printable("\u{1b}[2Jarm\r\u{9b}m"), "\\u{1b}[2Jarm\\u{d}\\u{9b}m");
    }
}
