//! Results on standard output, diagnostics on standard error.

use std::io::{ErrorKind, Write};

use serde::Serialize;

use crate::error::{Error, Result};

/// Notes that are printed.
const MOST_NOTES: usize = 20;

/// Prints a result; a reader that has seen enough and closed the pipe is no error.
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

/// Prints a note for the user; with standard error closed there is nobody to tell.
pub fn note(text: &str) {
    let _ = writeln!(std::io::stderr(), "note: {text}");
}

/// Prints notes for the user; of very many of them the first and a count.
pub fn notes(notes: &[String]) {
    notes.iter().take(MOST_NOTES).for_each(|text| note(text));
    if notes.len() > MOST_NOTES {
        note(&format!("and {} more notes; inspect --json lists all", notes.len() - MOST_NOTES));
    }
}
