//! Motions of the model that come close to an obstacle.

use nalgebra::Vector3;
use reachtube_conform::data::Case;
use reachtube_conform::{Problem, UncertaintySets};
use reachtube_reach::Disturbance;
use serde::Serialize;

use crate::body::body::Body;
use crate::scene::direction::direction;
use crate::scene::obstacle::{Obstacle, Solid};
use crate::scene::scenario::Scene;
use crate::verdict::clearance::Clearance;
use crate::verdict::gradient::Motion;

/// How often the worst disturbance is sought anew, along the motion that was found before.
const ROUNDS: usize = 3;

/// Step of the differences that give the slope of a distance, rad or m.
const DIFFERENCE: f64 = 1e-6;

/// A motion of the model with the sample at which a link is closest to an obstacle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Witness {
    /// Name of the link: of the joint that moves it.
    pub link: String,
    /// Name of the obstacle.
    pub obstacle: String,
    /// Their distance \[m\] at that sample, in floating point; negative where they overlap.
    pub distance: f64,
    /// Time of that sample, s.
    pub time: f64,
    /// The initial state, 2n.
    pub start: Vec<f64>,
    /// The input that is held from each sample to the next, samples x n.
    #[serde(skip)]
    pub inputs: Vec<f64>,
    /// The sample times, s.
    #[serde(skip)]
    pub times: Vec<f64>,
    /// The states at the samples, samples x 2n.
    #[serde(skip)]
    pub states: Vec<f64>,
}

/// What the search for a motion needs.
pub(crate) struct Approach<'a> {
    pub problem: &'a Problem,
    pub case: &'a Case,
    pub sets: &'a UncertaintySets,
    pub body: &'a Body,
    pub scene: &'a Scene,
}

impl Approach<'_> {
    /// Searches for the motion of the model that brings a link closest to an obstacle: from the
    /// nominal one, each round takes the vertices of X0 and U towards the obstacle.
    pub(crate) fn closest(&self, pair: &Clearance) -> Option<Witness> {
        let Self { case, sets, problem, .. } = self;
        let (n, samples) = (case.joints(), case.grid.len());
        let shifted = |base: &[f64], centre: &[f64]| -> Vec<f64> {
            base.iter().zip(centre.iter().cycle()).map(|(x, c)| x + c).collect()
        };
        let start = shifted(&case.start, &sets.initial_set.centre);
        let inputs = shifted(&case.inputs, &sets.input_set.centre);
        let mut motion = Motion::new(problem.dynamics(), case, &start, &inputs);
        let mut best = self.nearest(pair, &motion, &start, &inputs);
        let mut sample = (pair.step + 1).min(samples - 1);
        for _ in 0..ROUNDS {
            let Some(q) = motion.states.get(sample * 2 * n..sample * 2 * n + n) else { break };
            let functional =
                [self.slope(pair, q, case.grid.times()[sample]), vec![0.0; n]].concat();
            let (by_start, by_input) = motion.adjoint(case, sample, &functional);
            let vertex = |x: f64, r: f64, slope: f64| if slope > 0.0 { x - r } else { x + r };
            let radii = &sets.initial_set.radius;
            let start: Vec<f64> =
                (0..2 * n).map(|i| vertex(start[i], radii[i], by_start[i])).collect();
            let by_input = held(by_input, n, samples, problem.settings().disturbance);
            let radii = &sets.input_set.radius;
            let inputs: Vec<f64> = inputs
                .iter()
                .zip(by_input)
                .enumerate()
                .map(|(at, (u, slope))| vertex(*u, radii[at % n], slope))
                .collect();
            motion = Motion::new(problem.dynamics(), case, &start, &inputs);
            let found = self.nearest(pair, &motion, &start, &inputs);
            let is_closer = match (&found, &best) {
                (Some(found), Some(best)) => found.distance < best.distance,
                (found, None) => found.is_some(),
                (None, _) => false,
            };
            if !is_closer {
                break;
            }
            best = found;
            let time = best.as_ref().map_or(0.0, |best| best.time);
            sample = case.grid.times().iter().position(|t| *t >= time).unwrap_or(sample).max(1);
        }
        best
    }

    /// Returns the sample of a motion at which the link is closest.
    fn nearest(
        &self,
        pair: &Clearance,
        motion: &Motion,
        start: &[f64],
        inputs: &[f64],
    ) -> Option<Witness> {
        let (n, times) = (self.case.joints(), self.case.grid.times());
        let distances = motion.states.chunks_exact(2 * n).zip(times);
        let distances = distances.map(|(x, t)| (self.distance(pair, &x[..n], *t), *t));
        let (distance, time) = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let samples = motion.states.len() / (2 * n);
        Some(Witness {
            link: pair.link.clone(),
            obstacle: pair.obstacle.clone(),
            distance,
            time,
            start: start.to_vec(),
            inputs: inputs[..samples * n].to_vec(),
            times: times[..samples].to_vec(),
            states: motion.states.clone(),
        })
    }

    /// Returns the slope of the distance by the positions, n.
    fn slope(&self, pair: &Clearance, q: &[f64], time: f64) -> Vec<f64> {
        let mut moved = q.to_vec();
        let mut by = |i: usize| {
            let mut at = |step: f64| {
                moved[i] = q[i] + step;
                let distance = self.distance(pair, &moved, time);
                moved[i] = q[i];
                distance
            };
            (at(DIFFERENCE) - at(-DIFFERENCE)) / (2.0 * DIFFERENCE)
        };
        (0..q.len()).map(&mut by).collect()
    }

    /// Returns the distance of a link from an obstacle in floating point.
    fn distance(&self, pair: &Clearance, q: &[f64], time: f64) -> f64 {
        let frame = &self.problem.robot().link_placements(q)[pair.joint];
        let obstacle = &self.scene.obstacles[pair.index];
        let of_link = self.body.capsules().iter().filter(|capsule| capsule.joint == pair.joint);
        let distances = of_link.map(|capsule| {
            let place = |end| frame.rotation * Vector3::from(end) + frame.translation;
            let ends = [place(capsule.from), place(capsule.to)];
            distance(ends, obstacle, time) - capsule.radius
        });
        distances.fold(f64::INFINITY, f64::min)
    }
}

/// Returns the distance of a segment from an obstacle, by the separating direction.
fn distance(ends: [Vector3<f64>; 2], obstacle: &Obstacle, time: f64) -> f64 {
    let normal = Vector3::from(direction(ends.map(Into::into), &obstacle.solid));
    let along = |p: &[f64; 3]| normal.dot(&Vector3::from(*p));
    let lowest = normal.dot(&ends[0]).min(normal.dot(&ends[1]));
    let (highest, radius) = match &obstacle.solid {
        Solid::HalfSpace { offset, .. } => (*offset, 0.0),
        Solid::Box { centre, axes, half } => {
            let sides = axes.iter().zip(half).map(|(axis, half)| along(axis).abs() * half);
            (along(centre) + sides.sum::<f64>(), 0.0)
        }
        Solid::Capsule { from, to, radius } => (along(from).max(along(to)), *radius),
    };
    (lowest - highest) / normal.norm() - radius - obstacle.speed * time
}

/// Returns the slopes by the inputs at all samples, as the disturbance may change: a constant one
/// has the sum of all in each.
fn held(by_input: Vec<f64>, n: usize, samples: usize, disturbance: Disturbance) -> Vec<f64> {
    let mut all = by_input;
    if disturbance == Disturbance::Constant {
        let sum = |j: usize| all.iter().skip(j).step_by(n).sum::<f64>();
        let sums: Vec<f64> = (0..n).map(sum).collect();
        return sums.iter().copied().cycle().take(samples * n).collect();
    }
    all.resize(samples * n, 0.0);
    all
}
