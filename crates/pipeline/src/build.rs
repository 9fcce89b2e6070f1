use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use reachtube_conform::{Answer, Check, Equations, FitSettings, Silent};
use reachtube_identify::prepare::{LogEntry, PrepareSettings, PreparedLog, RawLog, cut_off, read};
use reachtube_recordings::{DataSet, RunEntry, RunSource, Torque, noise_deviations};
use reachtube_robot::Robot;
use serde::Serialize;

use crate::choices::{Choice, Choices};
use crate::error::{Error, Result};
use crate::held_out::{Recording, Split};
use crate::horizon::{Rung, ladder, longest};
use crate::kinds::{Kind, motions};
use crate::robot::{Evidence, Nominal, prepare_for};
use crate::trial::Trial;
use crate::windows::cut;

/// Half a joint's set by the joint's displacement that is accepted by default.
const LARGEST_RATIO: f64 = 0.5;

/// Standard deviations within which noise is taken to lie.
const DEVIATIONS: f64 = 5.0;

/// A model made of logs, the choices behind it, and what motions that were kept back say of it.
#[derive(Debug)]
pub struct Built {
    /// The model with its recordings, the windows.
    pub answer: Answer,
    /// The robot: as described, or identified.
    pub robot: Robot,
    /// All choices, from which the same model is made again.
    pub choices: Choices,
    /// The choices that were made, in their order, with their reasons.
    pub made: Vec<Choice>,
    /// How wide the sets are at each horizon that was tried.
    pub ladder: Vec<Rung>,
    /// What the motions that were kept back say.
    pub held_out: HeldOut,
}

/// A model beside motions that were kept back from every choice.
#[derive(Debug, Clone, Serialize)]
pub struct HeldOut {
    /// Number of windows.
    pub windows: usize,
    /// Number of rows (window, sample, state).
    pub rows: usize,
    /// How many of them lie outside the reachable set.
    pub outside: usize,
    /// The factor by which the set of each joint would have to grow where it is left furthest, n;
    /// 1 where nothing lies outside.
    pub growth: Vec<f64>,
    /// Why the motions could not be compared, such as a nominal motion that runs away.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

impl Built {
    /// Returns whether the sets were proved to enclose every window, say something about every
    /// joint, and are narrow enough at the horizon.
    #[must_use]
    pub fn is_useful(&self) -> bool {
        let model = &self.answer.model;
        let worst = model.usefulness.as_ref().and_then(|said| said.worst());
        let largest = self.choices.largest_ratio.unwrap_or(LARGEST_RATIO);
        model.is_useful() && worst.is_some_and(|(_, ratio)| ratio <= largest)
    }
}

/// The choices so far.
struct Road<'a> {
    choices: Choices,
    made: Vec<Choice>,
    say: &'a mut dyn FnMut(&Choice),
}

impl Road<'_> {
    fn choose(&mut self, key: &'static str, value: impl Into<String>, reason: impl Into<String>) {
        let choice = Choice { key, value: value.into(), reason: reason.into() };
        (self.say)(&choice);
        self.made.push(choice);
    }
}

/// Makes a model of the recordings that `given` names, and compares it with motions that are kept
/// back. `folder` is where relative paths begin. `say` takes each choice when it is made.
///
/// # Errors
///
/// Recordings that cannot be read, show no motion of several joints, or are shorter than every
/// horizon; a robot that cannot be identified although its description is no body; a model that
/// runs away over the shortest horizon.
pub fn build(
    robot: &Robot,
    torque: Torque,
    given: &Choices,
    folder: &Path,
    say: &mut dyn FnMut(&Choice),
) -> Result<Built> {
    let mut road = Road { choices: given.clone(), made: Vec::new(), say };
    let settings = PrepareSettings { gains: given.gains.clone(), ..PrepareSettings::default() };
    let sorted = Sorted::read(&mut road, given, folder, robot, &settings)?;
    let split = Split::new(sorted.motions, given.held_out.as_deref())?;
    let names = if split.names.is_empty() { "the end".into() } else { split.names.join(", ") };
    road.choose("held-out", names, &split.reason);
    road.choices.held_out = (!split.names.is_empty()).then(|| split.names.clone());

    // The filter, and the model of deviations about the mean of the motion.
    let raw: Vec<&RawLog> = split.kept.iter().map(|recording| &recording.log).collect();
    let is_filtered = torque != Torque::Compensated;
    let cut_off = cut_off(&raw, &PrepareSettings { cut_off: given.cut_off, ..settings.clone() })?;
    let cut_off = (10.0 * cut_off).round() / 10.0;
    if is_filtered {
        road.choose("cut-off", format!("{cut_off} Hz"), "1.5 times the bandwidth of the motions");
        road.choices.cut_off = Some(cut_off);
    }
    let expansion = given.expansion.clone().unwrap_or_else(|| mean_position(&raw));
    road.choose("expansion", list(&expansion), "the mean position of the motions");
    road.choices.expansion = Some(expansion.clone());
    let noise = given
        .sensor_noise
        .clone()
        .unwrap_or_else(|| noise(&raw, is_filtered.then_some(cut_off)));
    let why = match is_filtered {
        true => "5 standard deviations before the filter, lessened by what the filter takes",
        false => "5 standard deviations",
    };
    road.choose("sensor-noise", list(&noise), why);
    road.choices.sensor_noise = Some(noise.clone());
    let equations = given.equations.unwrap_or(Equations::Robot);
    let why = "the robot's own equations follow the motion further than a linear model";
    road.choose("equations", format!("{equations:?}").to_lowercase(), why);
    road.choices.equations = Some(equations);

    // The robot.
    let mut trial =
        Trial { robot: robot.clone(), expansion, sensor_noise: noise, equations, fit: None };
    let evidence = Evidence {
        rest: sorted.rest,
        one_joint: sorted.one_joint,
        motions: &split.kept,
        torque,
        settings: &settings,
        cut_off,
        trial: &trial,
    };
    let Nominal { robot, logs, is_identified, reason } = evidence.choose(robot, given.identify)?;
    road.choose("identify", is_identified.to_string(), reason);
    road.choices.identify = Some(is_identified);
    trial.robot = robot.clone();

    // The horizon and the sets.
    let motions = motion_names(&split);
    let (answer, ladder) = sets(&mut road, &mut trial, &logs, &motions)?;
    let raw: Vec<RawLog> = split.held_out.iter().map(|recording| recording.log.clone()).collect();
    let prepared = prepare_for(&raw, &robot, torque, &settings, cut_off)?;
    let horizon = road.choices.horizon.unwrap_or_default();
    let held_out = HeldOut::new(&answer, &prepared, &motions, horizon)?;
    let Road { choices, made, .. } = road;
    Ok(Built { answer, robot, choices, made, ladder, held_out })
}

/// Recordings by what they are.
struct Sorted {
    rest: Vec<LogEntry>,
    one_joint: Vec<LogEntry>,
    motions: Vec<Recording>,
}

impl Sorted {
    fn read(
        road: &mut Road,
        given: &Choices,
        folder: &Path,
        robot: &Robot,
        settings: &PrepareSettings,
    ) -> Result<Self> {
        let entries: Vec<LogEntry> = given.data.iter().cloned().map(LogEntry::from).collect();
        let raw = read(&entries, folder, robot, settings)?;
        let kinds: Vec<Kind> = raw.iter().map(|log| Kind::of(&log.run)).collect();
        let count = |kind: Kind| kinds.iter().filter(|other| **other == kind).count();
        let of = |kind: Kind| -> Vec<&RawLog> {
            let pairs = raw.iter().zip(&kinds).filter(|(_, other)| **other == kind);
            pairs.map(|(log, _)| log).collect()
        };
        let entry = |log: &RawLog| LogEntry::Path(log.file.clone());
        let moving = of(Kind::Motion);
        if moving.is_empty() {
            let (rest, one) = (count(Kind::Rest), count(Kind::OneJoint));
            return Err(Error::NoMotion { recordings: raw.len(), rest, one });
        }
        let known = indexed(given.data.iter().map(|path| folder.join(path)));
        let known: Vec<Option<String>> =
            moving.iter().map(|log| known.get(&log.file).cloned()).collect();
        let names = motions(&moving, &known);
        let distinct: BTreeSet<&String> = names.iter().collect();
        road.choose(
            "data",
            format!("{} recordings", raw.len()),
            format!(
                "{} at rest, {} of one joint at a time, {} of several joints ({} motions)",
                count(Kind::Rest),
                count(Kind::OneJoint),
                moving.len(),
                distinct.len()
            ),
        );
        drop(distinct);
        let recordings = moving.iter().zip(names).map(|(log, motion)| Recording {
            log: (*log).clone(),
            entry: entry(log),
            motion,
        });
        let motions = recordings.collect();
        let [rest, one_joint] =
            [Kind::Rest, Kind::OneJoint].map(|kind| of(kind).into_iter().map(entry).collect());
        Ok(Self { rest, one_joint, motions })
    }
}

/// Returns the motion, or else the suite, of each file that the index of a folder names.
fn indexed(folders: impl Iterator<Item = PathBuf>) -> BTreeMap<PathBuf, String> {
    let indices = folders.filter(|folder| folder.join("runs.csv").is_file());
    let sets = indices.filter_map(|folder| DataSet::open(&folder).ok());
    let motion = |set: DataSet| -> Vec<(PathBuf, String)> {
        let named = |(index, run): (usize, &RunEntry)| {
            let motion = run.motion.clone().or_else(|| run.suite.clone())?;
            Some((set.run_name(index), motion))
        };
        set.runs().iter().enumerate().filter_map(named).collect()
    };
    sets.flat_map(motion).collect()
}

/// Chooses the horizon, and the fit if one was given, and finds the sets.
fn sets(
    road: &mut Road,
    trial: &mut Trial,
    logs: &[PreparedLog],
    motions: &BTreeMap<String, String>,
) -> Result<(Answer, Vec<Rung>)> {
    let groups = road.choices.fit.clone().unwrap_or_default();
    let ladder = ladder(trial, logs, motions)?;
    let largest = road.choices.largest_ratio.unwrap_or(LARGEST_RATIO);
    road.choices.largest_ratio = Some(largest);
    let (horizon, reason) = match road.choices.horizon {
        Some(horizon) => (horizon, "given".to_string()),
        None => {
            let rung = longest(&ladder, largest);
            (rung.horizon, reason_of_horizon(rung, &ladder, largest, &trial.robot))
        }
    };
    trial.fit = (!groups.is_empty()).then(|| FitSettings { groups, pull: road.choices.pull });
    road.choose("horizon", format!("{horizon} s"), reason);
    road.choices.horizon = Some(horizon);
    let answer = trial.run(cut(logs, motions, horizon, usize::MAX)?, true)?;
    Ok((answer, ladder))
}

impl HeldOut {
    /// Compares a model with prepared recordings.
    fn new(
        answer: &Answer,
        logs: &[PreparedLog],
        motions: &BTreeMap<String, String>,
        horizon: f64,
    ) -> Result<Self> {
        let n = answer.model.robot.joints.len();
        let windows = match cut(logs, motions, horizon, usize::MAX) {
            Err(Error::NoWindow { .. }) => return Ok(Self::failed(n, 0, "no window is as long")),
            other => other?,
        };
        let count = reachtube_recordings::RunSource::runs(&windows).len();
        match answer.model.check(windows).run(&Silent) {
            Ok(check) => Ok(Self {
                windows: count,
                rows: check.verdict.rows,
                outside: check.verdict.violations.count,
                growth: growth(&check, n),
                failure: None,
            }),
            Err(error) => Ok(Self::failed(n, count, &error.to_string())),
        }
    }

    fn failed(joints: usize, windows: usize, why: &str) -> Self {
        let growth = vec![f64::INFINITY; joints];
        Self { windows, rows: 0, outside: 0, growth, failure: Some(why.into()) }
    }
}

/// Returns the factor by which the sets of each joint would have to grow about their centres.
fn growth(check: &Check, joints: usize) -> Vec<f64> {
    let mut growth = vec![1.0f64; joints];
    for worst in &check.worst_by_state {
        let factor = 1.0 + worst.excess / worst.radius.max(f64::MIN_POSITIVE);
        let own = &mut growth[worst.state.joint];
        *own = own.max(factor);
    }
    growth
}

fn motion_names(split: &Split) -> BTreeMap<String, String> {
    let all = split.kept.iter().chain(&split.held_out);
    all.map(|recording| (recording.log.name.clone(), recording.motion.clone())).collect()
}

fn reason_of_horizon(rung: &Rung, ladder: &[Rung], largest: f64, robot: &Robot) -> String {
    let name = |joint: usize| &robot.joints()[joint].name;
    let percent = |ratio: f64| match ratio.is_finite() {
        true => format!("{:.0} %", 100.0 * ratio),
        false => "no bound".into(),
    };
    let (joint, ratio) = rung.worst();
    let next = ladder.iter().find(|other| other.horizon > rung.horizon);
    let mut words = format!("the widest set is {} of the motion ({})", percent(ratio), name(joint));
    if ratio > largest {
        words +=
            &format!(", more than {}, and at every other horizon it is wider", percent(largest));
    } else if let Some(next) = next {
        let (joint, ratio) = next.worst();
        words +=
            &format!("; at {} s it would be {} ({})", next.horizon, percent(ratio), name(joint));
    }
    words
}

/// Returns the mean position of recordings, n, rounded to 0.01.
fn mean_position(logs: &[&RawLog]) -> Vec<f64> {
    let n = logs.first().map_or(0, |log| log.run.joints);
    let samples: usize = logs.iter().map(|log| log.run.len()).sum();
    let sum = |joint: usize| -> f64 {
        logs.iter().map(|log| (0..log.run.len()).map(|k| log.run.q(k)[joint]).sum::<f64>()).sum()
    };
    (0..n).map(|joint| (100.0 * sum(joint) / samples.max(1) as f64).round() / 100.0).collect()
}

/// Returns the radii of the sensors' noise, 2n, rad and rad/s, rounded to two digits; after a
/// low-pass of `cut_off` \[Hz\] of what is left of it. White noise keeps the part of its variance
/// that lies below the cut-off, and a filtered velocity is as noisy as the recorded one or as the
/// derivative of the position, whichever is less.
fn noise(logs: &[&RawLog], cut_off: Option<f64>) -> Vec<f64> {
    let left = |log: &&RawLog| -> Option<Vec<f64>> {
        let run = &log.run;
        let mut deviations = noise_deviations(run)?;
        let Some(cut_off) = cut_off else { return Some(deviations) };
        let n = run.joints;
        let step = run.duration() / (run.len() - 1).max(1) as f64;
        let slope = 2.0 * std::f64::consts::PI * cut_off / 3f64.sqrt();
        for joint in 0..n {
            deviations[n + joint] = deviations[n + joint].min(slope * deviations[joint]);
        }
        let part = (2.0 * cut_off * step).sqrt().min(1.0);
        Some(deviations.into_iter().map(|deviation| part * deviation).collect())
    };
    let all: Vec<Vec<f64>> = logs.iter().filter_map(left).collect();
    let states = logs.first().map_or(0, |log| 2 * log.run.joints);
    let median = |i: usize| {
        let mut values: Vec<f64> = all.iter().map(|noise| noise[i]).collect();
        values.sort_by(f64::total_cmp);
        rounded(DEVIATIONS * values.get(values.len() / 2).copied().unwrap_or(0.0))
    };
    (0..states).map(median).collect()
}

/// Rounds up to two digits.
fn rounded(value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let unit = 10f64.powi(value.log10().floor() as i32 - 1);
    let digits = (value / unit).ceil();
    // The shortest number with these digits.
    format!("{digits}e{}", unit.log10().round() as i32).parse().unwrap_or(value)
}

fn list(values: &[f64]) -> String {
    values.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
