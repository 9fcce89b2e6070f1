//! Results on standard output, diagnostics on standard error.

use std::io::Write;

use serde::Serialize;

/// Prints a result; a reader that has seen enough and closed the pipe is no error.
pub fn print(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// Prints a result as JSON.
pub fn print_json(value: &impl Serialize) {
    let text = serde_json::to_string_pretty(value).expect("results have string keys");
    print(&(text + "\n"));
}

/// Prints notes for the user.
pub fn notes(notes: &[String]) {
    for note in notes {
        eprintln!("note: {note}");
    }
}
