//! What the readers of both file formats share: topics, messages, and damage.

use std::fmt;
use std::path::Path;

use serde::Serialize;

use crate::error::{Error, Result};
use crate::message::{JOINT_STATE, MarkerKind, SECOND};

/// A topic of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Topic {
    /// Its name.
    pub(crate) name: String,
    /// Name of the type of its messages.
    pub(crate) kind: String,
    /// Name of their encoding, such as `cdr`.
    pub(crate) encoding: String,
}

/// The topics that are read, by the role of their messages.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wanted<'a> {
    /// Topics of joint states.
    pub(crate) joints: &'a [String],
    /// Topic of the markers of runs.
    pub(crate) marker: Option<&'a str>,
}

/// What the messages of a topic are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Joint states; the number of the topic in [`Wanted::joints`].
    Joints(usize),
    /// Markers of runs.
    Marker(MarkerKind),
}

impl Wanted<'_> {
    /// Returns the role of a topic, `None` where it is not read.
    ///
    /// # Errors
    ///
    /// [`Error::TopicType`] where the topic is read but has messages of another type.
    pub(crate) fn role(&self, path: &Path, topic: &Topic) -> Result<Option<Role>> {
        let (role, expected) = if self.marker == Some(topic.name.as_str()) {
            (MarkerKind::of(&topic.kind).map(Role::Marker), MarkerKind::NAMES)
        } else if let Some(index) = self.joints.iter().position(|name| *name == topic.name) {
            ((topic.kind == JOINT_STATE).then_some(Role::Joints(index)), JOINT_STATE)
        } else {
            return Ok(None);
        };
        match role {
            Some(role) if topic.encoding == "cdr" => Ok(Some(role)),
            _ => Err(Error::TopicType {
                path: path.into(),
                topic: topic.name.clone(),
                found: format!("{} in the encoding {}", topic.kind, topic.encoding),
                expected,
            }),
        }
    }

    /// Returns the names of all topics that are read.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().map(String::as_str).chain(self.marker)
    }
}

/// A message as a log holds it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RawMessage<'a> {
    /// What it is for.
    pub(crate) role: Role,
    /// Time at which the log received it, ns.
    pub(crate) log_time: i64,
    /// The message, with its encapsulation header.
    pub(crate) data: &'a [u8],
}

/// Takes the messages one by one. A message that cannot be decoded gives a clause about it.
pub(crate) type Receive<'a> = dyn FnMut(RawMessage<'_>) -> Result<(), String> + 'a;

/// A part of a log that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Loss {
    /// Path of the file.
    pub file: String,
    /// Offset in the file at which the part starts, bytes, where it is known.
    pub offset: Option<u64>,
    /// What is wrong there.
    pub problem: String,
    /// Number of bytes that are not used, where it is known.
    pub bytes: Option<u64>,
    /// Number of messages of the topics asked for that are known to be lost; more may be.
    pub messages: u64,
    /// Times at which the log received the first and the last message of the part, where they are
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

    /// Counts a lost message and its time.
    pub(crate) fn count(&mut self, log_time: i64) {
        self.messages += 1;
        let [first, last] = self.received.unwrap_or([log_time; 2]);
        self.received = Some([first.min(log_time), last.max(log_time)]);
    }

    /// Returns file, place and problem.
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

/// Returns nanoseconds as seconds with all nine decimals.
pub(crate) fn decimal(nanoseconds: i64) -> String {
    let sign = if nanoseconds < 0 { "-" } else { "" };
    let size = nanoseconds.unsigned_abs();
    let second = SECOND.unsigned_abs();
    format!("{sign}{}.{:09}", size / second, size % second)
}

/// What a file holds besides the messages that were passed on.
#[derive(Debug, Default)]
pub(crate) struct Contents {
    /// All topics.
    pub(crate) topics: Vec<Topic>,
    /// Notes for the user.
    pub(crate) notes: Vec<String>,
    /// The parts that could not be read.
    pub(crate) losses: Vec<Loss>,
}

/// Collects damage, or stops at the first.
#[derive(Debug)]
pub(crate) struct Damage {
    recover: bool,
    pub(crate) losses: Vec<Loss>,
}

impl Damage {
    /// Returns an empty collection; damage is an error unless `recover`.
    pub(crate) fn new(recover: bool) -> Self {
        Self { recover, losses: vec![] }
    }

    /// Adds a part that could not be read.
    ///
    /// # Errors
    ///
    /// [`Error::Damaged`] unless parts may be lost.
    pub(crate) fn add(&mut self, loss: Loss) -> Result<()> {
        if !self.recover {
            return Err(Error::Damaged(loss));
        }
        self.losses.push(loss);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{Loss, decimal};
    use std::path::Path;

    #[test]
    fn times_keep_their_digits() {
        let cases = [(0, "0.000000000"), (-1, "-0.000000001"), (1_500_000_002, "1.500000002")];
        cases.iter().for_each(|(time, text)| assert_eq!(decimal(*time), *text));
        assert_eq!(decimal(i64::MIN), "-9223372036.854775808");
    }

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
