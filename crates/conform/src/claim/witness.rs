//! The verdict on recorded points.

use std::fmt::Write;

use reachtube_recordings::State;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::notion::Notion;
use crate::data::problem::Problem;
use crate::data::side::Side;
use crate::tube::judged::{At, Judged, PointOutside};
use crate::tube::tube::Tube;
use crate::tube::witness::Witness;

/// A state is named in a combination when its part is at least this of the largest.
const NAMED: f64 = 0.1;

/// Whether recorded points lie in the reachable set itself, or in its projections on the phase
/// planes, and where not. A point is the measured state of one run at one sample; it counts once
/// for each phase plane.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointVerdict {
    /// In which directions points must lie in the set.
    pub notion: Notion,
    /// Number of points after the first sample of each run. At the first one the set is a box, and
    /// the rows say all.
    pub points: usize,
    /// How many of them were not proved to lie in the set.
    pub unproved: usize,
    /// How many of these lie outside, to rounding; the others are too close to the boundary.
    pub outside: usize,
    /// The point furthest outside.
    pub worst: Option<PointWitness>,
}

/// A recorded point outside the reachable set, with the combination of states that shows it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointWitness {
    /// The suite.
    pub suite: String,
    /// The recording.
    pub run: String,
    /// Sample, from 0.
    pub sample: usize,
    /// Time since the first sample, s.
    pub time: f64,
    /// The combination l of the states, 2n entries; the entry of its leading state is 1 or -1.
    pub direction: Vec<f64>,
    /// The combination in words, such as `qd1 - 3.2 q1`, with the leading state first and without
    /// states that hardly count.
    pub combination: String,
    /// The combination's value at the point, from the centre of the set, in the unit of its leading
    /// state.
    pub value: f64,
    /// The largest value that the set reaches.
    pub reach: f64,
}

/// What a direction shows of a point outside a set.
pub(crate) struct SeparatedPoint<'a> {
    pub suite: usize,
    pub file: &'a str,
    pub sample: usize,
    /// Time since the first sample, s.
    pub time: f64,
    /// The radii of the set's interval hull, 2n.
    pub hull: &'a [f64],
    /// The point from the centre of the set, 2n.
    pub deviation: &'a [f64],
    /// l, 2n.
    pub direction: &'a [f64],
    /// By which factor the set would have to grow at least.
    pub ratio: f64,
}

impl PointVerdict {
    pub(crate) fn new(problem: &Problem, tube: &Tube, judged: &Judged) -> Self {
        let worst = judged.furthest.iter().max_by(|a, b| a.1.ratio.total_cmp(&b.1.ratio));
        let witness = |((at, _), outside): (&(At, u32), &PointOutside)| {
            let (time, hull) = (tube.time(*at), tube.radii(*at));
            let point = SeparatedPoint {
                suite: outside.owner.0 as usize,
                file: &outside.file,
                sample: at.1 as usize,
                time,
                hull: &hull,
                deviation: &outside.deviation,
                direction: &outside.direction,
                ratio: outside.ratio,
            };
            PointWitness::new(problem, &point)
        };
        Self {
            notion: problem.settings().notion,
            points: judged.points,
            unproved: judged.unproved_count(),
            outside: judged.outside,
            worst: worst.map(witness),
        }
    }
}

impl PointWitness {
    pub(crate) fn new(problem: &Problem, point: &SeparatedPoint) -> Self {
        let SeparatedPoint { hull, deviation, direction, .. } = point;
        let parts: Vec<f64> =
            hull.iter().zip(*direction).map(|(radius, l)| (radius * l).abs()).collect();
        let leading = leading(&parts);
        let unit = direction[leading].abs();
        let direction: Vec<f64> = direction.iter().map(|l| l / unit).collect();
        let value: f64 = deviation.iter().zip(&direction).map(|(d, l)| d * l).sum();
        Self {
            suite: problem.recordings().suites[point.suite].entry.name.clone(),
            run: point.file.into(),
            sample: point.sample,
            time: point.time,
            combination: combination(&direction, &parts, problem.inputs()),
            direction,
            value,
            reach: value / point.ratio,
        }
    }

    pub(crate) fn leading_state(&self) -> State {
        State::from_index(self.leading_index(), self.direction.len() / 2)
    }

    fn leading_index(&self) -> usize {
        self.direction.iter().position(|l| l.abs() == 1.0).unwrap_or(0)
    }

    pub(crate) fn into_witness(self) -> Witness {
        let (index, state) = (self.leading_index(), self.leading_state());
        let Self { suite, run, sample, time, direction, value, reach, .. } = self;
        Witness {
            suite,
            run,
            sample,
            time,
            part: state.part + 1,
            state,
            side: if direction[index] > 0.0 { Side::Upper } else { Side::Lower },
            excess: value - reach,
            radius: reach,
        }
    }
}

fn leading(parts: &[f64]) -> usize {
    (0..parts.len()).max_by(|&i, &l| parts[i].total_cmp(&parts[l])).unwrap_or(0)
}

/// The combination in words: the leading state first, then the others by their parts.
fn combination(direction: &[f64], parts: &[f64], inputs: usize) -> String {
    let largest = parts[leading(parts)];
    let mut named: Vec<usize> = (0..parts.len()).filter(|i| parts[*i] >= NAMED * largest).collect();
    named.sort_by(|&i, &l| parts[l].total_cmp(&parts[i]));
    let mut words = String::new();
    for i in named {
        let sign = match (words.is_empty(), direction[i] < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let factor = match direction[i].abs() {
            1.0 => String::new(),
            size => format!("{} ", three_digits(size)),
        };
        let _ = write!(words, "{sign}{factor}{}", State::from_index(i, inputs));
    }
    words
}

fn three_digits(x: f64) -> String {
    let digits = (2.0 - x.log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{x:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::combination;

    #[test]
    fn a_combination_names_the_states_that_count_and_the_leading_one_first() {
        let words = combination(&[-3.2, 0.0, 1.0, 0.015], &[0.5, 0.0, 1.0, 0.001], 2);
        assert_eq!(words, "qd1 - 3.20 q1");
        assert_eq!(combination(&[-1.0, 0.25], &[2.0, 1.0], 1), "-q1 + 0.250 qd1");
    }
}
