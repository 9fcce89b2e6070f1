//! Results on standard output, notes on standard error.

use std::io::{ErrorKind, Write};
use std::path::Path;

use serde::Serialize;

use crate::error::{Error, Result};

/// Largest number of notes that one command prints.
const MOST_NOTES: usize = 20;

/// Prints a result. A reader that closes the pipe early is not an error.
pub fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::Output(error)),
        _ => Ok(()),
    }
}

/// Prints a result as JSON.
pub fn print_json(value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value).expect("results have string keys");
    print(&(text + "\n"))
}

/// Prints a result as JSON or as text.
pub fn show(json: bool, value: &impl Serialize, text: impl FnOnce() -> String) -> Result<()> {
    if json { print_json(value) } else { print(&text()) }
}

/// Reports a file that was written.
pub fn wrote(path: &Path) {
    note(&format!("wrote {}", path.display()));
}

/// Prints a note on standard error. A closed standard error is ignored: nobody reads it.
pub fn note(text: &str) {
    let _ = writeln!(std::io::stderr(), "note: {text}");
}

/// Prints a warning on standard error.
pub fn warn(text: &str) {
    let _ = writeln!(std::io::stderr(), "warning: {text}");
}

/// Prints the first notes of a list, and the number of the others.
pub fn notes(notes: &[String]) {
    notes.iter().take(MOST_NOTES).for_each(|text| note(text));
    if notes.len() > MOST_NOTES {
        let more = notes.len() - MOST_NOTES;
        note(&format!("{more} more notes; reachtube inspect --json lists all"));
    }
}
