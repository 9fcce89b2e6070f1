//! Positions in a text file and quotations from it, for messages.

/// Length of the longest quotation from a file, characters.
const QUOTED: usize = 40;

/// Returns the line, from 1, on which a record starts. The reader's position may be the number of a
/// blank line above it.
pub(crate) fn line_of(bytes: &[u8], position: Option<&csv::Position>) -> u64 {
    let Some(position) = position else { return 1 };
    let ahead = bytes.get(position.byte() as usize..).unwrap_or_default();
    let blank = ahead.iter().take_while(|byte| matches!(byte, b'\n' | b'\r'));
    position.line() + blank.filter(|byte| **byte == b'\n').count() as u64
}

/// Returns a piece of a file in quotes, cut short and with control characters escaped.
pub(crate) fn quoted(text: &str) -> String {
    let short: String = text.chars().take(QUOTED).collect();
    let dots = if short.len() < text.len() { "..." } else { "" };
    format!("{short:?}{dots}")
}
