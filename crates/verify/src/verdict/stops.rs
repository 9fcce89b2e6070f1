//! Stops from every sample of a motion of the model.

use reachtube_conform::SuiteReach;
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up, sub_down, sub_up};
use schemars::JsonSchema;
use serde::Serialize;

use crate::body::body::Body;
use crate::scene::scenario::{Scene, WALKING};
use crate::stop::along::Motion;
use crate::stop::path::Path;
use crate::stop::rule::StopRule;
use crate::stop::stop::Stop;
use crate::verdict::clearance::{Clearance, Memory, Search};

/// Number of steps of a stop whose hull is tried first.
const STEPS: usize = 8;

/// The stops from all samples of a motion.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MotionStops {
    /// The stop category, 0 or 1.
    pub category: u8,
    /// The distance at which a stop is triggered, m; `None` if it may begin at any sample.
    pub triggered_at: Option<f64>,
    /// Number of samples from which a stop was followed.
    pub samples: usize,
    /// Number of samples from which a standstill is proved.
    pub proved: usize,
    /// Number of samples whose deceleration would lead beyond the end of the motion: stops from
    /// these are not covered.
    pub skipped: usize,
    /// The time up to which a stop was followed from every sample, s; `None` if it was not from the
    /// first.
    pub covered_until: Option<f64>,
    /// The smallest proved distance of each link from each obstacle during the stops, smallest
    /// first.
    pub clearances: Vec<StopClearance>,
    /// The distance at which a stop must be triggered for a person who walks, per link.
    pub trigger: Vec<TriggerDistance>,
    /// The stop with the smallest distance, from the time of its sample (s).
    #[serde(skip)]
    pub worst: Option<(f64, Stop)>,
    /// The smallest distances, smallest first, with the samples at which those stops begin.
    #[serde(skip)]
    pub(super) pairs: Vec<Clearance>,
    /// The last sample from which a stop was followed.
    #[serde(skip)]
    pub(super) last: usize,
}

/// The smallest proved distance between a link and an obstacle during the stops of a motion.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StopClearance {
    /// Name of the link: of the joint that moves it.
    pub link: String,
    /// Name of the obstacle.
    pub obstacle: String,
    /// A lower bound of their distance until standstill \[m\]; negative if no distance above 0 is
    /// proved, minus infinity if no standstill is.
    #[schemars(with = "Option<f64>")]
    pub distance: f64,
    /// The time of the sample at which that stop begins, s.
    pub from: f64,
}

/// How far a person must be from a link at the last sample before a stop begins: the way of the
/// link until standstill, and 1.6 m/s (ISO 13855) for that time.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TriggerDistance {
    /// Name of the link: of the joint that moves it.
    pub link: String,
    /// The distance \[m\], rounded up; infinite if a standstill is not proved.
    #[schemars(with = "Option<f64>")]
    pub distance: f64,
    /// The way of the link \[m\], rounded up.
    #[schemars(with = "Option<f64>")]
    pub way: f64,
    /// The time from the sample before the stop until standstill, s, rounded up.
    #[schemars(with = "Option<f64>")]
    pub time: f64,
    /// The time of the sample at which that stop begins, s.
    pub from: f64,
}

/// Proved bounds of the stop from a sample.
struct FromSample {
    /// The distance of each pair of a capsule and an obstacle.
    distances: Vec<f64>,
    /// The way of each capsule.
    ways: Vec<f64>,
    /// The time from the sample before until standstill.
    time: f64,
}

impl MotionStops {
    /// Follows the stops from all samples of a reachable set.
    ///
    /// # Guarantee
    ///
    /// Bounds with directed rounding, as [`Category::stop`](crate::Category::stop).
    pub(super) fn new(
        robot: &Robot,
        (body, scene): (&Body, &Scene),
        rule: &StopRule,
        reach: &SuiteReach,
    ) -> Self {
        let search = Search::new(body, scene);
        let motion = Motion::of_reach(reach);
        let StopRule { brakes, category, distance } = rule;
        let of_sample = |k: usize, stop: Option<Stop>| {
            Some(FromSample::new(&search, (body, scene), *distance, (reach, k, &stop?)))
        };
        let all = motion.stops(robot, (brakes, category, 1), of_sample);
        let covered = all.iter().take_while(|one| one.is_some()).count();
        let followed: Vec<(usize, &FromSample)> =
            all.iter().enumerate().filter_map(|(k, one)| Some((k, one.as_ref()?))).collect();
        let smallest = (0..search.pairs.len()).map(|pair| {
            let distances = followed.iter().map(|(k, one)| (one.distances[pair], *k));
            distances.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0))
        });
        let mut pairs = search.by_link(reach, &smallest.collect::<Vec<_>>());
        pairs.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let worst = pairs.first().and_then(|pair| stop_from(robot, rule, reach, pair.step));
        let clearances = pairs.iter().map(|pair| StopClearance {
            link: pair.link.clone(),
            obstacle: pair.obstacle.clone(),
            distance: pair.distance,
            from: pair.time,
        });
        Self {
            category: category.number(),
            triggered_at: *distance,
            samples: followed.len(),
            proved: followed.iter().filter(|(_, one)| one.time.is_finite()).count(),
            skipped: all.len() - followed.len(),
            covered_until: covered.checked_sub(1).map(|last| reach.times[last]),
            clearances: clearances.collect(),
            trigger: trigger(body, &followed, &reach.times),
            worst,
            last: followed.last().map_or(0, |(k, _)| *k),
            pairs,
        }
    }

    /// Returns whether each link keeps the clearance until standstill, after a stop from each
    /// sample that is covered.
    pub(super) fn is_clear(&self, scene: &Scene) -> bool {
        let clears = |pair: &StopClearance| pair.distance > scene.clearance;
        self.covered_until.is_some() && self.clearances.iter().all(clears)
    }
}

/// Encloses the stop from sample k of a reachable set, and returns it with the time of the sample
/// (s).
pub(super) fn stop_from(
    robot: &Robot,
    rule: &StopRule,
    reach: &SuiteReach,
    k: usize,
) -> Option<(f64, Stop)> {
    let (motion, width) = (Motion::of_reach(reach), reach.dimension);
    let sides = reach.lower.iter().zip(&reach.upper).skip(k * width).take(width);
    let start: Vec<Interval> =
        sides.map(|(a, b)| Interval::point(*a).hull(Interval::point(*b))).collect();
    let path = Path::through(motion.times(), &motion.middle());
    let stop = rule.category.stop(robot, &rule.brakes, (&path, reach.times[k]), &start)?;
    Some((reach.times[k], stop))
}

impl FromSample {
    /// Bounds the distances over the stop from sample k of a reachable set.
    fn new(
        search: &Search,
        (body, scene): (&Body, &Scene),
        distance: Option<f64>,
        (reach, k, stop): (&SuiteReach, usize, &Stop),
    ) -> Self {
        let mut memory = Memory::default();
        let (start, shift) = shift_until_standstill(reach, k, stop);
        let ways = body.ways(&mut memory.workspace, &start, &shift);
        if !stop.stands {
            let distances = vec![f64::NEG_INFINITY; search.pairs.len()];
            return Self { distances, ways: vec![f64::INFINITY; ways.len()], time: f64::INFINITY };
        }
        let mut distances = vec![f64::INFINITY; search.pairs.len()];
        let from = reach.times[k].next_up();
        let steps = Steps { search, scene, stop, start: from, joints: start.len() };
        steps.lower(&mut memory, [0, stop.tube.len()], &mut distances);
        let before = k.saturating_sub(1);
        if let (Some(_), true) = (distance, k > 0) {
            // The way from the sample at which no stop was triggered.
            memory.positions.clear();
            memory.positions.extend_from_slice(&reach.tube.bounds(before)[..start.len()]);
            let here = search.distances(&mut memory, from);
            distances.iter_mut().zip(here).for_each(|(found, here)| *found = found.min(here));
        }
        let standstill = stop.times.last().copied().unwrap_or(0.0);
        let time = add_up(sub_up(from, reach.times[before].next_down()), standstill);
        if let (Some(distance), true) = (distance, k > 0) {
            for (found, (capsule, obstacle)) in distances.iter_mut().zip(&search.pairs) {
                let speed = scene.obstacles[*obstacle].speed;
                let used = add_up(ways[*capsule], mul_up(speed, time));
                *found = found.max(sub_down(distance, used));
            }
        }
        Self { distances, ways, time }
    }
}

/// The steps of a stop.
struct Steps<'a> {
    search: &'a Search<'a>,
    scene: &'a Scene,
    stop: &'a Stop,
    /// The time at which it begins, s.
    start: f64,
    joints: usize,
}

impl Steps<'_> {
    /// Lowers the distances `found` (one per pair) to the distances over a range of steps. A range
    /// whose hull is too close is divided.
    fn lower(&self, memory: &mut Memory, [from, to]: [usize; 2], found: &mut [f64]) {
        let halves = [[from, from.midpoint(to)], [from.midpoint(to), to]];
        if to <= from + STEPS {
            let Some(first) = (from < to).then(|| self.stop.tube.bounds(from)) else { return };
            let mut hull = first[..self.joints].to_vec();
            for k in from + 1..to {
                let sides = hull.iter_mut().zip(self.stop.tube.bounds(k));
                sides.for_each(|(hull, side)| *hull = hull.hull(*side));
            }
            memory.positions = hull;
            let end = add_up(self.start, self.stop.times[to]);
            let here = self.search.distances(memory, end);
            let is_close = here.iter().any(|distance| *distance <= self.scene.clearance);
            if to == from + 1 || !is_close {
                found.iter_mut().zip(here).for_each(|(found, here)| *found = found.min(here));
                return;
            }
        }
        halves.into_iter().for_each(|half| self.lower(memory, half, found));
    }
}

/// Encloses the positions at the sample before a stop, and the shift of each joint from there at
/// every time until the stop from sample k ends: the integral of its velocity.
///
/// # Guarantee
///
/// Outer, directed rounding.
fn shift_until_standstill(
    reach: &SuiteReach,
    k: usize,
    stop: &Stop,
) -> (Vec<Interval>, Vec<Interval>) {
    let n = reach.dimension / 2;
    let before = k.saturating_sub(1);
    let start = |i: usize| {
        let at = before * reach.dimension + i;
        Interval::point(reach.lower[at]).hull(Interval::point(reach.upper[at]))
    };
    let (mut now, mut all) = (vec![Interval::ZERO; n], vec![Interval::ZERO; n]);
    let mut follow = |duration: Interval, sides: &[Interval]| {
        for i in 0..n {
            let velocity = sides[n + i];
            all[i] = all[i].hull(now[i] + Interval::ZERO.hull(duration) * velocity);
            now[i] += duration * velocity;
        }
    };
    if k > 0 {
        // The exact sample times are within a rounding of these.
        let [from, to] = [before, k].map(|at| {
            let time = reach.times[at];
            Interval::point(time.next_down()).hull(Interval::point(time.next_up()))
        });
        follow(to - from, reach.tube.bounds(before));
    }
    for step in 0..stop.tube.len() {
        let duration = Interval::point(stop.times[step + 1]) - stop.times[step];
        follow(duration, stop.tube.bounds(step));
    }
    ((0..n).map(start).collect(), all)
}

/// Returns the largest distance at which a stop must be triggered, for each link.
fn trigger(body: &Body, all: &[(usize, &FromSample)], times: &[f64]) -> Vec<TriggerDistance> {
    let mut links: Vec<TriggerDistance> = Vec::new();
    for (index, capsule) in body.capsules().iter().enumerate() {
        let of_sample = |(k, one): &(usize, &FromSample)| TriggerDistance {
            link: body.joint_name(capsule.joint).into(),
            distance: add_up(one.ways[index], mul_up(WALKING, one.time)),
            way: one.ways[index],
            time: one.time,
            from: times[*k],
        };
        let furthest = all.iter().map(of_sample).max_by(|a, b| a.distance.total_cmp(&b.distance));
        let Some(furthest) = furthest else { continue };
        match links.iter_mut().find(|known| known.link == furthest.link) {
            Some(known) if known.distance >= furthest.distance => {}
            Some(known) => *known = furthest,
            None => links.push(furthest),
        }
    }
    links
}
