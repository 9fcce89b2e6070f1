//! Stops from every sample of recorded motions.

use rayon::prelude::*;
use reachtube_conform::Problem;
use reachtube_conform::data::Suite;
use reachtube_scalar::Interval;
use serde::Serialize;

use crate::stop::brakes::Brakes;
use crate::stop::stop::{JointStop, stop_0};

/// The stops of a joint from the samples of a suite.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorstStop {
    /// The suite.
    pub suite: String,
    /// The joint.
    pub joint: String,
    /// The greatest proved way to standstill, in either direction, rad or m.
    pub way: f64,
    /// The time of the sample from which it is the greatest, s.
    pub way_from: f64,
    /// The latest proved time of standstill after a stop, s.
    pub time: f64,
    /// The time of the sample from which it is the latest, s.
    pub time_from: f64,
    /// Number of samples from which a standstill is proved.
    pub proved: usize,
    /// Number of samples.
    pub samples: usize,
}

/// Encloses the stops of category 0 from the samples of all suites of a problem, every `every`th of
/// them: from all states between the lowest and the highest recorded ones, and returns the worst
/// for each suite and joint.
///
/// # Guarantee
///
/// Outer, as [`stop_0`]. Ways and times of samples without a proved standstill are infinite.
#[must_use]
pub fn stops_along(problem: &Problem, brakes: &Brakes, every: usize) -> Vec<WorstStop> {
    let suites = problem.recordings().suites.iter();
    suites.flat_map(|suite| of_suite(problem, brakes, suite, every.max(1))).collect()
}

fn of_suite(problem: &Problem, brakes: &Brakes, suite: &Suite, every: usize) -> Vec<WorstStop> {
    let (robot, n) = (problem.robot(), problem.joints());
    let times = suite.runs.first().map_or(&[][..], |run| run.grid.times());
    let from_sample = |k: usize| {
        let side = |i: usize| {
            let (low, high) = (suite.envelope.lower(k, i), suite.envelope.upper(k, i));
            Interval::point(low).hull(Interval::point(high))
        };
        (k, stop_0(robot, brakes, &(0..2 * n).map(side).collect::<Vec<_>>()))
    };
    let samples = times.len().min(suite.envelope.len());
    let all: Vec<_> =
        (0..samples).into_par_iter().filter(|k| k % every == 0).map(from_sample).collect();
    let worst = |joint: usize| {
        let of = |value: fn(&JointStop) -> f64| {
            let values = all.iter().map(|(k, stop)| {
                let bound = if stop.stands { value(&stop.joints[joint]) } else { f64::INFINITY };
                (bound, times[*k])
            });
            values.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
        };
        let (way, way_from) = of(|joint| joint.way[1].max(-joint.way[0]));
        let (time, time_from) = of(|joint| joint.time[1]);
        WorstStop {
            suite: suite.entry.name.clone(),
            joint: robot.joints()[joint].name.clone(),
            way,
            way_from,
            time,
            time_from,
            proved: all.iter().filter(|(_, stop)| stop.stands).count(),
            samples: all.len(),
        }
    };
    (0..n).map(worst).collect()
}
