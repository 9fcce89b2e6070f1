//! Parts of a log that could not be read.

use std::fmt;
use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use crate::seconds::decimal;

/// A part of a log that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Loss {
    /// Path of the file.
    pub file: String,
    /// Offset in the file at which the part starts, bytes, if it is known.
    pub offset: Option<u64>,
    /// The problem.
    pub problem: String,
    /// Number of bytes that are not used, if it is known.
    pub bytes: Option<u64>,
    /// Number of messages of the requested topics that are known to be lost; more may be.
    pub messages: u64,
    /// Times at which the log received the first and the last message of the part, if they are
    /// known, ns since 1970.
    pub received: Option<[i64; 2]>,
}

impl Loss {
    pub(crate) fn new(file: &Path, offset: Option<u64>, problem: impl Into<String>) -> Self {
        Self {
            file: file.display().to_string(),
            offset,
            problem: problem.into(),
            bytes: None,
            messages: 0,
            received: None,
        }
    }

    pub(crate) fn count(&mut self, log_time: i64) {
        self.messages += 1;
        let [first, last] = self.received.unwrap_or([log_time; 2]);
        self.received = Some([first.min(log_time), last.max(log_time)]);
    }

    pub(crate) fn place(&self) -> String {
        let at = self.offset.map_or_else(String::new, |offset| format!(": byte {offset}"));
        format!("{}{at}: {}", self.file, self.problem)
    }
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; lost: ", self.place())?;
        match self.bytes {
            Some(0) => return write!(f, "no message"),
            Some(bytes) => write!(f, "{bytes} bytes with ")?,
            None => {}
        }
        match self.messages {
            0 => write!(f, "an unknown number of messages")?,
            count => write!(f, "{count} messages or more of the topics read")?,
        }
        match self.received {
            Some([first, last]) if first == last => write!(f, ", received at {} s", decimal(first)),
            Some([first, last]) => {
                write!(f, ", received from {} s to {} s", decimal(first), decimal(last))
            }
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_says_where_and_how_much() {
        let mut loss = Loss::new(Path::new("a.mcap"), Some(7), "the file ends");
        assert!(loss.to_string().ends_with("the file ends; lost: an unknown number of messages"));
        loss.bytes = Some(12);
        loss.count(3_000_000_000);
        loss.count(1_000_000_000);
        let expected = "a.mcap: byte 7: the file ends; lost: 12 bytes with 2 messages or more of \
                        the topics read, received from 1.000000000 s to 3.000000000 s";
        assert_eq!(loss.to_string(), expected);
        loss.bytes = Some(0);
        assert!(loss.to_string().ends_with("lost: no message"));
    }
}
