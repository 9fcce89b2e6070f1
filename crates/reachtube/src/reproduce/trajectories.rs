//! Point-to-point motions of Table I, and how the robot and its models move under their inputs.

use reachtube_ode::{Ensemble, Outcome, Run, VectorField};
use reachtube_robot::{DrivenBy, Joint, Robot, RobotField};
use reachtube_scalar::{Lanes, Lanewise};

use crate::error::{Error, Result};
use crate::motion::{Motion, QUINTIC_PEAK};
use crate::random::{SplitMix64, sign, uniform};
use reachtube_abstraction::{ModelField, PolynomialModel};

/// Time over which an input is held, s.
pub(super) const SAMPLE_TIME: f64 = 0.004;

/// Runge-Kutta steps a sample.
const SUBSTEPS: usize = 1;

/// A state beyond it (rad, rad/s) has diverged: over 80 times the LWA 4P's highest speed.
const BOUND: f64 = 100.0;

/// Duration of the motions at full speed, s: joints of 1.2 rad/s travel 1.92 rad.
const DURATION: f64 = 3.0;

/// The part of a joint's position range that a motion travels, at most.
const MOST_TRAVEL: f64 = 0.9;

/// Speed limit of a joint for which none is known, rad/s.
const USUAL_SPEED: f64 = 1.2;

/// Runs that are simulated as one.
type Number = Lanes<8>;

/// How many of them there are.
pub(super) const BLOCK: usize = <Number as Lanewise>::LANES;

/// A motion with a peak of each joint's speed limit, in a random direction from a random place, at
/// positions within `range` \[rad\] of 0 and the limits.
///
/// # Errors
///
/// [`Error::Setting`] where a joint has no such position.
pub(super) fn random_motion(robot: &Robot, range: f64, random: &mut SplitMix64) -> Result<Motion> {
    let axes = robot.joints().iter().map(|joint| axis(joint, range)).collect::<Result<Vec<_>>>()?;
    let longest = |axis: &Axis| MOST_TRAVEL * (axis.high - axis.low) * QUINTIC_PEAK / axis.speed;
    let duration = axes.iter().map(longest).fold(DURATION, f64::min);
    let along = |axis: &Axis| {
        let distance = axis.speed * duration / QUINTIC_PEAK;
        let travel = sign(random) * distance;
        (uniform(random, axis.low, axis.high - distance) + (distance - travel) / 2.0, travel)
    };
    let (start, travel) = axes.iter().map(along).unzip();
    Ok(Motion { start, travel, duration })
}

/// Where a joint may be, rad, and its peak speed, rad/s.
struct Axis {
    low: f64,
    high: f64,
    speed: f64,
}

fn axis(joint: &Joint, range: f64) -> Result<Axis> {
    let [low, high] = [joint.position_limits[0].max(-range), joint.position_limits[1].min(range)];
    if low < high {
        return Ok(Axis { low, high, speed: joint.velocity_limit.unwrap_or(USUAL_SPEED) });
    }
    Err(Error::Setting(format!(
        "joint `{}` has no room within {range} rad of the expansion point 0: its limits are {:?} rad; choose a wider range",
        joint.name, joint.position_limits
    )))
}

/// Motions of one duration, and the inputs along them.
pub(super) struct Trajectories {
    /// s.
    pub times: Vec<f64>,
    starts: Vec<Vec<f64>>,
    inputs: Vec<Vec<f64>>,
}

/// Velocities of a run, sample by sample.
type Velocities = Vec<f64>;

impl Trajectories {
    /// The path of each motion, taken `slowness` times as long.
    pub fn new(robot: &Robot, motions: &[Motion], slowness: f64) -> Self {
        let duration = slowness * motions[0].duration;
        let samples = (duration / SAMPLE_TIME).round() as usize;
        let input = |motion: &Motion| {
            let motion = Motion { duration, ..motion.clone() };
            // The plan in the middle of a sample is what holding an input over the sample does
            // best.
            let at = |k: usize| motion.input(robot, (k as f64 + 0.5) * SAMPLE_TIME);
            (0..samples).flat_map(at).collect()
        };
        Self {
            times: (0..=samples).map(|k| k as f64 * SAMPLE_TIME).collect(),
            starts: motions.iter().map(|motion| motion.start.clone()).collect(),
            inputs: motions.iter().map(input).collect(),
        }
    }

    /// The motions of one block.
    pub fn block(&self, number: usize) -> std::ops::Range<usize> {
        number * BLOCK..((number + 1) * BLOCK).min(self.starts.len())
    }

    /// Velocities of the robot over a block, by Featherstone's articulated bodies.
    pub fn of_robot(&self, robot: &Robot, block: usize) -> Vec<Velocities> {
        let n = robot.joint_count();
        let start = |q: &Vec<f64>| [&q[..], &vec![0.0; n]].concat();
        let mut field = RobotField::<Number>::new(robot, DrivenBy::Input).by_articulated_bodies();
        let mut velocities =
            vec![Vec::with_capacity(n * self.times.len()); self.block(block).len()];
        self.run(block, &start, &mut field, |run, _, x| velocities[run].extend_from_slice(&x[n..]));
        velocities
    }

    /// Mean |velocity error| of a model against velocities of the robot, over time and joints
    /// \[rad/s\], for each motion of a block; none where the model diverges.
    pub fn errors(
        &self,
        model: &PolynomialModel,
        robot: &[Velocities],
        block: usize,
    ) -> Vec<Option<f64>> {
        let n = model.joints();
        let start = |q: &Vec<f64>| model.state(q, &vec![0.0; n]);
        let mut sums = vec![0.0; self.block(block).len()];
        let add = |run: usize, sample: usize, x: &[f64]| {
            let velocities = &robot[run][sample * n..];
            sums[run] +=
                x[n..2 * n].iter().zip(velocities).map(|(a, b)| (a - b).abs()).sum::<f64>();
        };
        let outcomes = self.run(block, &start, &mut ModelField::<Number>::new(model), add);
        let count = (n * self.times.len()) as f64;
        outcomes
            .iter()
            .zip(&sums)
            .map(|(outcome, sum)| outcome.is_reached().then_some(sum / count))
            .collect()
    }

    fn run<F: VectorField<Number>>(
        &self,
        block: usize,
        start: &dyn Fn(&Vec<f64>) -> Vec<f64>,
        field: &mut F,
        observe: impl FnMut(usize, usize, &[f64]),
    ) -> Vec<Outcome> {
        let block = self.block(block);
        let starts: Vec<Vec<f64>> = self.starts[block.clone()].iter().map(start).collect();
        let inputs = &self.inputs[block];
        let runs: Vec<_> =
            starts.iter().zip(inputs).map(|(start, inputs)| Run { start, inputs }).collect();
        let mut ensemble = Ensemble::new(starts[0].len()).bounded_by(BOUND);
        ensemble.integrate(field, &self.times, SUBSTEPS, &runs, observe)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use reachtube_ode::{DormandPrince, Tolerance};

    use super::*;
    use crate::random::SeedableRng;
    use reachtube_abstraction::{ExpansionPoint, ModelKind};

    proptest! {
        #[test]
        fn motions_have_their_peak_and_stay_in_range(seed: u64, range in 0.01..4.0f64) {
            let robot = Robot::lwa4p();
            let motion = random_motion(&robot, range, &mut SplitMix64::seed_from_u64(seed)).unwrap();
            let peak = motion.at(motion.duration / 2.0);
            prop_assert!(peak.qd.iter().all(|qd| (qd.abs() - 1.2).abs() < 1e-12));
            for part in [0.0, 0.3, 1.0] {
                let q = motion.at(part * motion.duration).q;
                prop_assert!(q.iter().all(|q| q.abs() <= range.min(std::f64::consts::PI) + 1e-12));
            }
        }
    }

    #[test]
    fn no_range_is_refused() {
        let refusal =
            random_motion(&Robot::lwa4p(), -1.0, &mut SplitMix64::seed_from_u64(1)).unwrap_err();
        assert!(
            refusal.to_string().contains("joint1") && refusal.to_string().contains("wider range")
        );
    }

    /// Velocities at samples by adaptive steps.
    fn adaptive<F: VectorField<f64>>(
        field: &mut F,
        start: &[f64],
        motions: &Trajectories,
    ) -> Vec<f64> {
        let fine = Tolerance { relative: 1e-10, absolute: 1e-10 };
        let mut velocities = Vec::new();
        let run = Run { start, inputs: &motions.inputs[0] };
        let outcome =
            DormandPrince::new(start.len(), fine).simulate(field, &motions.times, run, |_, x| {
                velocities.extend_from_slice(&x[6..12]);
            });
        assert!(outcome.is_reached());
        velocities
    }

    /// Another integrator, and the mass matrix in place of articulated bodies.
    #[test]
    fn errors_are_those_of_adaptive_steps() {
        let robot = Robot::lwa4p();
        let motion = random_motion(&robot, 1.5, &mut SplitMix64::seed_from_u64(4)).unwrap();
        let motions = Trajectories::new(&robot, &[motion], 1.0);
        let body = [&motions.starts[0][..], &[0.0; 6]].concat();
        let exact = adaptive(&mut RobotField::new(&robot, DrivenBy::Input), &body, &motions);
        let fixed = motions.of_robot(&robot, 0);
        assert!(fixed[0].iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-7));
        for (kind, order) in [(ModelKind::One, 3), (ModelKind::Two, 12)] {
            let model =
                PolynomialModel::new(&robot, kind, order, &ExpansionPoint::zero(6)).unwrap();
            let start = model.state(&motions.starts[0], &[0.0; 6]);
            let moved = adaptive(&mut ModelField::new(&model), &start, &motions);
            let error = moved.iter().zip(&exact).map(|(a, b)| (a - b).abs()).sum::<f64>()
                / moved.len() as f64;
            let fixed = motions.errors(&model, &fixed, 0)[0].unwrap();
            assert!(error > 0.01 && (fixed - error).abs() < 1e-7, "{kind:?}: {fixed} {error}");
        }
    }
}
