//! A summary of a data set, for a look at it before it is used.

use rayon::prelude::*;
use reachtube_reach::TimeGrid;
use serde::Serialize;

use crate::data_set::DataSet;
use crate::defect::Defect;
use crate::error::{Error, Result};
use crate::gap_limit::GapLimit;
use crate::notes::{copies_note, run_notes};
use crate::run::Run;
use crate::source::{ReadOptions, RunSource};
use crate::units::integral_gap;

/// Speed below which a joint sticks, rad/s.
const STICKING: f64 = 0.01;

/// A summary of a data set.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inspection {
    /// Path of the folder.
    pub folder: String,
    /// Number of joints.
    pub joints: usize,
    /// Number of recordings in the index.
    pub runs: usize,
    /// Test suites, then one group for each kind of the recordings without a suite.
    pub groups: Vec<Group>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// A group of recordings: a test suite, or the recordings of one kind that have no suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Group {
    /// Name of the suite or of the kind.
    pub name: String,
    /// Whether it is a test suite.
    pub suite: bool,
    /// The motion that the suite is part of.
    pub motion: Option<String>,
    /// Number of recordings.
    pub runs: usize,
    /// Smallest and largest number of samples of a recording.
    pub samples: [usize; 2],
    /// Duration of the longest recording, s.
    pub duration: f64,
    /// Time between samples, s, where it is fixed and the same in all recordings.
    pub step: Option<f64>,
    /// Shortest and longest time between two samples, s.
    pub steps: [f64; 2],
    /// Whether all recordings have the same torques at the same times (Definition 2).
    pub same_torque: bool,
    /// Summary of each joint, n.
    pub joints: Vec<JointSummary>,
}

/// A summary of one joint over a group.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointSummary {
    /// Lowest and highest position, rad.
    pub position: [f64; 2],
    /// Highest speed, rad/s.
    pub speed: f64,
    /// Largest magnitude of the torque, N m.
    pub torque: f64,
    /// Range of the first positions, rad.
    pub start_spread: f64,
    /// Range of the last positions of the longest runs, rad, where there are two or more.
    pub end_spread: Option<f64>,
    /// Correlation of the last position with the order of the recordings, from -1 to 1. It is near
    /// ±1 where the robot drifts, for example while its joints warm up.
    pub drift: Option<f64>,
    /// Fraction of the samples in which the joint sticks (below 0.01 rad/s).
    pub sticking: f64,
    /// Largest difference between q and the integral of qd over a recording, rad.
    pub integral_gap: f64,
}

/// Reads every recording of the index and summarises the data set.
///
/// # Errors
///
/// [`Error::Defects`] with every defect of every recording, or with each recording whose number of
/// joints differs from that of the first.
pub fn inspect(data: &DataSet, gap_limit: GapLimit) -> Result<Inspection> {
    let options = ReadOptions { gap_limit, ..ReadOptions::default() };
    let read = |index: usize| data.read(index, &options);
    let results: Vec<_> = (0..data.runs().len()).into_par_iter().map(read).collect();
    let mut runs = Vec::new();
    let mut defects = Vec::new();
    for result in results {
        match result {
            Ok(run) => runs.push(run),
            Err(found) => defects.extend(found),
        }
    }
    if defects.is_empty() {
        defects.extend(other_joint_count(data, &runs));
    }
    if !defects.is_empty() {
        return Err(Error::Defects(defects));
    }
    let groups = groups(data)
        .into_iter()
        .map(|(name, suite, members)| {
            let chosen: Vec<&Run> = members.iter().map(|&index| &runs[index]).collect();
            Group::new(name, suite, data.runs()[members[0]].motion.clone(), &chosen)
        })
        .collect();
    Ok(Inspection {
        folder: data.root().display().to_string(),
        joints: runs[0].joints,
        runs: runs.len(),
        groups,
        notes: notes(data, &runs),
    })
}

/// Returns a defect for each run whose number of joints differs from that of the first.
fn other_joint_count(data: &DataSet, runs: &[Run]) -> Vec<Defect> {
    let odd = |(index, run): (usize, &Run)| {
        let problem = format!(
            "the recording has {} joints, but the first has {}",
            run.joints, runs[0].joints
        );
        let defect = Defect::new(
            data.run_name(index),
            Some(1),
            problem,
            "keep the recordings of one robot in one data set",
        );
        (run.joints != runs[0].joints).then_some(defect)
    };
    runs.iter().enumerate().filter_map(odd).collect()
}

/// Returns the suites, then one group for each kind of the runs without one: name, whether it is a
/// suite, and indices of its runs.
fn groups(data: &DataSet) -> Vec<(String, bool, Vec<usize>)> {
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

fn notes(data: &DataSet, runs: &[Run]) -> Vec<String> {
    let mut notes = data.unlisted_note().into_iter().collect::<Vec<_>>();
    for (index, run) in runs.iter().enumerate() {
        notes.extend(run_notes(data, index, run));
    }
    notes.extend(copies_note(data, runs.iter().map(|run| run.sha256.as_str()).enumerate()));
    notes
}

impl Group {
    fn new(name: String, suite: bool, motion: Option<String>, runs: &[&Run]) -> Self {
        let steps = runs.iter().flat_map(|run| run.times.windows(2).map(|pair| pair[1] - pair[0]));
        let (shortest, longest) =
            steps.fold((f64::INFINITY, 0.0f64), |(a, b), h| (a.min(h), b.max(h)));
        let rate = |run: &&Run| TimeGrid::from_times(&run.times).ok().and_then(|grid| grid.step());
        let first = rate(&runs[0]);
        let samples = runs.iter().map(|run| run.len());
        Self {
            name,
            suite,
            motion,
            runs: runs.len(),
            samples: [samples.clone().min().unwrap_or(0), samples.max().unwrap_or(0)],
            duration: runs.iter().map(|run| run.duration()).fold(0.0, f64::max),
            step: first.filter(|_| runs.iter().all(|run| rate(run) == first)),
            steps: [shortest.min(longest), longest],
            same_torque: runs.iter().all(|run| same_torque(runs[0], run)),
            joints: (0..runs[0].joints).map(|joint| JointSummary::new(joint, runs)).collect(),
        }
    }
}

/// Returns whether two runs have equal torques at equal times, up to the end of the shorter one.
/// The torque of the last sample acts on nothing and is not compared.
fn same_torque(a: &Run, b: &Run) -> bool {
    let count = a.len().min(b.len());
    let since_start = |run: &Run, k: usize| run.times[k] - run.times[0];
    let acting = count.saturating_sub(1) * a.joints;
    a.torques[..acting] == b.torques[..acting]
        && (0..count).all(|k| (since_start(a, k) - since_start(b, k)).abs() <= 1e-9)
}

impl JointSummary {
    fn new(joint: usize, runs: &[&Run]) -> Self {
        let positions = runs.iter().flat_map(|run| (0..run.len()).map(|k| run.q(k)[joint]));
        let speeds = || runs.iter().flat_map(|run| (0..run.len()).map(|k| run.qd(k)[joint].abs()));
        let torques =
            runs.iter().flat_map(|run| (0..run.len()).map(|k| run.torque(k)[joint].abs()));
        let longest = runs.iter().map(|run| run.len()).max().unwrap_or(0);
        let ends: Vec<f64> = runs
            .iter()
            .filter(|run| run.len() == longest)
            .map(|run| run.q(longest - 1)[joint])
            .collect();
        let starts: Vec<f64> = runs.iter().map(|run| run.q(0)[joint]).collect();
        let sticking = speeds().filter(|speed| *speed < STICKING).count() as f64;
        Self {
            position: positions
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], q| [a.min(q), b.max(q)]),
            speed: speeds().fold(0.0, f64::max),
            torque: torques.fold(0.0, f64::max),
            start_spread: spread(&starts),
            end_spread: (ends.len() > 1).then(|| spread(&ends)),
            drift: order_correlation(&ends),
            sticking: sticking / speeds().count().max(1) as f64,
            integral_gap: runs.iter().map(|run| integral_gap(run, joint)).fold(0.0, f64::max),
        }
    }
}

/// Returns the difference of the largest and the smallest value.
fn spread(values: &[f64]) -> f64 {
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    (highest - lowest).max(0.0)
}

/// Returns Pearson's correlation of values with their indices; `None` for fewer than three values
/// or equal ones.
fn order_correlation(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let (mean, centre) = (values.iter().sum::<f64>() / n, (n - 1.0) / 2.0);
    let sums = values.iter().enumerate().map(|(k, v)| (v - mean, k as f64 - centre));
    let (vv, kk, vk) =
        sums.fold((0.0, 0.0, 0.0), |(vv, kk, vk), (v, k)| (vv + v * v, kk + k * k, vk + v * k));
    (values.len() >= 3 && vv > 0.0).then(|| vk / (vv * kk).sqrt())
}
