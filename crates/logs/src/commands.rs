//! Commanded and actual positions of a log, as text with columns.

use std::cell::RefCell;
use std::io::Write as _;
use std::path::Path;

use reachtube_recordings::{LogSettings, LogTime, is_commanded};

use crate::align::{Place, median_step};
use crate::container::{Contents, Role, Topic, WantedTopics, names_of};
use crate::error::{Error, Result};
use crate::files::{files_of, scan};
use crate::log::LogOptions;
use crate::named_series::{AllSeries, NamedSeries};

/// The commanded and actual positions of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Commands {
    /// Comma-separated columns: the time in ns, and for each joint the commanded and the actual
    /// position, rad or m. [`parse_logged`](reachtube_recordings::parse_logged) reads them.
    pub text: Vec<u8>,
    /// Notes for the user: which topics were taken, and what was left out.
    pub notes: Vec<String>,
}

/// Reads the commanded and actual positions of a log: an MCAP file, a .db3 file of rosbag2, or a
/// folder with the parts of one bag.
///
/// They are in one topic of `control_msgs/msg/JointTrajectoryControllerState`, or in two topics of
/// `sensor_msgs/msg/JointState`, of which the name of one speaks of commands. Samples of two topics
/// are joined at the stamps of the one with the longer steps, with the other straight between its
/// samples. Only topics count that name all of `joints`. If a log has several, the settings name
/// topics or joints.
///
/// # Errors
///
/// - [`Error::File`] and [`Error::Format`] if there is no file that can be read, [`Error::Damaged`]
///   if a part of it cannot.
/// - [`Error::NoTopic`], [`Error::TopicType`], [`Error::NoCommands`], [`Error::SeveralTopics`],
///   [`Error::ZeroStamps`] and [`Error::Setting`] if the topics do not fit the settings.
pub fn read_commands(path: &Path, settings: &LogSettings, joints: &[String]) -> Result<Commands> {
    if settings.marker.is_some() {
        return Err(Error::Setting(
            "--marker cuts logs with torques into runs; leave it out for commands".into(),
        ));
    }
    // The robot may have other names than the log.
    let (joints, names) = match joints {
        [] => (settings.joints.clone(), &settings.joints[..]),
        names => (LogOptions::new(settings, names)?.joints, names),
    };
    let mut logged = PositionLog::read(path, settings)?;
    logged.all.series.retain(|of| joints.iter().all(|joint| of.names.contains(joint)));
    let (mut log, mut notes) = logged.chosen(path)?;
    let series = &mut log.series;
    if settings.time == LogTime::Header
        && series.iter().any(|of| of.times.iter().all(|t| t[0] == 0))
    {
        return Err(Error::ZeroStamps { path: path.into(), topic: log.topics.join(", ") });
    }
    series.iter_mut().for_each(NamedSeries::sort);
    let (text, left_out) = log.text(&joints, names);
    notes.push(format!("commanded and actual positions come from {}", log.topics.join(", ")));
    let counted = [
        (logged.all.incomplete, "messages have no position for each of their joints"),
        (left_out, "samples have no commanded or no actual position within half a step"),
    ];
    let counted = counted.into_iter().filter(|(count, _)| *count > 0);
    notes.extend(counted.map(|(count, what)| format!("{count} {what}, and are not used")));
    let named = |note: String| format!("{}: {note}", path.display());
    Ok(Commands { text, notes: notes.into_iter().map(named).collect() })
}

/// What was read of a log.
struct PositionLog {
    all: AllSeries,
    /// Topics that were met with positions.
    topics: Vec<String>,
    available: Vec<Topic>,
    notes: Vec<String>,
    /// Whether topics were named.
    is_named: bool,
}

/// The series with commanded and actual positions: one that has both, or first the commands.
struct ChosenSeries {
    series: Vec<NamedSeries>,
    topics: Vec<String>,
}

impl PositionLog {
    fn read(path: &Path, settings: &LogSettings) -> Result<Self> {
        let found = RefCell::new(vec![]);
        let wanted = WantedTopics {
            joints: &settings.topic,
            found: &found,
            marker: None,
            controllers: true,
        };
        let receipt = settings.time == LogTime::Receipt;
        let mut logged = Self {
            all: AllSeries::default(),
            topics: vec![],
            available: vec![],
            notes: vec![],
            is_named: !settings.topic.is_empty(),
        };
        for file in files_of(path)? {
            let Contents { topics, notes, .. } =
                scan(&file, wanted, false, &mut |message| match message.role {
                    Role::Joints(topic) => logged.all.add(message, (topic, false), receipt),
                    Role::Controller(topic) => logged.all.add(message, (topic, true), receipt),
                    Role::Marker(_) => Ok(()),
                })?;
            logged.available.extend(topics);
            logged.notes.extend(notes);
        }
        for name in wanted.names() {
            if !logged.available.iter().any(|topic| topic.name == name) {
                let available = names_of(&logged.available);
                return Err(Error::NoTopic { path: path.into(), topic: name.into(), available });
            }
        }
        logged.topics = if logged.is_named { settings.topic.clone() } else { found.into_inner() };
        Ok(logged)
    }

    /// Returns the series of commanded and actual positions, and notes of the reading.
    fn chosen(&mut self, path: &Path) -> Result<(ChosenSeries, Vec<String>)> {
        let (both, single): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.all.series).into_iter().partition(|of| of.has_commands);
        let of_topic = |of: &NamedSeries| self.topics[of.topic].clone();
        let several = |all: &[NamedSeries]| Error::SeveralTopics {
            path: path.into(),
            topics: all.iter().map(of_topic).collect(),
        };
        let notes = std::mem::take(&mut self.notes);
        if let [_] = both[..] {
            let topics = both.iter().map(of_topic).collect();
            return Ok((ChosenSeries { series: both, topics }, notes));
        } else if !both.is_empty() {
            return Err(several(&both));
        }
        let speaks_of_commands = single.iter().any(|of| is_commanded(&self.topics[of.topic]));
        let is_command = |of: &NamedSeries| match speaks_of_commands {
            true => is_commanded(&self.topics[of.topic]),
            // The second one of two named topics.
            false => self.is_named && of.topic == 1,
        };
        let (commands, states): (Vec<_>, Vec<_>) = single.into_iter().partition(is_command);
        let pairs = commands.iter().flat_map(|command| states.iter().map(move |of| (command, of)));
        let shares = |(command, state): &(&NamedSeries, &NamedSeries)| {
            command.names.iter().any(|name| state.names.contains(name))
        };
        let pairs: Vec<_> = pairs.filter(shares).collect();
        match pairs[..] {
            [(command, state)] => {
                let series = vec![command.clone(), state.clone()];
                let topics = series.iter().map(of_topic).collect();
                Ok((ChosenSeries { series, topics }, notes))
            }
            [] => Err(Error::NoCommands {
                path: path.into(),
                problem: match states.is_empty() {
                    true => "no topic has actual positions of the joints".into(),
                    false => "no topic has commanded positions of the joints".into(),
                },
                available: names_of(&self.available),
            }),
            _ => Err(several(&[commands, states].concat())),
        }
    }
}

impl ChosenSeries {
    /// Returns the columns of some joints, or of all, as text with other names, and the number of
    /// samples that have no partner.
    fn text(&self, joints: &[String], called: &[String]) -> (Vec<u8>, usize) {
        let last = self.series.last().expect("there are one or two");
        let is_in_all =
            |name: &&String| self.series.iter().all(|series| series.names.contains(*name));
        let names: Vec<String> = match joints {
            [] => last.names.iter().filter(is_in_all).cloned().collect(),
            joints => joints.to_vec(),
        };
        let called = if called.is_empty() { &names[..] } else { called };
        // Actual positions count where both have the same steps.
        let step = |of: &&NamedSeries| median_step(&of.stamps()).unwrap_or_default();
        let stamps = self.series.iter().max_by_key(step).unwrap_or(last).stamps();
        let columns: Vec<Vec<usize>> = self.series.iter().map(|of| of.columns(&names)).collect();
        let places: Vec<Vec<Place>> = self.series.iter().map(|of| of.places(&stamps)).collect();
        let mut text = b"t [ns]".to_vec();
        for kind in ["commanded", "actual"] {
            for name in called {
                let plain = name.replace([',', ';', '\t', '"', '\n', '\r'], " ");
                // Writing to memory does not fail.
                let _ = write!(text, ",{kind}_position {plain} [rad]");
            }
        }
        text.push(b'\n');
        let mut left_out = 0;
        for (k, stamp) in stamps.iter().enumerate() {
            if places.iter().any(|of| of[k] == Place::None) {
                left_out += 1;
                continue;
            }
            let _ = write!(text, "{stamp}");
            for (number, series) in self.series.iter().enumerate() {
                for column in &columns[number] {
                    let _ = write!(text, ",{}", series.value(places[number][k], *column));
                }
            }
            text.push(b'\n');
        }
        (text, left_out)
    }
}
