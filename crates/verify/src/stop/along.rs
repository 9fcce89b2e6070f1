//! Stops from every sample of recorded motions.

use rayon::prelude::*;
use reachtube_arm::OfArm;
use reachtube_conform::data::{RunSummary, Suite};
use reachtube_conform::{Problem, SuiteReach};
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{Error, Result};
use crate::stop::brakes::Brakes;
use crate::stop::category::Category;
use crate::stop::path::Path;
use crate::stop::stop::{JointStop, Stop};

/// The stops of a joint from the samples of a motion.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct WorstStop {
    /// The suite.
    pub suite: String,
    /// The joint.
    pub joint: String,
    /// The greatest proved way to standstill, in either direction, rad or m.
    #[schemars(with = "Option<f64>")]
    pub way: f64,
    /// The time of the sample from which it is the greatest, s.
    pub way_from: f64,
    /// The latest proved time of standstill after a stop, s.
    #[schemars(with = "Option<f64>")]
    pub time: f64,
    /// The time of the sample from which it is the latest, s.
    pub time_from: f64,
    /// Number of samples from which a standstill is proved.
    pub proved: usize,
    /// Number of samples from which a stop was followed.
    pub samples: usize,
    /// Number of samples whose deceleration would lead beyond the end of the motion.
    pub skipped: usize,
}

/// Encloses the stops from the samples of all suites of a problem, every `every`th of them: from
/// all states between the lowest and the highest recorded ones, along the path in the middle of
/// them. Returns the worst for each suite and joint.
///
/// # Guarantee
///
/// Outer, as [`Category::stop`]. Ways and times are infinite if a sample has no proved standstill.
///
/// # Errors
///
/// [`Error::OtherTimes`].
pub(crate) fn stops_along(
    problem: &Problem,
    brakes: &Brakes,
    category: &Category,
    every: usize,
) -> Result<Vec<WorstStop>> {
    let of_suite = |suite: &Suite| {
        let motion = Motion::of(suite, problem.states())?;
        let from_sample = |k: usize, stop: Option<Stop>| (motion.times[k], stop);
        let question = (brakes, category, every.max(1));
        let stops = motion.stops(problem.robot(), question, from_sample);
        Ok(worst(problem.robot(), &suite.entry.name, &stops))
    };
    let all: Vec<_> = problem.recordings().suites.iter().map(of_suite).collect::<Result<_>>()?;
    Ok(all.concat())
}

/// Returns from how many samples a stop was followed, and from how many a standstill is proved.
pub(super) fn proved(stops: &[WorstStop]) -> [usize; 2] {
    let sum = |count: fn(&WorstStop) -> usize| of_suites(stops).map(count).sum();
    [sum(|worst| worst.samples), sum(|worst| worst.proved)]
}

/// Returns one of the worst stops of each suite, whose numbers of samples are the suite's.
pub(super) fn of_suites(stops: &[WorstStop]) -> impl Iterator<Item = &WorstStop> {
    let first = stops.first().map(|worst| &worst.joint);
    stops.iter().filter(move |worst| Some(&worst.joint) == first)
}

/// The stop from the sample at a time (s); `None` if its path ends too early.
type FromSample = (f64, Option<Stop>);

/// A motion: sample times, and the states at them.
pub(crate) struct Motion<'a> {
    times: &'a [f64],
    /// Row-major, samples x 2n.
    states: Vec<Interval>,
    width: usize,
}

impl<'a> Motion<'a> {
    fn of(suite: &'a Suite, width: usize) -> Result<Self> {
        let longest = suite.runs.iter().max_by_key(|run| run.samples);
        let times = longest.map_or(&[][..], |run| &run.grid.times()[..run.samples]);
        let is_part = |run: &RunSummary| run.grid.times()[..run.samples] == times[..run.samples];
        if !suite.runs.iter().all(is_part) {
            return Err(Error::OtherTimes { suite: suite.entry.name.clone() });
        }
        let side = |at: usize| {
            let (k, i) = (at / width, at % width);
            let (low, high) = (suite.envelope.lower(k, i), suite.envelope.upper(k, i));
            Interval::point(low).hull(Interval::point(high))
        };
        Ok(Self { times, states: (0..times.len() * width).map(side).collect(), width })
    }

    pub(crate) fn of_reach(reach: &'a SuiteReach) -> Self {
        let bounds = reach.lower.iter().zip(&reach.upper);
        let states = bounds.map(|(low, high)| Interval::point(*low).hull(Interval::point(*high)));
        let (states, width) = (states.collect::<Vec<_>>(), reach.dimension);
        Self { times: &reach.times[..states.len() / width], states, width }
    }

    pub(crate) fn times(&self) -> &[f64] {
        self.times
    }

    pub(crate) fn middle(&self) -> Vec<f64> {
        self.states.iter().map(|side| side.mid()).collect()
    }

    /// Encloses the stops from every `every`th sample, and returns what `of` makes of the sample
    /// and its stop.
    pub(crate) fn stops<T: Send>(
        &self,
        robot: &Robot,
        (brakes, category, every): (&Brakes, &Category, usize),
        of: impl Fn(usize, Option<Stop>) -> T + Sync,
    ) -> Vec<T> {
        if self.times.len() < 2 {
            return Vec::new();
        }
        let path = Path::through(self.times, &self.middle());
        let from_sample = |k: usize| {
            let state = &self.states[k * self.width..(k + 1) * self.width];
            of(k, category.stop(robot, brakes, (&path, self.times[k]), state))
        };
        let samples = (0..self.times.len()).into_par_iter();
        samples.filter(|k| k % every == 0).map(from_sample).collect()
    }
}

fn worst(robot: &Robot, suite: &str, stops: &[FromSample]) -> Vec<WorstStop> {
    let followed = || stops.iter().filter_map(|(time, stop)| Some((*time, stop.as_ref()?)));
    let samples = followed().count();
    let of_joint = |joint: usize| {
        let of = |value: fn(&JointStop) -> f64| {
            let values = followed().map(|(time, stop)| {
                let bound = if stop.stands { value(&stop.joints[joint]) } else { f64::INFINITY };
                (bound, time)
            });
            values.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
        };
        let (way, way_from) = of(|joint| joint.way[1].max(-joint.way[0]));
        let (time, time_from) = of(|joint| joint.time[1]);
        WorstStop {
            suite: suite.into(),
            joint: robot.joints()[joint].name.clone(),
            way,
            way_from,
            time,
            time_from,
            proved: followed().filter(|(_, stop)| stop.stands).count(),
            samples,
            skipped: stops.len() - samples,
        }
    };
    (0..robot.joint_count()).map(of_joint).collect()
}
