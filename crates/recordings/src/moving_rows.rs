//! Rows by which the samples of a recording are recognised in another one.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::run::Run;

/// Positions are compared in steps of this many rad or m, torques in steps of this many N m or N: a
/// copy that was written with fewer digits has most of the rows of its original.
const POSITION_STEP: f64 = 1e-5;
const TORQUE_STEP: f64 = 1e-3;

/// A joint whose position stays within this range rests, rad or m.
const REST: f64 = 0.01;

/// A joint moves where its velocity is above this part of its root mean square.
const MOVING: f64 = 0.5;

/// Number of samples that a sketch keeps.
const KEPT: usize = 64;

/// Recordings share samples if at least this many are equal at one shift of the time, and at least
/// one in [`SHARED`] of the samples that both may have then.
const FEWEST_EQUAL: usize = 3;
const SHARED: usize = 4;

/// Shifts of the time are the same up to this, s. It is no multiple of usual sample times.
const SAME_SHIFT: f64 = 7.3e-4;

/// The time of a recording less the time of another one, in steps of 0.73 ms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TimeShift(i64);

impl TimeShift {
    /// Returns the shift from `first` to `later`, s.
    #[must_use]
    pub fn new(first: f64, later: f64) -> Self {
        Self(((later - first) / SAME_SHIFT).round() as i64)
    }

    /// Returns how many of `times`, moved by the shift, lie between 0 and `duration`, s.
    #[must_use]
    pub fn within(self, times: &[f64], duration: f64) -> usize {
        let shift = self.0 as f64 * SAME_SHIFT;
        times.iter().filter(|time| (0.0..=duration).contains(&(*time + shift))).count()
    }

    /// Returns the shift the other way.
    #[must_use]
    pub fn back(self) -> Self {
        Self(-self.0)
    }

    /// Returns whether recordings share samples of which `equal` are equal at one shift, of
    /// `possible` that both may have.
    #[must_use]
    pub fn is_shared(equal: usize, possible: usize) -> bool {
        equal >= FEWEST_EQUAL && SHARED * equal >= possible
    }
}

/// Some samples of a recording, by which another one that shares samples with it is recognised when
/// it is no longer at hand.
///
/// They are the 64 moving samples with the smallest hashes, so that they are as good as random, and
/// the same in a copy. A recording with a part p of the samples has
/// about 64 p of them, and is recognised from 3 on, at one shift of the time: for p = 1/5 in all
/// but one case in 10,000, for p = 1/10 in 96 %, for p = 1/20 in 62 %. A recording that shares none
/// is taken for one that does if positions and torques of 3 samples, rounded to 1e-5 rad and
/// 1e-3 N m, are equal by chance at one shift.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RowSketch {
    /// Number of samples at which the robot moves.
    pub moving: usize,
    /// The upper halves of their hashes.
    pub keys: Vec<u32>,
    /// Their times since the first sample, s.
    pub times: Vec<f64>,
}

impl RowSketch {
    /// Returns the sketch of a run.
    #[must_use]
    pub fn of(run: &Run) -> Self {
        let mut rows = run.moving_rows();
        let moving = rows.len();
        rows.sort_unstable();
        rows.truncate(KEPT);
        Self {
            moving,
            keys: rows.iter().map(|row| row.upper_half()).collect(),
            times: rows.iter().map(|row| run.times[row.sample]).collect(),
        }
    }

    /// Returns whether a run, whose [moving rows](Run::moving_rows) are sorted, shares samples with
    /// the recording of this sketch.
    #[must_use]
    pub fn shares_samples(&self, run: &Run, rows: &[MovingRow]) -> bool {
        let mut equal: BTreeMap<TimeShift, usize> = BTreeMap::new();
        for (key, time) in self.keys.iter().zip(&self.times) {
            let place = rows.partition_point(|row| row.upper_half() < *key);
            if let Some(row) = rows.get(place).filter(|row| row.upper_half() == *key) {
                *equal.entry(TimeShift::new(*time, run.times[row.sample])).or_insert(0) += 1;
            }
        }
        // A run with fewer samples, as a thinned one, cannot have all of the sketch.
        let most = (self.keys.len() * rows.len()).div_ceil(self.moving.max(1));
        let possible = |shift: TimeShift| shift.within(&self.times, run.duration()).min(most);
        equal.iter().any(|(shift, equal)| TimeShift::is_shared(*equal, possible(*shift)))
    }
}

/// A sample at which the robot moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct MovingRow {
    /// Hash of the positions and torques, rounded to 1e-5 rad and 1e-3 N m.
    pub key: u64,
    /// Index of the sample.
    pub sample: usize,
}

impl MovingRow {
    fn upper_half(&self) -> u32 {
        (self.key >> 32) as u32
    }
}

impl Run {
    /// Returns the samples at which a joint moves. A robot at rest repeats its samples, so that
    /// equal ones do not show that recordings share any.
    #[must_use]
    pub fn moving_rows(&self) -> Vec<MovingRow> {
        let limits = self.moving_speeds();
        let is_moving = |k: &usize| self.is_moving(*k, &limits);
        let row = |sample| MovingRow { key: self.row_key(sample), sample };
        (0..self.len()).filter(is_moving).map(row).collect()
    }

    /// Returns the speed above which each joint moves, rad/s or m/s: half of its root mean square,
    /// and infinity for a joint that rests.
    #[must_use]
    pub fn moving_speeds(&self) -> Vec<f64> {
        let limit = |joint: usize| {
            let positions = (0..self.len()).map(|k| self.q(k)[joint]);
            let range =
                positions.clone().fold(f64::MIN, f64::max) - positions.fold(f64::MAX, f64::min);
            let squares: f64 = (0..self.len()).map(|k| self.qd(k)[joint].powi(2)).sum();
            match range > REST {
                true => MOVING * (squares / self.len() as f64).sqrt(),
                false => f64::INFINITY,
            }
        };
        (0..self.joints).map(limit).collect()
    }

    /// Returns whether a joint moves at sample `k`, faster than `limits` has for it.
    #[must_use]
    pub fn is_moving(&self, k: usize, limits: &[f64]) -> bool {
        self.qd(k).iter().zip(limits).any(|(speed, limit)| speed.abs() > *limit)
    }

    /// Returns the hash of the rounded positions and torques of a sample.
    fn row_key(&self, k: usize) -> u64 {
        let positions = self.q(k).iter().map(|q| q / POSITION_STEP);
        let torques = self.torque(k).iter().map(|tau| tau / TORQUE_STEP);
        // The mixing of MurmurHash3, for each number.
        positions.chain(torques).fold(self.joints as u64, |hash, number| {
            let mixed = (hash ^ number.round() as i64 as u64).wrapping_mul(0xff51_afd7_ed55_8ccd);
            (mixed ^ (mixed >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53).rotate_left(29)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a joint that rests for 50 samples and then moves for 50.
    fn run(noise: f64) -> Run {
        let times: Vec<f64> = (0..100).map(|k| 0.01 * f64::from(k)).collect();
        let state = |t: &f64| if *t < 0.5 { [0.0, 0.0] } else { [t - 0.5 + noise, 1.0] };
        let states = times.iter().flat_map(state).collect();
        let torques = times.iter().map(|t| t.sin() + noise).collect();
        Run::new(1, times, states, torques).unwrap()
    }

    #[test]
    fn rows_of_a_moving_robot_are_recognised_with_fewer_digits() {
        let rows = run(0.0).moving_rows();
        let samples: Vec<usize> = rows.iter().map(|row| row.sample).collect();
        assert_eq!(samples, (50..100).collect::<Vec<_>>());
        let mut keys: Vec<u64> = rows.iter().map(|row| row.key).collect();
        keys.dedup();
        assert_eq!(keys.len(), 50, "each row has a key of its own");
        let equal = |other: &Run| {
            let others = other.moving_rows();
            rows.iter().zip(&others).filter(|(a, b)| a.key == b.key).count()
        };
        assert!(equal(&run(1e-7)) > 40, "{}", equal(&run(1e-7)));
        assert_eq!(equal(&run(2e-3)), 0);
    }

    #[test]
    fn a_sketch_recognises_a_recording_without_some_of_its_samples() {
        let state = |t: f64| [(1.3 * t).sin() + 0.3 * (5.0 * t).sin(), 1.5 * (5.0 * t).cos() + 2.0];
        let with = |times: Vec<f64>| {
            let states = times.iter().flat_map(|t| state(*t)).collect();
            let torques = times.iter().map(|t| (7.0 * t).sin()).collect();
            Run::new(1, times, states, torques).unwrap()
        };
        let times = |from: u32, until: u32, step: usize| {
            (from..until).step_by(step).map(|k| 0.002 * f64::from(k)).collect::<Vec<_>>()
        };
        let whole = with(times(0, 4000, 1));
        let sketch = RowSketch::of(&whole);
        assert_eq!((sketch.keys.len(), sketch.times.len()), (64, 64));
        let shares = |other: &Run| {
            let mut rows = other.moving_rows();
            rows.sort_unstable();
            sketch.shares_samples(other, &rows)
        };
        let without_one: Vec<f64> =
            times(0, 4000, 1).into_iter().filter(|t| (t - 3.0).abs() > 1e-3).collect();
        assert_eq!(without_one.len(), 3999);
        assert!(shares(&whole) && shares(&with(without_one)));
        assert!(shares(&with(times(0, 4000, 4))), "a thinned one");
        assert!(shares(&with(times(2000, 6000, 1))), "an overlap by half");
        assert!(shares(&with(times(1000, 2000, 1))), "a quarter of it");
        assert!(!shares(&with(times(4000, 8000, 1))), "it goes on, and shares no sample");
    }

    #[test]
    fn a_robot_at_rest_has_no_moving_row() {
        let states = (0..50).flat_map(|k| [1e-3 * f64::from(k % 3), 0.1]).collect();
        let run = Run::new(1, (0..50).map(f64::from).collect(), states, vec![0.0; 50]).unwrap();
        assert_eq!(run.moving_rows(), []);
    }
}
