//! Results on standard output, notes on standard error.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use reachtube::printable;
use serde::Serialize;

use crate::error::{Error, Result};
use crate::global::global;

/// Largest number of notes that one command prints.
const MOST_NOTES: usize = 20;

/// Prints a result as text. A reader that closes the pipe early is not an error.
pub(crate) fn print(text: &str) -> Result<()> {
    write_out(printable(text).as_bytes())
}

/// Writes bytes to standard output.
pub(crate) fn write_out(bytes: &[u8]) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::Output(error)),
        _ => Ok(()),
    }
}

/// Prints a result as JSON.
pub(crate) fn print_json(value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value).expect("results have string keys");
    print_json_text(&(text + "\n"))
}

/// Prints text that is JSON already. JSON escapes control characters itself, except for codes from
/// U+007F to U+009F, which terminals obey too.
pub(crate) fn print_json_text(text: &str) -> Result<()> {
    let escaped = |c: char| match c {
        '\u{7f}'..='\u{9f}' => format!("\\u{:04x}", u32::from(c)),
        c => c.to_string(),
    };
    if text.chars().any(|c| ('\u{7f}'..='\u{9f}').contains(&c)) {
        write_out(text.chars().map(escaped).collect::<String>().as_bytes())
    } else {
        write_out(text.as_bytes())
    }
}

/// Prints a result as JSON or as text.
pub(crate) fn show(
    json: bool,
    value: &impl Serialize,
    text: impl FnOnce() -> String,
) -> Result<()> {
    if json { print_json(value) } else { print(&text()) }
}

/// Checks, before a long job, that a file can be written at `path` and that none is lost by it.
/// Every file that a command writes passes here or through [`claim_all`].
pub(crate) fn claim(path: &Path) -> Result<()> {
    Ok(global().overwrite().check(path)?)
}

/// Claims all files of a result before the first of them is written.
pub(crate) fn claim_all<'a>(paths: impl IntoIterator<Item = &'a PathBuf>) -> Result<()> {
    paths.into_iter().try_for_each(|path| claim(path))
}

/// Reports a file that was written.
pub(crate) fn wrote(path: &Path) {
    note(&format!("wrote {}", path.display()));
}

/// Prints a note on standard error. A closed standard error is ignored.
pub(crate) fn note(text: &str) {
    if !global().quiet {
        line("note", text);
    }
}

/// Prints a note that only `--verbose` asks for.
pub(crate) fn detail(text: &str) {
    if global().verbose {
        line("note", text);
    }
}

/// Prints a warning on standard error.
pub(crate) fn warn(text: &str) {
    line("warning", text);
}

/// Prints an error on standard error, each of its lines marked as one.
pub(crate) fn error(text: &str) {
    text.lines().for_each(|text| line("error", text));
}

/// Prints an error as one line of JSON on standard error.
pub(crate) fn json_error(error: &str, kind: &str, exit_code: u8) {
    let object = serde_json::json!({ "error": error, "kind": kind, "exit_code": exit_code });
    let _ = writeln!(std::io::stderr(), "{object}");
}

fn line(kind: &str, text: &str) {
    let _ = writeln!(std::io::stderr(), "{kind}: {}", printable(text));
}

/// Prints the first notes of a list, and the number of the others; all notes with `--verbose`.
pub(crate) fn notes(notes: &[String]) {
    let most = if global().verbose { notes.len() } else { MOST_NOTES };
    notes.iter().take(most).for_each(|text| note(text));
    if notes.len() > most {
        note(&format!("{} more notes; --verbose prints all", notes.len() - most));
    }
}
