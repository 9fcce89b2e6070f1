//! What the readers of both file formats share: topics, messages, and damage.

use std::cell::RefCell;
use std::path::Path;

use crate::error::{Error, Result};
use crate::loss::Loss;
use crate::message::{CONTROLLER_STATE, JOINT_STATE, MarkerKind};

/// A file of a log.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LogFile<'a> {
    /// Its path, for messages.
    pub(crate) path: &'a Path,
    /// The file to open: the same one, or what was decompressed of it.
    pub(crate) content: &'a Path,
}

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

/// Returns the names of topics, with their types.
pub(crate) fn names_of(topics: &[Topic]) -> Vec<String> {
    let named = |topic: &Topic| format!("{} ({})", topic.name, topic.kind);
    let mut names: Vec<String> = topics.iter().map(named).collect();
    names.sort();
    names.dedup();
    names
}

/// The topics that are read, by the role of their messages.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WantedTopics<'a> {
    /// Topics of joint states; empty for every topic of joint states.
    pub(crate) joints: &'a [String],
    /// The topics of joint states that were met if none is named.
    pub(crate) found: &'a RefCell<Vec<String>>,
    /// Topic of the markers of runs.
    pub(crate) marker: Option<&'a str>,
    /// Whether states of controllers are read as well.
    pub(crate) controllers: bool,
}

/// The role of a topic's messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Joint states; the number of the topic in [`WantedTopics::joints`], or else in
    /// [`WantedTopics::found`].
    Joints(usize),
    /// States of a controller; the number of the topic likewise.
    Controller(usize),
    /// Markers of runs.
    Marker(MarkerKind),
}

impl WantedTopics<'_> {
    /// Returns the role of a topic, `None` if it is not read.
    ///
    /// # Errors
    ///
    /// [`Error::TopicType`] where the topic is read but has messages of another type.
    pub(crate) fn role(&self, path: &Path, topic: &Topic) -> Result<Option<Role>> {
        let is_controller = self.controllers && topic.kind == CONTROLLER_STATE;
        let is_read = is_controller || topic.kind == JOINT_STATE;
        let is_any = self.joints.is_empty() && is_read;
        let of = |index| if is_controller { Role::Controller(index) } else { Role::Joints(index) };
        let (role, expected) = if self.marker == Some(topic.name.as_str()) {
            (MarkerKind::of(&topic.kind).map(Role::Marker), MarkerKind::NAMES)
        } else if is_any && topic.encoding == "cdr" {
            (Some(of(self.number_of(&topic.name))), JOINT_STATE)
        } else if let Some(index) = self.joints.iter().position(|name| *name == topic.name) {
            (is_read.then(|| of(index)), JOINT_STATE)
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

    /// Returns the number of a topic among the topics that were met.
    fn number_of(&self, name: &str) -> usize {
        let mut found = self.found.borrow_mut();
        found.iter().position(|known| known == name).unwrap_or_else(|| {
            found.push(name.into());
            found.len() - 1
        })
    }

    /// Returns the names of all topics that have to be there.
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

/// Contents of a file besides the messages that were passed on.
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
