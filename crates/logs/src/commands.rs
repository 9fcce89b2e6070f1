//! Commanded and actual positions of a log, as text with columns.

use std::cell::RefCell;
use std::io::Write as _;
use std::path::Path;

use reachtube_recordings::{ColumnSettings, LogSettings, LogTime, Wanted, is_commanded};

use crate::align::{Place, median_step};
use crate::container::{Contents, Role, Topic, WantedTopics, names_of};
use crate::error::{Error, Result};
use crate::files::{files_of, scan};
use crate::log::LogOptions;
use crate::named_series::{AllSeries, NamedSeries};

/// The commanded and actual positions of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Commands {
    /// The names of the joints in the log.
    pub joints: Vec<String>,
    /// Comma-separated columns: the time, and for each joint, by its number from 0, the commanded
    /// and the actual position, which a plan does not have.
    /// [`parse_logged`](reachtube_recordings::parse_logged) reads them.
    pub text: Vec<u8>,
    /// The units of the columns: ns, and rad or m.
    pub columns: ColumnSettings,
    /// Notes for the user: which topics were taken, and what was left out.
    pub notes: Vec<String>,
}

/// Reads the commanded and actual positions of a log: an MCAP file, a .db3 file of rosbag2, or a
/// folder with the parts of one bag.
///
/// They are in one topic of `control_msgs/msg/JointTrajectoryControllerState`, or in two topics of
/// `sensor_msgs/msg/JointState`, of which the name of one contains a word for commands. Samples of
/// two topics are joined at the stamps of the one with the longer steps; the other is interpolated
/// linearly. [`Wanted::Plan`] reads the commands alone, at their own stamps. Only topics count that
/// name all of `joints`. If a log has several, the settings name topics or joints.
///
/// # Errors
///
/// - [`Error::File`] and [`Error::Format`] if there is no file that can be read, [`Error::Damaged`]
///   if a part of it cannot.
/// - [`Error::NoTopic`], [`Error::TopicType`], [`Error::NoCommands`], [`Error::SeveralTopics`],
///   [`Error::ZeroStamps`] and [`Error::Setting`] if the topics do not fit the settings.
pub fn read_commands(
    path: &Path,
    settings: &LogSettings,
    joints: &[String],
    wanted: Wanted,
) -> Result<Commands> {
    if settings.marker.is_some() {
        return Err(Error::Setting(
            "--marker cuts logs with torques into runs; leave it out for commands".into(),
        ));
    }
    // The robot may have other names than the log.
    let joints = match joints {
        [] => settings.joints.clone(),
        names => LogOptions::new(settings, names)?.joints,
    };
    let mut logged = PositionLog::read(path, settings)?;
    logged.all.series.retain(|of| joints.iter().all(|joint| of.names.contains(joint)));
    let mut log = logged.chosen(path, wanted == Wanted::Plan)?;
    let series = &mut log.series;
    if settings.time == LogTime::Header
        && series.iter().any(|of| of.times.iter().all(|t| t[0] == 0))
    {
        return Err(Error::ZeroStamps { path: path.into(), topic: log.topics.join(", ") });
    }
    let moved: usize = series.iter_mut().map(NamedSeries::sort).sum();
    if let [command, state] = &series[..] {
        let late = [command, state].into_iter().find(|of| !of.increases());
        if let Some(of) = late {
            return Err(Error::Setting(format!(
                "{}: the stamps of {} do not increase, so that it cannot be joined with another \
                 topic; --time log takes the times at which the log received the messages",
                path.display(),
                logged.topics[of.topic]
            )));
        }
    }
    let (names, others) = log.joints(&joints);
    let (text, left_out) = log.text(&names);
    let mut notes = std::mem::take(&mut logged.notes);
    notes.extend(log.notes(&logged.all, [moved, left_out], &others));
    let named = |note: String| format!("{}: {note}", path.display());
    Ok(Commands {
        joints: names,
        text,
        columns: UNITS.parse().map_err(Error::Setting)?,
        notes: notes.into_iter().map(named).collect(),
    })
}

/// The units of ROS.
const UNITS: &str = "angle=rad,time_unit=ns";

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

/// The series with commanded and actual positions: one that has both, or first the commands. A plan
/// has the commands alone.
struct ChosenSeries {
    series: Vec<NamedSeries>,
    topics: Vec<String>,
    is_plan: bool,
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

    /// Returns the series of commanded and actual positions, or for a plan of commands alone.
    fn chosen(&mut self, path: &Path, is_plan: bool) -> Result<ChosenSeries> {
        let found = self.pair(path, is_plan)?;
        let unused = self.topics.iter().filter(|topic| !found.topics.contains(topic));
        let unused: Vec<&str> = unused.map(String::as_str).collect();
        if self.is_named && !is_plan && !unused.is_empty() {
            return Err(Error::Setting(format!(
                "--topic names {}, which have no positions of the joints that {} does not have; \
                 leave them out",
                unused.join(", "),
                found.topics.join(", ")
            )));
        }
        Ok(found)
    }

    fn pair(&mut self, path: &Path, is_plan: bool) -> Result<ChosenSeries> {
        let (both, single): (Vec<_>, Vec<_>) =
            std::mem::take(&mut self.all.series).into_iter().partition(|of| of.has_commands);
        let of_topic = |of: &NamedSeries| self.topics[of.topic].clone();
        let several = |all: &[NamedSeries]| Error::SeveralTopics {
            path: path.into(),
            topics: all.iter().map(of_topic).collect(),
        };
        let chosen = |series: Vec<NamedSeries>| {
            let topics = series.iter().map(of_topic).collect();
            Ok(ChosenSeries { series, topics, is_plan })
        };
        match &both[..] {
            [] => {}
            [_] => return chosen(both),
            several_controllers => return Err(several(several_controllers)),
        }
        // The second one of two named topics.
        let is_command = |of: &NamedSeries| match self.is_named {
            true => of.topic == 1,
            false => is_commanded(&self.topics[of.topic]),
        };
        let (commands, states): (Vec<_>, Vec<_>) = single.into_iter().partition(is_command);
        let pairs = commands.iter().flat_map(|command| states.iter().map(move |of| (command, of)));
        let shares = |(command, state): &(&NamedSeries, &NamedSeries)| {
            command.names.iter().any(|name| state.names.contains(name))
        };
        let pairs: Vec<_> = pairs.filter(shares).collect();
        match (&commands[..], &states[..], &pairs[..]) {
            ([alone], _, _) | ([], [alone], _) if is_plan => chosen(vec![alone.clone()]),
            (_, _, [(command, state)]) => chosen(vec![(*command).clone(), (*state).clone()]),
            (_, _, []) => Err(Error::NoCommands {
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
    /// Returns notes about the topics, the numbers of samples that were moved and left out, and
    /// joints that are not used.
    fn notes(
        &self,
        all: &AllSeries,
        [moved, left_out]: [usize; 2],
        others: &[String],
    ) -> Vec<String> {
        let is_of = |topic: &&usize| self.series.iter().any(|of| of.topic == **topic);
        let incomplete = all.incomplete.iter().filter(is_of).count();
        let mut notes = vec![format!("positions come from {}", self.topics.join(", "))];
        let counted = [
            (incomplete, "messages have no position for each of their joints, and are not used"),
            (moved, "messages were sorted by the times of receipt, or are there twice"),
            (left_out, "samples have no partner within half a step, and are not used"),
        ];
        let counted = counted.into_iter().filter(|(count, _)| *count > 0);
        notes.extend(counted.map(|(count, what)| format!("{count} {what}")));
        if !others.is_empty() {
            notes.push(format!("{} are in one topic only, and are not used", others.join(", ")));
        }
        notes
    }

    /// Returns the joints that are read: the given ones, or all that have both positions; and the
    /// other ones.
    fn joints(&self, given: &[String]) -> (Vec<String>, Vec<String>) {
        if !given.is_empty() {
            return (given.to_vec(), vec![]);
        }
        let mut all: Vec<String> = Vec::new();
        for name in self.series.iter().rev().flat_map(|of| &of.names) {
            if !all.contains(name) {
                all.push(name.clone());
            }
        }
        all.into_iter().partition(|name| self.series.iter().all(|of| of.names.contains(name)))
    }

    /// Returns the columns of some joints as text, and the number of samples that have no partner.
    fn text(&self, names: &[String]) -> (Vec<u8>, usize) {
        let last = self.series.last().expect("there are one or two");
        // Actual positions count where both have the same steps.
        let step = |of: &&NamedSeries| median_step(&of.stamps()).unwrap_or_default();
        let stamps = self.series.iter().max_by_key(step).unwrap_or(last).stamps();
        let mut columns: Vec<Vec<usize>> = self.series.iter().map(|of| of.columns(names)).collect();
        let mut kinds = vec!["commanded", "actual"];
        if self.is_plan {
            columns.iter_mut().for_each(|of| of.truncate(names.len()));
            kinds.pop();
        }
        let places: Vec<Vec<Place>> = self.series.iter().map(|of| of.places(&stamps)).collect();
        let mut text = b"t".to_vec();
        for kind in kinds {
            // Writing to memory does not fail.
            (0..names.len()).for_each(|joint| drop(write!(text, ",{kind}_position_{joint}")));
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
