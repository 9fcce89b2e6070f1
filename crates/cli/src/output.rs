//! Results on standard output, notes on standard error. Both have colours on a terminal, unless
//! `NO_COLOR` is set.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anstyle::{AnsiColor, Style};
use reachtube::finding::printable;
use reachtube::write;
use reachtube_files::ErrorKind;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{Error, Result};
use crate::folded::folded;
use crate::global::global;
use crate::outcome::Outcome;

/// Largest number of notes that one command prints.
const MOST_NOTES: usize = 20;

/// Prints a result as text. A reader that closes the pipe early is not an error.
pub(crate) fn print(text: &str) -> Result<()> {
    write_out(printable(text).as_bytes())
}

/// Prints an answer, with its verdict (the first line up to the colon) in the colour of the
/// outcome.
pub(crate) fn print_verdict(text: &str, outcome: &Outcome) -> Result<()> {
    let colour = match outcome {
        Outcome::Done => AnsiColor::Green,
        Outcome::NotConformant | Outcome::Unsafe => AnsiColor::Red,
        Outcome::Vacuous | Outcome::Undecided => AnsiColor::Yellow,
    };
    let text = printable(text);
    let (verdict, rest) = text.split_at(text.find([':', '\n']).unwrap_or(0));
    let coloured = format!("{}{rest}", painted(verdict, colour));
    // The stream drops the colours unless it is a terminal.
    written(anstream::stdout().lock(), coloured.as_bytes())
}

fn painted(word: &str, colour: AnsiColor) -> String {
    let style = Style::new().bold().fg_color(Some(colour.into()));
    format!("{style}{word}{style:#}")
}

pub(crate) fn write_out(bytes: &[u8]) -> Result<()> {
    written(std::io::stdout().lock(), bytes)
}

fn written(mut out: impl Write, bytes: &[u8]) -> Result<()> {
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Error::output(error)),
        _ => Ok(()),
    }
}

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

/// Writes the files of a result, after none is in the way. A file that is there already to the byte
/// stays.
pub(crate) fn write_all<'a>(files: impl Iterator<Item = (&'a PathBuf, &'a [u8])>) -> Result<()> {
    let is_new =
        |(path, bytes): &(&PathBuf, &[u8])| std::fs::read(path).ok().as_deref() != Some(*bytes);
    let new: Vec<_> = files.filter(is_new).collect();
    claim_all(new.iter().map(|(path, _)| *path))?;
    for (path, bytes) in new {
        write::atomically(path, |out| out.write_all(bytes))?;
    }
    Ok(())
}

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

pub(crate) fn warn(text: &str) {
    line("warning", text);
}

/// Prints an error on standard error, each of its lines marked as one.
pub(crate) fn error(text: &str) {
    text.lines().for_each(|text| line("error", text));
}

/// An error, as the last line of standard error with --json.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ErrorOutput<'a> {
    /// The message that is printed without --json; one line for each defect.
    pub error: &'a str,
    /// What the error is about.
    pub kind: ErrorKind,
    /// The exit code.
    pub exit_code: u8,
}

/// Prints an error as one line of JSON on standard error.
pub(crate) fn json_error(error: &ErrorOutput<'_>) {
    let object = serde_json::to_string(error).expect("an error has string keys");
    let _ = writeln!(std::io::stderr(), "{object}");
}

fn line(kind: &str, text: &str) {
    let kind = match kind {
        "warning" => painted(kind, AnsiColor::Yellow),
        "error" => painted(kind, AnsiColor::Red),
        kind => kind.into(),
    };
    let _ = writeln!(anstream::stderr(), "{kind}: {}", printable(text));
}

/// Prints the first notes of a list, and the number of the others. Notes that repeat for each file
/// are one line. With `--verbose`, all are printed.
pub(crate) fn notes(notes: &[String]) {
    if global().verbose {
        return notes.iter().for_each(|text| note(text));
    }
    let notes = folded(notes);
    notes.iter().take(MOST_NOTES).for_each(|text| note(text));
    if notes.len() > MOST_NOTES {
        note(&format!("{} more notes; --verbose prints all", notes.len() - MOST_NOTES));
    }
}

/// Prints warnings. Warnings that repeat for each file are one line; with `--verbose`, all are
/// printed.
pub(crate) fn warnings(warnings: &[String]) {
    if global().verbose {
        return warnings.iter().for_each(|text| warn(text));
    }
    folded(warnings).iter().for_each(|text| warn(text));
}
