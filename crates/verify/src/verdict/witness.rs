//! Motions of the model that come close to an obstacle.

use nalgebra::Vector3;
use reachtube_arm::OfArm;
use reachtube_conform::data::Case;
use reachtube_conform::{Problem, UncertaintySets};
use reachtube_reach::Disturbance;
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::Serialize;

use crate::body::body::Body;
use crate::scene::direction::direction;
use crate::scene::obstacle::{Obstacle, Solid};
use crate::scene::scenario::Scene;
use crate::verdict::clearance::Clearance;
use crate::verdict::gradient::Motion;

/// Number of searches for the worst disturbance, each along the motion found before.
const ROUNDS: usize = 3;

/// Step of the differences that give the slope of a distance, rad or m.
const DIFFERENCE: f64 = 1e-6;

/// A motion of the model with the sample at which a link is closest to an obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Witness {
    /// Name of the link: of the joint that moves it.
    pub link: String,
    /// Name of the obstacle.
    pub obstacle: String,
    /// Their distance \[m\] at that sample, in floating point; negative if they overlap.
    pub distance: f64,
    /// Time of that sample, s.
    pub time: f64,
    /// The initial state, 2n.
    pub start: Vec<f64>,
    /// The stop that ends the motion, if the link comes closest during one.
    pub stop: Option<StopOfWitness>,
    /// The input that is held from each sample to the next, samples x n; during a stop the torque
    /// of the drives.
    #[serde(skip)]
    pub inputs: Vec<f64>,
    /// The sample times, s; during a stop 2 ms apart.
    #[serde(skip)]
    pub times: Vec<f64>,
    /// The states at the samples, samples x 2n.
    #[serde(skip)]
    pub states: Vec<f64>,
}

/// The stop of a witness.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StopOfWitness {
    /// The time at which the stop begins, s.
    pub from: f64,
    /// The torque of each brake \[N m; N\].
    pub brake: Vec<f64>,
    /// The time from which the brakes hold, after the drives are off, s.
    pub delay: f64,
    /// The error of the torque of each joint after the stop began \[N m; N\].
    pub error: Vec<f64>,
}

impl Witness {
    /// Returns the state at a time (s), of the sample before or at it: at the last sample after the
    /// end.
    #[must_use]
    pub fn at(&self, time: f64) -> &[f64] {
        let width = self.start.len();
        let k = self.times.partition_point(|t| *t <= time + 1e-9).max(1) - 1;
        &self.states[k * width..(k + 1) * width]
    }
}

/// Inputs of the search for a motion.
#[derive(Clone, Copy)]
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
        let Self { case, problem, .. } = self;
        let (n, samples) = (case.parts(), case.grid.len());
        let (start, inputs) = self.nominal();
        let mut motion = Motion::new(problem.dynamics(), case, &start, &inputs);
        let mut best = self.nearest(pair, &motion, &start, &inputs);
        let mut sample = (pair.step + 1).min(samples - 1);
        for _ in 0..ROUNDS {
            let Some(q) = motion.states.get(sample * 2 * n..sample * 2 * n + n) else { break };
            let functional =
                [self.surroundings().slope(pair, q, case.grid.times()[sample]), vec![0.0; n]]
                    .concat();
            let (start, inputs) = self.vertices(&motion, sample, &functional);
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

    pub(super) fn nominal(&self) -> (Vec<f64>, Vec<f64>) {
        let Self { case, sets, .. } = self;
        let shifted = |base: &[f64], centre: &[f64]| -> Vec<f64> {
            base.iter().zip(centre.iter().cycle()).map(|(x, c)| x + c).collect()
        };
        let start = shifted(&case.start, &sets.initial_set.centre);
        (start, shifted(&case.inputs, &sets.input_set.centre))
    }

    /// Returns the start and the inputs, at vertices of X0 and U, that make a functional of the
    /// state at a sample the smallest, by the linearisation along a motion.
    pub(super) fn vertices(
        &self,
        motion: &Motion,
        sample: usize,
        functional: &[f64],
    ) -> (Vec<f64>, Vec<f64>) {
        let Self { case, sets, problem, .. } = self;
        let n = case.parts();
        let (start, inputs) = self.nominal();
        let (by_start, by_input) = motion.adjoint(case, sample, functional);
        let by_input = held(by_input, n, case.grid.len(), problem.settings().disturbance);
        let vertex = |x: f64, r: f64, slope: f64| if slope > 0.0 { x - r } else { x + r };
        let radii = &sets.initial_set.radius;
        let start = (0..2 * n).map(|i| vertex(start[i], radii[i], by_start[i])).collect();
        let radii = &sets.input_set.radius;
        let slopes = inputs.iter().zip(by_input).enumerate();
        (start, slopes.map(|(at, (u, slope))| vertex(*u, radii[at % n], slope)).collect())
    }

    fn nearest(
        &self,
        pair: &Clearance,
        motion: &Motion,
        start: &[f64],
        inputs: &[f64],
    ) -> Option<Witness> {
        let (n, times) = (self.case.parts(), self.case.grid.times());
        let distances = motion.states.chunks_exact(2 * n).zip(times);
        let at = (pair.joint, pair.index);
        let around = self.surroundings();
        let distances = distances.map(|(x, t)| (around.distance(at, &x[..n], *t), *t));
        let (distance, time) = distances.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let samples = motion.states.len() / (2 * n);
        Some(Witness {
            link: pair.link.clone(),
            obstacle: pair.obstacle.clone(),
            distance,
            time,
            start: start.to_vec(),
            stop: None,
            inputs: inputs[..samples * n].to_vec(),
            times: times[..samples].to_vec(),
            states: motion.states.clone(),
        })
    }

    /// Returns the links and the obstacles.
    pub(super) fn surroundings(&self) -> Surroundings<'_> {
        Surroundings { robot: self.problem.robot(), body: self.body, scene: self.scene }
    }
}

/// The links of a robot and the obstacles.
#[derive(Clone, Copy)]
pub(super) struct Surroundings<'a> {
    pub robot: &'a Robot,
    pub body: &'a Body,
    pub scene: &'a Scene,
}

impl Surroundings<'_> {
    /// Returns the slope of the distance of a link from an obstacle in the joints' positions.
    pub(super) fn slope(&self, pair: &Clearance, q: &[f64], time: f64) -> Vec<f64> {
        let mut moved = q.to_vec();
        let mut by = |i: usize| {
            let mut at = |step: f64| {
                moved[i] = q[i] + step;
                let distance = self.distance((pair.joint, pair.index), &moved, time);
                moved[i] = q[i];
                distance
            };
            (at(DIFFERENCE) - at(-DIFFERENCE)) / (2.0 * DIFFERENCE)
        };
        (0..q.len()).map(&mut by).collect()
    }

    /// Returns the distance of the link that a joint moves from an obstacle, by their indices, in
    /// floating point.
    pub(super) fn distance(&self, (joint, index): (usize, usize), q: &[f64], time: f64) -> f64 {
        let frame = &self.robot.link_placements(q)[joint];
        let obstacle = &self.scene.obstacles[index];
        let of_link = self.body.capsules().iter().filter(|capsule| capsule.joint == joint);
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
