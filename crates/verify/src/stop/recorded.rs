//! Recorded stops beside the enclosed ones.

use reachtube_recordings::{GapLimit, ReadOptions, Run, RunSource, noise_deviations};
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Result;
use crate::stop::brakes::Brakes;
use crate::stop::category::Category;
use crate::stop::path::Path;

/// A joint stands while its speed is at most this part of its greatest one in the recording.
const STANDS: f64 = 0.01;

/// Number of joints of each recording that are compared in way and time.
const JOINTS: usize = 3;

/// A reading is off by at most this many standard deviations of the sensor's noise.
const SPREAD: f64 = 5.0;

/// Duration of the path of a stop, s.
const PATH: f64 = 100.0;

/// A joint in a recorded stop, and the stop that is proved from the first recorded state.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct RecordedStop {
    /// The recording.
    pub recording: String,
    /// The joint.
    pub joint: String,
    /// Its velocity when the stop begins, rad/s or m/s.
    pub velocity: f64,
    /// The measured way, rad or m, with its sign.
    pub way: f64,
    /// The measured time of standstill, s; `None` if the joint moves until the end.
    pub time: Option<f64>,
    /// The least and the greatest proved way; infinite if no standstill is proved.
    #[schemars(with = "[Option<f64>; 2]")]
    pub proved_way: [f64; 2],
    /// The latest proved time of standstill, s; infinite if none is proved.
    #[schemars(with = "Option<f64>")]
    pub proved_time: f64,
    /// Whether the measured way lies within the proved ones, and the time is not later.
    pub is_within: bool,
}

/// Compares the recordings of stops with what is proved from their first states, for the three
/// joints of each that move the most, and any other whose way is not proved. Each recording begins
/// when the stop begins; in a stop of category 1 the path is straight from there.
///
/// # Errors
///
/// The defects of a recording.
pub(crate) fn recorded_stops(
    robot: &Robot,
    brakes: &Brakes,
    category: &Category,
    source: &dyn RunSource,
) -> Result<Vec<RecordedStop>> {
    let options =
        ReadOptions { joints: Some(robot.joint_count()), gap_limit: GapLimit::Usual, until: None };
    let mut all = Vec::new();
    for index in 0..source.runs().len() {
        let run = source.read(index, &options).map_err(reachtube_recordings::Error::Defects)?;
        let name = source.runs()[index].file.clone();
        all.extend(compared(robot, brakes, category, (&name, &run)));
    }
    Ok(all)
}

/// Returns the recorded stop that is furthest beyond the proved one; `None` if all are within.
pub(super) fn outside(recorded: &[RecordedStop]) -> Option<&RecordedStop> {
    let beyond = |stop: &RecordedStop| {
        let [low, high] = stop.proved_way;
        (low - stop.way).max(stop.way - high)
    };
    let outside = recorded.iter().filter(|stop| !stop.is_within);
    outside.max_by(|a, b| beyond(a).total_cmp(&beyond(b)))
}

fn compared(
    robot: &Robot,
    brakes: &Brakes,
    category: &Category,
    (name, run): (&str, &Run),
) -> Vec<RecordedStop> {
    let (n, last) = (robot.joint_count(), run.len() - 1);
    let state: Vec<Interval> = run.state(0).iter().map(|x| Interval::point(*x)).collect();
    let path = Path::straight(run.q(0), run.qd(0), PATH);
    let stop = category.stop(robot, brakes, (&path, 0.0), &state).filter(|stop| stop.stands);
    let of_joint = |joint: usize| {
        let way = run.q(last)[joint] - run.q(0)[joint];
        let speed = |k: usize| run.qd(k)[joint].abs();
        let greatest = (0..=last).map(speed).fold(0.0, f64::max);
        let moving = (0..=last).rev().find(|k| speed(*k) > STANDS * greatest);
        // It stands between the sample at which it moves last, and the next.
        let [earliest, time] = match moving {
            None => [0.0, 0.0].map(Some),
            Some(k) if k < last => [k, k + 1].map(|k| Some(run.times[k])),
            Some(_) => [None; 2],
        };
        let unproved = ([f64::NEG_INFINITY, f64::INFINITY], f64::INFINITY);
        let (proved_way, proved_time) = stop.as_ref().map_or(unproved, |stop| {
            let found = &stop.joints[joint];
            (found.way, found.time[1])
        });
        RecordedStop {
            recording: name.into(),
            joint: robot.joints()[joint].name.clone(),
            velocity: run.qd(0)[joint],
            way,
            time,
            proved_way,
            proved_time,
            is_within: proved_way[0] <= way
                && way <= proved_way[1]
                && earliest.is_some_and(|time| time <= proved_time),
        }
    };
    let noise = noise_deviations(run).unwrap_or_default();
    let mut joints: Vec<(usize, RecordedStop)> = (0..n).map(of_joint).enumerate().collect();
    joints.sort_by(|(_, a), (_, b)| b.way.abs().total_cmp(&a.way.abs()));
    let rest = joints.split_off(JOINTS.min(n));
    // Another joint hardly moves: noise gives it a way, and no time.
    let sags = |(joint, stop): &(usize, RecordedStop)| {
        let room = 2.0 * SPREAD * noise.get(*joint).copied().unwrap_or(0.0);
        !(stop.proved_way[0] - room..=stop.proved_way[1] + room).contains(&stop.way)
    };
    let sagging = rest.into_iter().filter(sags);
    joints.into_iter().chain(sagging).map(|(_, stop)| stop).collect()
}

#[cfg(test)]
mod tests {
    use reachtube_recordings::MemoryRuns;

    use super::*;
    use crate::stop::simulated::StopCase;

    /// Three joints stop as they are proved to; another one, at rest, sags or shows noise.
    #[test]
    fn a_joint_that_sags_is_compared_beside_the_joints_that_move_most() {
        let robot = Robot::lwa4p();
        let brakes = Brakes::new(vec![[90.0, 100.0]; 6], [0.01, 0.02]);
        let qd = vec![0.6, 0.5, 0.4, 0.0, 0.0, 0.0];
        let brake = vec![95.0; 6];
        let (error, drive) = (vec![0.0; 6], Vec::new());
        let case = StopCase { q: vec![0.1; 6], qd, brake, delay: 0.015, error, drive };
        let found = case.simulate(&robot, 20).unwrap();
        let outside_of = |sag: f64| {
            let count = found.states.len() / 12;
            let row = |k: usize| {
                let mut row = found.states[12 * k..12 * (k + 1)].to_vec();
                row[4] +=
                    sag * k as f64 / count as f64 + if k.is_multiple_of(2) { 1e-6 } else { -1e-6 };
                row
            };
            let states = (0..count).flat_map(row).collect();
            let times = found.times.clone();
            let mut runs = MemoryRuns::default();
            let run = Run::new(6, times, states, vec![0.0; 6 * count]).unwrap();
            runs.push("stop", Some("stop"), None, run);
            let all = recorded_stops(&robot, &brakes, &Category::Zero, &runs).unwrap();
            outside(&all).map(|stop| stop.joint.clone())
        };
        assert_eq!(outside_of(0.0), None);
        assert_eq!(outside_of(0.05).as_deref(), Some("joint5"));
    }
}
