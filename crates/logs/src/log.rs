//! A log as a source of joint states.

use std::cell::RefCell;
use std::ops::Range;
use std::path::{Path, PathBuf};

use reachtube_recordings::{Defect, LogTime, Run};

use crate::container::{Contents, Role, Topic, WantedTopics, names_of};
use crate::error::{Error, Result};
use crate::files::{files_of, scan};
use crate::log_notes::{order_note, series_notes, shift_note, time_note};
use crate::loss::Loss;
use crate::merge::{Merged, merge};
use crate::sample::{Labels, Sample, defects};
use crate::seconds::decimal;
use crate::series::TopicStates;

/// The parts to read from a log.
#[derive(Debug, Clone, Default)]
pub struct LogOptions {
    /// Topics with `sensor_msgs/msg/JointState`. Several complement each other: values with the
    /// same stamp become one sample. Without a topic, the only one that names joints of the robot
    /// is taken.
    pub topics: Vec<String>,
    /// Names of the robot's joints in the log, in the order of the robot.
    pub joints: Vec<String>,
    /// Topic that marks runs: `std_msgs/msg/String`, `Bool` or `Int32`.
    pub marker: Option<String>,
    /// Which times the samples have.
    pub time: LogTime,
    /// Whether the whole parts of a damaged log are read.
    pub recover: bool,
}

/// A message that marks a run, or the end of one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Marker {
    /// Time at which the log received it, ns.
    pub(crate) received: i64,
    /// Name of the suite (empty if none is given); `None` outside of runs.
    pub(crate) suite: Option<String>,
}

/// The joint states of a log: an MCAP file, a .db3 file of rosbag2, or a folder with the parts of
/// one bag.
///
/// # Examples
///
/// ```no_run
/// use reachtube_logs::{Cutting, Log, LogOptions, convert};
///
/// let options = LogOptions {
///     topics: vec!["/joint_states".into()],
///     joints: vec!["shoulder".into(), "elbow".into()],
///     ..LogOptions::default()
/// };
/// let logs = [Log::read("run.mcap".as_ref(), &options)?];
/// let cuts = Cutting::Whole.runs(&logs)?;
/// let runs = convert(&logs, &cuts, Default::default())?;
/// runs.write("recordings".as_ref())?;
/// # Ok::<(), reachtube_logs::Error>(())
/// ```
#[derive(Debug)]
pub struct Log {
    pub(crate) path: PathBuf,
    pub(crate) joints: Vec<String>,
    topics: Vec<String>,
    pub(crate) samples: Vec<Sample>,
    /// Positions, velocities and efforts of all joints, row-major K x 3n.
    values: Vec<f64>,
    pub(crate) markers: Vec<Marker>,
    notes: Vec<String>,
    losses: Vec<Loss>,
    time: LogTime,
    /// Names in the messages that are no joints of the robot.
    pub(crate) unused: Vec<String>,
}

/// Data collected while the files of a log are read.
#[derive(Debug)]
struct Collected {
    /// Joint states, one series per topic of `topics`.
    series: Vec<TopicStates>,
    /// The topics of joint states.
    topics: Vec<String>,
    markers: Vec<Marker>,
    available: Vec<Topic>,
    notes: Vec<String>,
    losses: Vec<Loss>,
}

impl Log {
    /// Reads the joint states of a log.
    ///
    /// A sample that cannot be used is kept with what is wrong with it, and only a run that
    /// contains it is refused.
    ///
    /// # Errors
    ///
    /// - [`Error::File`] and [`Error::Format`] if there is no file that can be read.
    /// - [`Error::Damaged`] if a part of it cannot be read, unless `recover` is set.
    /// - [`Error::NoTopic`], [`Error::TopicType`], [`Error::NoMessages`], [`Error::ZeroStamps`] and
    ///   [`Error::Setting`] if the topics do not fit the options.
    /// - [`Error::Recordings`] if several topics are read and the stamps of one do not increase.
    pub fn read(path: &Path, options: &LogOptions) -> Result<Self> {
        check_options(options)?;
        let mut collected = collect(path, options)?;
        for (topic, series) in collected.topics.iter().zip(&collected.series) {
            check_series(path, topic, series, options)?;
        }
        let mut notes = std::mem::take(&mut collected.notes);
        notes.push(time_note(path, &collected.series[0], options.time));
        for (topic, series) in collected.topics.iter().zip(&mut collected.series) {
            let late = series.sort();
            notes.extend(series_notes(path, topic, series, &options.joints));
            notes.extend((late > 0).then(|| order_note(path, topic, late)));
        }
        let unused = collected.series.iter().flat_map(|series| series.unused.iter().cloned());
        let unused = unused.collect();
        let (joints, topics) = (options.joints.clone(), collected.topics);
        let labels = Labels { log: path, topics: &topics, joints: &joints };
        let Merged { samples, values, unmatched, shifts } = merge(collected.series, &labels)?;
        notes
            .extend(shifts.into_iter().map(|(topic, largest)| shift_note(&labels, topic, largest)));
        if unmatched > 0 {
            notes.push(format!(
                "{}: {unmatched} samples at the start and the end are not in all topics and are \
                 not used",
                path.display()
            ));
        }
        let (markers, losses) = (collected.markers, collected.losses);
        let (path, time) = (path.into(), options.time);
        Ok(Self { path, joints, topics, samples, values, markers, notes, losses, time, unused })
    }

    #[must_use]
    pub(crate) fn topics(&self) -> &[String] {
        &self.topics
    }

    /// Returns the number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// Returns notes for the user: which times were taken, and where each joint was found.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Returns the parts of the log that could not be read.
    #[must_use]
    pub fn losses(&self) -> &[Loss] {
        &self.losses
    }

    /// Returns what the times of the samples are called.
    pub(crate) fn time_name(&self) -> &'static str {
        match self.time {
            LogTime::Header => "header.stamp",
            LogTime::Receipt => "time of receipt",
        }
    }

    /// Returns the time of a sample, s, with all digits, as a recording has it.
    pub(crate) fn time(&self, index: usize) -> String {
        decimal(self.samples[index].time)
    }

    /// Returns the positions (`part` 0), velocities (1) or torques (2) of a sample, n.
    pub(crate) fn part(&self, index: usize, part: usize) -> &[f64] {
        let n = self.joints.len();
        &self.values[(3 * index + part) * n..][..n]
    }

    /// Returns positions, velocities and torques of a sample, 3n.
    pub(crate) fn row(&self, index: usize) -> &[f64] {
        let width = 3 * self.joints.len();
        &self.values[index * width..][..width]
    }

    /// Returns the samples in `range` as a run.
    ///
    /// # Errors
    ///
    /// Every kind of defect of these samples.
    pub(crate) fn run(&self, range: Range<usize>) -> Result<Run, Vec<Defect>> {
        let labels = Labels { log: &self.path, topics: &self.topics, joints: &self.joints };
        let defects = defects(&self.samples, range.clone(), &labels);
        if !defects.is_empty() {
            return Err(defects);
        }
        let n = self.joints.len();
        let first = self.samples[range.start].time;
        // As the reader of recordings does, which counts picoseconds.
        let seconds =
            |index: usize| (1000 * i128::from(self.samples[index].time - first)) as f64 / 1e12;
        let times = range.clone().map(seconds).collect();
        let rows = range.clone().map(|index| self.row(index));
        let states = rows.clone().flat_map(|row| &row[..2 * n]).copied().collect();
        let torques = rows.flat_map(|row| &row[2 * n..]).copied().collect();
        let mut run = Run::new(n, times, states, torques).map_err(|problem| {
            let remedy = "record again, or cut the log elsewhere";
            vec![Defect::new(&self.path, None, problem.to_string(), remedy)]
        })?;
        run.start = decimal(first).parse().expect("a decimal number is a number");
        Ok(run)
    }
}

fn check_options(options: &LogOptions) -> Result<()> {
    let repeated = |names: &[String]| {
        let mut before = std::collections::BTreeSet::new();
        names.iter().find(|name| !before.insert(*name)).cloned()
    };
    let setting = |text: String| Err(Error::Setting(text));
    if let Some(topic) = repeated(&options.topics) {
        return setting(format!("topic {topic} is given twice; give each once"));
    }
    if options.marker.as_ref().is_some_and(|marker| options.topics.contains(marker)) {
        return setting("the marker's topic is one of joint states; give another".into());
    }
    if options.joints.is_empty() {
        return setting("no joint is given; name the robot with --robot, or its joints".into());
    }
    if let Some(joint) = repeated(&options.joints) {
        return setting(format!("joint {joint} is given twice; give each once"));
    }
    if options.topics.len() > 1 && options.time == LogTime::Receipt {
        return setting(
            "several topics are joined by the stamps of their headers, which the times of receipt \
             are not; give one topic, or take the stamps"
                .into(),
        );
    }
    Ok(())
}

fn collect(path: &Path, options: &LogOptions) -> Result<Collected> {
    let found = RefCell::new(vec![]);
    let wanted = WantedTopics {
        joints: &options.topics,
        found: &found,
        marker: options.marker.as_deref(),
        controllers: false,
    };
    let mut all = Collected {
        series: (0..options.topics.len()).map(TopicStates::new).collect(),
        topics: options.topics.clone(),
        markers: vec![],
        available: vec![],
        notes: vec![],
        losses: vec![],
    };
    for file in files_of(path)? {
        let receipt = options.time == LogTime::Receipt;
        let (series, markers) = (&mut all.series, &mut all.markers);
        let Contents { topics, notes, losses } =
            scan(&file, wanted, options.recover, &mut |message| match message.role {
                Role::Joints(topic) | Role::Controller(topic) => {
                    // Without topics that are named, they are met one after another.
                    series.extend((series.len()..=topic).map(TopicStates::new));
                    series[topic].add(message, &options.joints, receipt)
                }
                Role::Marker(kind) => {
                    let suite = kind.decode(message.data)?;
                    markers.push(Marker { received: message.log_time, suite });
                    Ok(())
                }
            })?;
        all.available.extend(topics);
        all.notes.extend(notes);
        all.losses.extend(losses);
    }
    for name in wanted.names() {
        if !all.available.iter().any(|topic| topic.name == name) {
            let available = all.available();
            return Err(Error::NoTopic { path: path.into(), topic: name.into(), available });
        }
    }
    if options.topics.is_empty() {
        all.choose_topic(path, found.into_inner())?;
    }
    Ok(all)
}

impl Collected {
    /// Returns the names of all topics, with their types.
    fn available(&self) -> Vec<String> {
        names_of(&self.available)
    }

    /// Keeps the only topic of joint states that names joints of the robot, or the first of all.
    ///
    /// # Errors
    ///
    /// [`Error::NoJointStates`] without a topic, [`Error::SeveralTopics`] for several.
    fn choose_topic(&mut self, path: &Path, found: Vec<String>) -> Result<()> {
        self.series.extend((self.series.len()..found.len()).map(TopicStates::new));
        let mut named: Vec<(String, TopicStates)> =
            found.into_iter().zip(std::mem::take(&mut self.series)).collect();
        if named.iter().any(|(_, series)| !series.samples.is_empty()) {
            named.retain(|(_, series)| !series.samples.is_empty());
        } else {
            named.truncate(1);
        }
        let (topic, mut series) = match <[_; 1]>::try_from(named) {
            Ok([one]) => one,
            Err(none) if none.is_empty() => {
                let available = self.available();
                return Err(Error::NoJointStates { path: path.into(), available });
            }
            Err(several) => {
                let topics = several.into_iter().map(|(name, _)| name).collect();
                return Err(Error::SeveralTopics { path: path.into(), topics });
            }
        };
        series.topic = 0;
        series.samples.iter_mut().for_each(|sample| sample.topic = 0);
        (self.topics, self.series) = (vec![topic], vec![series]);
        Ok(())
    }
}

/// Checks that a topic has joint states of the robot with stamps.
fn check_series(
    path: &Path,
    topic: &str,
    series: &TopicStates,
    options: &LogOptions,
) -> Result<()> {
    if series.messages == 0 {
        return Err(Error::NoMessages { path: path.into(), topic: topic.into() });
    }
    if series.samples.is_empty() {
        return Err(Error::Setting(format!(
            "{}: no message of {topic} names a joint of the robot ({}), but these are named: {}; \
             give the log's names in the robot's order with --joints",
            path.display(),
            options.joints.join(", "),
            series.unused.iter().cloned().collect::<Vec<_>>().join(", ")
        )));
    }
    if options.time == LogTime::Header && series.samples.iter().all(|sample| sample.time == 0) {
        return Err(Error::ZeroStamps { path: path.into(), topic: topic.into() });
    }
    Ok(())
}
