//! A summary of a data set, for a look at it before it is used.
//!
//! Runs are read one by one and folded into small summaries, so that memory does not grow with
//! their samples.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::data_set::DataSet;
use crate::defect::{Defect, DefectKind};
use crate::gap_limit::GapLimit;
use crate::inspect_run::{InspectedRun, range};
use crate::notes::{copies_note, single_samples_note, temperature_notes};
use crate::refusal::{Refusal, merge};
use crate::source::{ReadOptions, RunSource};
use crate::units::time_defect;

/// A summary of a data set.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Inspection {
    /// Path of the folder.
    pub folder: String,
    /// Number of joints.
    pub joints: usize,
    /// Number of recordings in the index.
    pub runs: usize,
    /// Test suites, then one group for each kind of the recordings without a suite.
    pub groups: Vec<RunGroup>,
    /// Recordings that were refused are in no group; one entry for each kind of defect.
    pub refused: Vec<Refusal>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// A group of recordings: a test suite, or the recordings of one kind that have no suite.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct RunGroup {
    /// Name of the suite or of the kind.
    pub name: String,
    /// Whether it is a test suite.
    pub suite: bool,
    /// The motion that the suite is part of.
    pub motion: Option<String>,
    /// Number of recordings.
    pub runs: usize,
    /// Smallest and largest place in the order of recording, from 1.
    pub order: [u64; 2],
    /// Smallest and largest number of samples of a recording.
    pub samples: [usize; 2],
    /// Duration of the longest recording, s.
    pub duration: f64,
    /// Time between samples, s, if it is fixed and the same in all recordings.
    pub step: Option<f64>,
    /// Shortest and longest time between two samples, s.
    #[schemars(with = "[Option<f64>; 2]")]
    pub steps: [f64; 2],
    /// Whether all recordings have the same torques at the same times (Definition 2).
    pub same_torque: bool,
    /// Summary of each joint, n.
    pub joints: Vec<JointSummary>,
}

/// A summary of one joint over a group.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct JointSummary {
    /// Lowest and highest position, rad.
    #[schemars(with = "[Option<f64>; 2]")]
    pub position: [f64; 2],
    /// Highest speed, rad/s.
    pub speed: f64,
    /// Largest magnitude of the torque, N m.
    pub torque: f64,
    /// Range of the first positions, rad.
    pub start_spread: f64,
    /// Range of the last positions of the longest runs, rad, if there are two or more.
    pub end_spread: Option<f64>,
    /// Correlation of the last position with the order of the recordings, from -1 to 1. It is near
    /// ±1 where the robot drifts, for example while its joints warm up.
    pub drift: Option<f64>,
    /// Lowest and highest recorded temperature, °C, if there is one.
    pub temperature: Option<[f64; 2]>,
    /// Fraction of the samples in which the joint sticks (below 0.01 rad/s).
    pub sticking: f64,
    /// Largest difference between q and the integral of qd over a recording, rad.
    pub integral_gap: f64,
}

/// Reads every recording of the index and summarises the data set.
#[must_use]
pub fn inspect(data: &DataSet, gap_limit: GapLimit) -> Inspection {
    inspect_source(data, data.root().display().to_string(), gap_limit)
}

/// Reads every recording of a source and summarises it; `folder` is the path of the source.
#[must_use]
pub fn inspect_source(data: &dyn RunSource, folder: String, gap_limit: GapLimit) -> Inspection {
    let options = ReadOptions { gap_limit, ..ReadOptions::default() };
    let groups = groups(data);
    let read = |(_, _, members): &(String, bool, Vec<usize>)| read_group(data, members, &options);
    let mut read: Vec<(usize, Summary)> = groups.par_iter().flat_map_iter(read).collect();
    read.sort_by_key(|(index, _)| *index);
    let first = read.iter().find_map(|(_, run)| run.as_ref().ok());
    let joints = first.map_or(0, InspectedRun::joint_count);
    let mut refused = Vec::new();
    let mut sound: Vec<Option<InspectedRun>> = data.runs().iter().map(|_| None).collect();
    for (index, summary) in read {
        match summary.and_then(|run| same_joints(data, index, run, joints)) {
            Ok(run) => sound[index] = Some(run),
            Err(refusals) => merge(&mut refused, refusals),
        }
    }
    Inspection {
        folder,
        joints,
        runs: data.runs().len(),
        notes: notes(data, &sound),
        groups: groups
            .into_iter()
            .filter_map(|(name, suite, members)| {
                let motion = data.runs()[members[0]].motion.clone();
                let runs: Vec<_> = members.iter().filter_map(|&i| sound[i].as_ref()).collect();
                (!runs.is_empty()).then(|| RunGroup::new(name, suite, motion, &runs))
            })
            .collect(),
        refused,
    }
}

/// The summary of a run, or why it is refused.
type Summary = Result<InspectedRun, Vec<Refusal>>;

/// Reads the runs of a group, and compares each with the first that has no defect. At most the
/// first run and one for each core are held at once.
fn read_group(
    data: &dyn RunSource,
    members: &[usize],
    options: &ReadOptions,
) -> Vec<(usize, Summary)> {
    let in_seconds = |index: usize| {
        let run = data.read(index, options)?;
        time_defect(&data.run_name(index), &run).map_or(Ok(run), |defect| Err(vec![defect]))
    };
    let read = |index: usize| in_seconds(index).map_err(Refusal::of_recording);
    let mut summaries = Vec::new();
    for (count, &index) in members.iter().enumerate() {
        match read(index) {
            Err(refusals) => summaries.push((index, Err(refusals))),
            Ok(first) => {
                summaries.push((index, Ok(InspectedRun::new(data, index, &first, &first))));
                let others = members[count + 1..].par_iter().map(|&index| {
                    (index, read(index).map(|run| InspectedRun::new(data, index, &run, &first)))
                });
                summaries.par_extend(others);
                break;
            }
        }
    }
    summaries
}

/// Refuses a run whose number of joints differs from the first run's.
fn same_joints(data: &dyn RunSource, index: usize, run: InspectedRun, joints: usize) -> Summary {
    let found = run.joint_count();
    if found == joints {
        return Ok(run);
    }
    let problem = format!("the recording has {found} joints, but the first has {joints}");
    let remedy = "keep the recordings of one robot in one data set";
    let defect = Defect::new(data.run_name(index), Some(1), problem, remedy);
    Err(Refusal::of_recording(vec![defect.of_kind(DefectKind::Joints)]))
}

/// Returns the suites, then one group for each kind of the runs without one: name, whether it is a
/// suite, and indices of its runs.
fn groups(data: &dyn RunSource) -> Vec<(String, bool, Vec<usize>)> {
    let mut groups: Vec<_> =
        data.suites().into_iter().map(|suite| (suite.name, true, suite.runs)).collect();
    for (index, run) in data.runs().iter().enumerate().filter(|(_, run)| run.suite.is_none()) {
        let kind = run.kind.clone().unwrap_or_else(|| "no suite".into());
        match groups.iter_mut().find(|(name, suite, _)| !suite && *name == kind) {
            Some((_, _, members)) => members.push(index),
            None => groups.push((kind, false, vec![index])),
        }
    }
    groups
}

fn notes(data: &dyn RunSource, runs: &[Option<InspectedRun>]) -> Vec<String> {
    let mut notes = data.notes();
    let sound = || runs.iter().enumerate().filter_map(|(index, run)| Some((index, run.as_ref()?)));
    notes.extend(sound().flat_map(|(_, run)| run.notes.iter().cloned()));
    notes.extend(copies_note(
        sound().map(|(i, run)| (data.runs()[i].file.as_str(), run.sha256.as_str())),
    ));
    notes.extend(temperature_notes(data, sound().map(|(i, run)| (i, run.has_temperatures()))));
    notes.extend(single_samples_note(data, sound().map(|(i, run)| (i, run.samples))));
    notes
}

impl RunGroup {
    fn new(name: String, suite: bool, motion: Option<String>, runs: &[&InspectedRun]) -> Self {
        let shortest = runs.iter().map(|run| run.steps[0]).fold(f64::INFINITY, f64::min);
        let longest = runs.iter().map(|run| run.steps[1]).fold(0.0, f64::max);
        let first = runs[0].step;
        let samples = runs.iter().map(|run| run.samples);
        let orders = runs.iter().map(|run| run.order);
        Self {
            name,
            suite,
            motion,
            runs: runs.len(),
            order: [orders.clone().min().unwrap_or(1), orders.max().unwrap_or(1)],
            samples: [samples.clone().min().unwrap_or(0), samples.max().unwrap_or(0)],
            duration: runs.iter().map(|run| run.duration).fold(0.0, f64::max),
            step: first.filter(|_| runs.iter().all(|run| run.step == first)),
            steps: [shortest.min(longest), longest],
            same_torque: runs.iter().all(|run| run.same_torque),
            joints: (0..runs[0].joint_count())
                .map(|joint| JointSummary::new(joint, runs))
                .collect(),
        }
    }
}

impl JointSummary {
    fn new(joint: usize, runs: &[&InspectedRun]) -> Self {
        let of = || runs.iter().map(|run| &run.joints[joint]);
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let longest = runs.iter().map(|run| run.samples).max().unwrap_or(0);
        let (orders, ends): (Vec<f64>, Vec<f64>) = runs
            .iter()
            .filter(|run| run.samples == longest)
            .map(|run| (run.order as f64, run.joints[joint].last))
            .unzip();
        let starts: Vec<f64> = of().map(|run| run.first).collect();
        let samples: usize = runs.iter().map(|run| run.samples).sum();
        let sticking: usize = of().map(|run| run.sticking).sum();
        Self {
            position: [
                of().map(|run| run.position[0]).fold(f64::INFINITY, f64::min),
                of().map(|run| run.position[1]).fold(f64::NEG_INFINITY, f64::max),
            ],
            speed: largest(&mut of().map(|run| run.speed)),
            torque: largest(&mut of().map(|run| run.torque)),
            start_spread: spread(&starts),
            end_spread: (ends.len() > 1).then(|| spread(&ends)),
            drift: correlation(&orders, &ends),
            temperature: range(of().flat_map(|run| run.temperature).flatten()),
            sticking: sticking as f64 / samples.max(1) as f64,
            integral_gap: largest(&mut of().map(|run| run.integral_gap)),
        }
    }
}

fn spread(values: &[f64]) -> f64 {
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    (highest - lowest).max(0.0)
}

/// Returns Pearson's correlation of values with the places of their runs in the order of recording;
/// `None` for fewer than three values or equal ones.
fn correlation(orders: &[f64], values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
    let (mean, centre) = (mean(values), mean(orders));
    let sums = orders.iter().zip(values).map(|(k, v)| (v - mean, k - centre));
    let (vv, kk, vk) =
        sums.fold((0.0, 0.0, 0.0), |(vv, kk, vk), (v, k)| (vv + v * v, kk + k * k, vk + v * k));
    (values.len() >= 3 && vv > 0.0 && kk > 0.0).then(|| vk / (vv * kk).sqrt())
}
