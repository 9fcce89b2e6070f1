//! A sample of a log, and its possible defects.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

use reachtube_recordings::{Defect, DefectKind};

/// A quantity of a joint state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum JointQuantity {
    Position,
    Velocity,
    Effort,
}

impl JointQuantity {
    /// All quantities in the order of messages and of recordings.
    pub(crate) const ALL: [Self; 3] = [Self::Position, Self::Velocity, Self::Effort];

    fn name(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Effort => "effort",
        }
    }
}

/// The problem with a sample. Joints count from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum MessageFault {
    /// The message does not name the joint.
    Missing { joint: usize },
    /// The message names the joint twice.
    Repeated { joint: usize },
    /// The message has no values of the quantity.
    Empty { quantity: JointQuantity },
    /// The message has another number of values than of names.
    Length { quantity: JointQuantity, values: usize, names: usize },
    /// The value is not a finite number.
    NotFinite { quantity: JointQuantity, joint: usize, value: f64 },
    /// Several topics have the value.
    Twice { quantity: JointQuantity, joint: usize },
    /// No topic has the value.
    Absent { quantity: JointQuantity, joint: usize },
    /// A topic has no message with this stamp; its number among the topics.
    Alone { topic: usize },
}

impl MessageFault {
    fn joint(self) -> Option<usize> {
        match self {
            Self::Missing { joint }
            | Self::Repeated { joint }
            | Self::NotFinite { joint, .. }
            | Self::Twice { joint, .. }
            | Self::Absent { joint, .. } => Some(joint),
            Self::Empty { .. } | Self::Length { .. } | Self::Alone { .. } => None,
        }
    }

    fn quantity(self) -> Option<JointQuantity> {
        match self {
            Self::Empty { quantity }
            | Self::Length { quantity, .. }
            | Self::NotFinite { quantity, .. }
            | Self::Twice { quantity, .. }
            | Self::Absent { quantity, .. } => Some(quantity),
            Self::Missing { .. } | Self::Repeated { .. } | Self::Alone { .. } => None,
        }
    }

    /// Returns the problem of a message, and what to do.
    fn words(self, labels: &Labels<'_>) -> (String, &'static str) {
        let joint = self.joint().map_or("", |joint| &labels.joints[joint]);
        let what = self.quantity().map_or("", JointQuantity::name);
        match self {
            Self::Missing { .. } => (
                format!("it does not name the joint {joint}"),
                "record all joints of the robot in every message, or give the log's names in the \
                 robot's order with --joints",
            ),
            Self::Repeated { .. } => {
                (format!("it names the joint {joint} twice"), "record every joint once")
            }
            Self::Empty { .. } => (
                format!("its {what} is empty"),
                "let the driver publish it (ros2_control: the state interface of that name), or \
                 name a topic that has it too",
            ),
            Self::Length { values, names, .. } => (
                format!("its {what} has {values} values for {names} names"),
                "record one value for each name",
            ),
            Self::NotFinite { value, .. } => (
                format!("the {what} of {joint} is {value}, not a finite number"),
                "every value must be a number: cut the run before this message, or record again",
            ),
            Self::Twice { .. } => (
                format!("several topics have the {what} of {joint} at its stamp"),
                "name only topics that complement each other",
            ),
            Self::Absent { .. } => (
                format!("no topic has the {what} of {joint} at its stamp"),
                "name a topic that has it too",
            ),
            Self::Alone { topic } => (
                format!("{} has no message with its stamp", labels.topics[topic]),
                "record the topics with stamps that differ by at most half a sample, or use one \
                 topic",
            ),
        }
    }
}

/// A sample of a log.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    /// Its time, ns.
    pub(crate) time: i64,
    /// Time at which the log received the message, ns.
    pub(crate) received: i64,
    /// Number of its topic among the topics of joint states.
    pub(crate) topic: usize,
    /// Number of the message in its topic, from 1.
    pub(crate) message: u64,
    /// The problem.
    pub(crate) problems: Box<[MessageFault]>,
}

/// Names for messages to the user.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Labels<'a> {
    /// The log.
    pub(crate) log: &'a Path,
    /// The topics of joint states.
    pub(crate) topics: &'a [String],
    /// The robot's joints.
    pub(crate) joints: &'a [String],
}

/// Returns the defects of the samples in `range`: the first of each kind, quantity and joint, with
/// the number of messages that have it too.
pub(crate) fn defects(samples: &[Sample], range: Range<usize>, labels: &Labels<'_>) -> Vec<Defect> {
    let mut found: Vec<(Defect, usize)> = vec![];
    let mut known = HashMap::new();
    let mut add = |key, defect: &dyn Fn() -> Defect| {
        let place = *known.entry(key).or_insert_with(|| {
            found.push((defect(), 0));
            found.len() - 1
        });
        found[place].1 += 1;
    };
    for index in range.clone() {
        let sample = &samples[index];
        let defect = |problem: &str, remedy: &str| {
            let topic = &labels.topics[sample.topic];
            let problem = format!("message {} of {topic}: {problem}", sample.message);
            Defect::new(labels.log, None, problem, remedy)
        };
        for problem in &sample.problems {
            let (kind, joint) = (std::mem::discriminant(problem), problem.joint());
            add((Some(kind), joint, problem.quantity()), &|| {
                let (words, remedy) = problem.words(labels);
                let joint = joint.map(|joint| joint + 1);
                defect(&words, remedy).of_kind(DefectKind::Value).of_joint(joint)
            });
        }
        let before = samples[range.start..index].last();
        if let Some(before) = before.filter(|before| before.time >= sample.time) {
            add((None, None, None), &|| time_defect(before, sample, &defect));
        }
    }
    let counted = |(mut defect, count): (Defect, usize)| {
        if count > 1 {
            defect.problem += &format!(" (and {} more messages likewise)", count - 1);
        }
        defect
    };
    found.into_iter().map(counted).collect()
}

/// Returns the defect of a sample that is not later than the one before it.
fn time_defect(before: &Sample, sample: &Sample, defect: &dyn Fn(&str, &str) -> Defect) -> Defect {
    let what = if before.time == sample.time {
        "the time of the message before"
    } else {
        "earlier than the message before"
    };
    let problem = format!("t = {} s is {what}", crate::seconds::decimal(sample.time));
    let remedy = "times must increase strictly: cut the run before this message, or record again \
                  with one publisher and one clock";
    defect(&problem, remedy).of_kind(DefectKind::Time)
}
