//! The joint states of one topic, with values in the order of the robot's joints.

use std::collections::BTreeSet;

use crate::container::RawMessage;
use crate::message::JointState;
use crate::sample::{JointQuantity, MessageFault, Sample};

/// Where a message names a joint of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum JointPlace {
    At(usize),
    Missing,
    Repeated,
}

/// The joint states of one topic.
#[derive(Debug, Default)]
pub(crate) struct TopicStates {
    /// Number of the topic among the topics of joint states.
    pub(crate) topic: usize,
    /// The samples, in the order of the log.
    pub(crate) samples: Vec<Sample>,
    /// Positions, velocities and efforts of all joints, row-major K x 3n; NaN if a message has no
    /// finite value.
    pub(crate) values: Vec<f64>,
    /// Number of messages, used or not.
    pub(crate) messages: u64,
    /// Number of messages that name no joint of the robot.
    pub(crate) foreign: u64,
    /// Names that are no joints of the robot, in messages that are used or not.
    pub(crate) unused: BTreeSet<String>,
    /// Number of times that the order of the names changed.
    pub(crate) changes: usize,
    /// Place of each joint in the first message that is used, from 1.
    pub(crate) first_places: Vec<Option<usize>>,
    names: Vec<String>,
    places: Vec<JointPlace>,
}

impl TopicStates {
    pub(crate) fn new(topic: usize) -> Self {
        Self { topic, ..Self::default() }
    }

    /// Adds a message. Its time comes from the header, or is the time of its receipt.
    ///
    /// # Errors
    ///
    /// A clause about a message that is no joint state.
    pub(crate) fn add(
        &mut self,
        message: RawMessage<'_>,
        joints: &[String],
        receipt: bool,
    ) -> Result<(), String> {
        self.messages += 1;
        let state = JointState::decode(message.data)?;
        if self.places.is_empty() || !state.names.iter().eq(self.names.iter()) {
            self.arrange(&state.names, joints);
        }
        if self.places.iter().all(|place| *place == JointPlace::Missing) {
            self.foreign += 1;
            return Ok(());
        }
        if self.first_places.is_empty() {
            let number = |place: &JointPlace| match place {
                JointPlace::At(index) => Some(index + 1),
                _ => None,
            };
            self.first_places = self.places.iter().map(number).collect();
        }
        let problems = self.values_of(&state);
        self.samples.push(Sample {
            time: if receipt { message.log_time } else { state.stamp },
            received: message.log_time,
            topic: self.topic,
            message: self.messages,
            problems: problems.into(),
        });
        Ok(())
    }

    /// Finds the robot's joints among the names of a message.
    fn arrange(&mut self, names: &[&str], joints: &[String]) {
        let place = |joint: &String| {
            let mut places = names.iter().enumerate().filter(|(_, name)| *name == joint);
            match (places.next(), places.next()) {
                (Some((index, _)), None) => JointPlace::At(index),
                (None, _) => JointPlace::Missing,
                _ => JointPlace::Repeated,
            }
        };
        let places: Vec<JointPlace> = joints.iter().map(place).collect();
        let used = |places: &[JointPlace]| places.iter().any(|place| *place != JointPlace::Missing);
        if used(&places) && used(&self.places) && places != self.places {
            self.changes += 1;
        }
        let unused = names.iter().filter(|name| !joints.iter().any(|joint| joint == *name));
        // A hostile log cannot fill the memory with names.
        let room = MOST_UNUSED.saturating_sub(self.unused.len());
        self.unused.extend(unused.take(room).map(|name| (*name).to_string()));
        self.names = names.iter().map(|name| (*name).to_string()).collect();
        self.places = places;
    }

    /// Adds the values of a message in the robot's order, and returns what is wrong with them.
    fn values_of(&mut self, state: &JointState<'_>) -> Vec<MessageFault> {
        let mut problems = vec![];
        for (joint, place) in self.places.iter().enumerate() {
            match place {
                JointPlace::At(_) => {}
                JointPlace::Missing => problems.push(MessageFault::Missing { joint }),
                JointPlace::Repeated => problems.push(MessageFault::Repeated { joint }),
            }
        }
        let names = state.names.len();
        for (quantity, given) in JointQuantity::ALL.into_iter().zip(state.values) {
            match given.len() {
                0 => problems.push(MessageFault::Empty { quantity }),
                values if values != names => {
                    problems.push(MessageFault::Length { quantity, values, names });
                }
                _ => {}
            }
            let sound = given.len() == names;
            for (joint, place) in self.places.iter().enumerate() {
                let value = match place {
                    JointPlace::At(index) if sound => given.get(*index),
                    _ => None,
                };
                if let Some(value) = value.filter(|value| !value.is_finite()) {
                    problems.push(MessageFault::NotFinite { quantity, joint, value });
                }
                self.values.push(value.filter(|value| value.is_finite()).unwrap_or(f64::NAN));
            }
        }
        problems
    }
}

/// Number of names that are no joints of the robot after which further ones are not kept.
const MOST_UNUSED: usize = 100;
