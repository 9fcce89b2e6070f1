//! Motions of the model that are stopped and come close to an obstacle.

use nalgebra::DVector;

use crate::stop::category::Category;
use crate::stop::deceleration::Deceleration;
use crate::stop::path::Path;
use crate::stop::rule::StopRule;
use crate::stop::simulated::{SimulatedStop, StopCase};
use crate::verdict::clearance::Clearance;
use crate::verdict::gradient::Motion;
use crate::verdict::witness::{Approach, StopOfWitness, Witness};
use reachtube_arm::OfArm;

/// Number of pairs of a link and an obstacle that are tried, the closest first.
const PAIRS: usize = 3;

/// Number of searches for the worst disturbance, each along the motion found before.
const ROUNDS: usize = 3;

/// Steps of the simulation in 2 ms, while extremes are compared and for the witness.
const STEPS: [usize; 2] = [4, 20];

/// A simulated stop overlaps an obstacle only if it does so by more than the error of the
/// simulation, m.
pub(super) const TOUCH_OF_STOP: f64 = 1e-4;

/// The search for a motion that is stopped and comes close to an obstacle.
pub(super) struct StopSearch<'a> {
    pub approach: Approach<'a>,
    pub rule: &'a StopRule,
    /// The path along which the robot is slowed down.
    pub path: Path,
}

/// A motion with its start and its inputs, and the sample at which the stop begins.
struct Before<'a> {
    motion: &'a Motion,
    start: &'a [f64],
    inputs: &'a [f64],
    sample: usize,
}

impl StopSearch<'_> {
    /// Searches for the stopped motion that brings a link closest to an obstacle: for the pairs
    /// with the smallest proved distances, from the samples at which these are proved and from the
    /// last one. Ends at the first that touches.
    pub(super) fn closest(&self, pairs: &[Clearance], last: usize) -> Option<Witness> {
        let clearance = self.approach.scene.clearance;
        let mut best: Option<Witness> = None;
        for pair in pairs.iter().filter(|pair| pair.distance <= clearance).take(PAIRS) {
            let mut samples = vec![pair.step, last];
            samples.dedup();
            for sample in samples {
                best = closer(best, self.starting_at(pair, sample));
                if best.as_ref().is_some_and(|best| best.distance < clearance - TOUCH_OF_STOP) {
                    return best;
                }
            }
        }
        best
    }

    /// Searches for the motion whose stop from a sample comes closest: from the nominal one, each
    /// round takes the vertices of X0 and U that bring the end of the stop towards the obstacle.
    /// If stops are triggered at a distance, the motion decides the sample.
    fn starting_at(&self, pair: &Clearance, sample: usize) -> Option<Witness> {
        let Approach { problem, case, .. } = self.approach;
        let (mut start, mut inputs) = self.approach.nominal();
        let mut best = None;
        for _ in 0..ROUNDS {
            let motion = Motion::new(problem.dynamics(), case, &start, &inputs);
            let Some(sample) = self.begins(&motion, sample) else { break };
            let before = Before { motion: &motion, start: &start, inputs: &inputs, sample };
            let Some((found, functional)) = self.stopped(pair, &before) else { break };
            let is_closer =
                best.as_ref().is_none_or(|best: &Witness| found.distance < best.distance);
            best = closer(best, Some(found));
            if !is_closer {
                break;
            }
            let vertices = self.approach.vertices(&motion, sample, &functional);
            (start, inputs) = vertices;
        }
        best
    }

    fn begins(&self, motion: &Motion, sample: usize) -> Option<usize> {
        let Approach { case, body, scene, .. } = self.approach;
        let (n, times) = (case.parts(), case.grid.times());
        let Some(distance) = self.rule.distance else {
            return (motion.states.len() > sample * 2 * n).then_some(sample);
        };
        let mut joints: Vec<usize> = body.capsules().iter().map(|capsule| capsule.joint).collect();
        joints.dedup();
        motion.states.chunks_exact(2 * n).zip(times).position(|(x, time)| {
            scene.obstacles.iter().enumerate().any(|(index, obstacle)| {
                let mut concerned = joints.iter().filter(|joint| obstacle.concerns(**joint));
                concerned.any(|joint| {
                    self.approach.surroundings().distance((*joint, index), &x[..n], *time)
                        <= distance
                })
            })
        })
    }

    /// Simulates the stop of a motion under extreme brakes and errors, and returns the closest
    /// with the slope of its distance by the state at which the stop begins.
    fn stopped(&self, pair: &Clearance, before: &Before) -> Option<(Witness, Vec<f64>)> {
        let Approach { problem, case, .. } = self.approach;
        let (n, k) = (case.parts(), before.sample);
        let from = case.grid.times()[k];
        let state = &before.motion.states[k * 2 * n..(k + 1) * 2 * n];
        let towards = self.approach.surroundings().slope(pair, &state[..n], from);
        let cases = self.extremes(state, from, &towards)?;
        let robot = problem.robot();
        let nearest = |stop: &SimulatedStop| {
            let rows = stop.states.chunks_exact(2 * n).zip(&stop.times);
            let distances = rows.enumerate().map(|(at, (x, time))| {
                (
                    self.approach.surroundings().distance(
                        (pair.joint, pair.index),
                        &x[..n],
                        from + time,
                    ),
                    at,
                )
            });
            distances.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let tried = cases.into_iter().filter_map(|case| {
            let stop = case.simulate(robot, STEPS[0])?;
            Some((nearest(&stop)?.0, case))
        });
        let (_, worst) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let stop = worst.simulate(robot, STEPS[1])?;
        let (distance, at) = nearest(&stop)?;
        let end = &stop.states[at * 2 * n..at * 2 * n + n];
        let slope = self.approach.surroundings().slope(pair, end, from + stop.times[at]);
        // At a constant deceleration, the way grows with the speed by the time until standstill.
        let lasts = stop.time.iter().map(|time| time.min(stop.times[at]));
        let by_speed = slope.iter().zip(lasts).map(|(slope, lasts)| slope * lasts);
        let functional = slope.iter().copied().chain(by_speed).collect();
        let witness =
            self.witness(pair, before, (&worst, &stop), (distance, from + stop.times[at]));
        Some((witness, functional))
    }

    /// Returns the extremes of brakes, delay and errors from a state; `towards` is the slope of the
    /// distance by the positions. `None` if the path ends before the deceleration does.
    fn extremes(&self, state: &[f64], from: f64, towards: &[f64]) -> Option<Vec<StopCase>> {
        let StopRule { brakes, category, .. } = self.rule;
        let robot = self.approach.problem.robot();
        let (q, qd) = state.split_at(towards.len());
        // A torque τ accelerates by M⁻¹ τ.
        let mass = robot.mass_matrix(q).try_inverse()?;
        let by_torque = mass * DVector::from_column_slice(towards);
        let vertex = |j: usize, radius: f64| if by_torque[j] > 0.0 { -radius } else { radius };
        let drive = match category {
            Category::Zero => Vec::new(),
            Category::One { limits, input_set } => {
                let slow = Deceleration::along(robot, &self.path, from, limits)?;
                let n = towards.len();
                let torques = slow.torques().iter().enumerate();
                let error = |j: usize| input_set.centre[j] + vertex(j, input_set.radius[j]);
                torques.map(|(at, torque)| torque + error(at % n)).collect()
            }
        };
        let brake = |is_strong: &dyn Fn(usize) -> bool| {
            let of = |(j, range): (usize, &[f64; 2])| range[usize::from(is_strong(j))];
            brakes.torque.iter().enumerate().map(of).collect::<Vec<f64>>()
        };
        let [earliest, latest] = brakes.delay;
        let moves_away = |j: usize| towards[j] * qd[j] > 0.0;
        let extremes = [
            (brake(&|_| false), latest),
            (brake(&moves_away), latest),
            (brake(&|_| true), earliest),
        ];
        let of = |(brake, delay)| StopCase {
            q: q.to_vec(),
            qd: qd.to_vec(),
            brake,
            delay,
            error: brakes.error.iter().enumerate().map(|(j, r)| vertex(j, *r)).collect(),
            drive: drive.clone(),
        };
        Some(extremes.into_iter().map(of).collect())
    }

    fn witness(
        &self,
        pair: &Clearance,
        before: &Before,
        (case, stop): (&StopCase, &SimulatedStop),
        (distance, time): (f64, f64),
    ) -> Witness {
        let (n, k) = (self.approach.case.parts(), before.sample);
        let times = &self.approach.case.grid.times()[..=k];
        let from = times[k];
        let mut drive = case.drive.clone();
        drive.resize(stop.times.len() * n, 0.0);
        Witness {
            link: pair.link.clone(),
            obstacle: pair.obstacle.clone(),
            distance,
            time,
            start: before.start.to_vec(),
            stop: Some(StopOfWitness {
                from,
                brake: case.brake.clone(),
                delay: case.delay,
                error: case.error.clone(),
            }),
            inputs: [&before.inputs[..k * n], &drive].concat(),
            times: times.iter().copied().chain(stop.times[1..].iter().map(|t| from + t)).collect(),
            states: [&before.motion.states[..k * 2 * n], &stop.states].concat(),
        }
    }
}

fn closer(best: Option<Witness>, found: Option<Witness>) -> Option<Witness> {
    match (best, found) {
        (Some(best), Some(found)) if found.distance < best.distance => Some(found),
        (best, found) => best.or(found),
    }
}
