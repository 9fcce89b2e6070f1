//! Lines of standard input, as they come.

use std::io::BufRead;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use reachtube_files::ErrorKind;

use crate::error::{Error, Result};
use crate::output;

/// Lines that may wait to be judged.
const WAITING: usize = 1024;

/// How samples end that no interrupt ends.
pub(super) const END_OF_INPUT: &str = "end of input";

/// What comes from outside.
enum Message {
    Line(std::io::Result<String>),
    /// The user asked for the end.
    Interrupt,
}

/// Takes each line with its number as it comes, but empty ones, and returns how they ended.
pub(super) fn follow(mut take: impl FnMut(u64, &str) -> Result<()>) -> Result<&'static str> {
    let mut number = 0;
    for message in listen() {
        let line = match message {
            Message::Interrupt => return Ok("interrupt"),
            Message::Line(Ok(line)) => line,
            Message::Line(Err(error)) => {
                return match error.kind() {
                    std::io::ErrorKind::UnexpectedEof => Ok(END_OF_INPUT),
                    _ => Err(wrong(number + 1, &error.to_string())),
                };
            }
        };
        number += 1;
        if !line.trim().is_empty() {
            take(number, &line)?;
        }
    }
    Ok(END_OF_INPUT)
}

/// Reads lines in a thread of their own, so that an interrupt is noticed while none comes.
fn listen() -> Receiver<Message> {
    let (lines, messages) = sync_channel(WAITING);
    let interrupts = lines.clone();
    // Without a handler, an interrupt ends the command without a summary.
    if ctrlc::set_handler(move || drop(interrupts.send(Message::Interrupt))).is_err() {
        output::note("Ctrl-C ends the command without a summary");
    }
    std::thread::spawn(move || read(&lines));
    messages
}

fn read(lines: &SyncSender<Message>) {
    for line in std::io::stdin().lock().lines() {
        if lines.send(Message::Line(line)).is_err() {
            return;
        }
    }
    // An empty error marks the end of the input.
    let end = std::io::Error::from(std::io::ErrorKind::UnexpectedEof);
    let _ = lines.send(Message::Line(Err(end)));
}

/// Returns an error of a line.
pub(super) fn wrong(line: u64, problem: &str) -> Error {
    Error::Given(ErrorKind::Recordings, format!("standard input:{line}: {problem}"))
}
