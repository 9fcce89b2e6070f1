//! Places in a text file, and pieces of it, as messages name them.

/// Longest piece of a file that an error quotes, characters.
const QUOTED: usize = 40;

/// The line, from 1, on which a record starts; the reader's position may be that of blank lines
/// above it.
pub(super) fn line_of(bytes: &[u8], position: Option<&csv::Position>) -> u64 {
    let Some(position) = position else { return 1 };
    let ahead = bytes.get(position.byte() as usize..).unwrap_or_default();
    let blank = ahead.iter().take_while(|byte| matches!(byte, b'\n' | b'\r'));
    position.line() + blank.filter(|byte| **byte == b'\n').count() as u64
}

/// A piece of a file, cut short and without control characters.
pub(super) fn quoted(text: &str) -> String {
    let short: String = text.chars().take(QUOTED).collect();
    let dots = if short.len() < text.len() { "..." } else { "" };
    format!("{short:?}{dots}")
}
