//! Motions of the robot and of its models under the same inputs.

use reachtube_abstraction::{ModelField, PolynomialModel};
use reachtube_ode::{Ensemble, InitialValueProblem, Outcome, VectorField};
use reachtube_robot::{DrivenBy, Robot, RobotField};
use reachtube_scalar::{Lanes, Lanewise};

use crate::motion::{Motion, SAMPLE_TIME};

/// Runge-Kutta steps per sample.
const SUBSTEPS: usize = 1;

/// Magnitude from which a state \[rad\] or \[rad/s\] has diverged: over 80 times the LWA 4P's
/// highest speed.
const BOUND: f64 = 100.0;

/// Runs that are simulated in one vector.
type Number = Lanes<8>;

/// Number of runs in a block.
pub(super) const BLOCK: usize = <Number as Lanewise>::LANES;

/// Motions of one duration, with the inputs along them.
pub(super) struct Trajectories {
    /// Sample times \[s\].
    times: Vec<f64>,
    /// Positions at the start of each motion \[rad\], n each.
    starts: Vec<Vec<f64>>,
    /// Inputs of each motion \[N m\], row-major samples x n.
    inputs: Vec<Vec<f64>>,
}

/// Velocities of a run \[rad/s\], row-major samples x n.
type Velocities = Vec<f64>;

impl Trajectories {
    /// Returns motions along the paths of `motions`, with `slowness` times their duration.
    pub(super) fn new(robot: &Robot, motions: &[Motion], slowness: f64) -> Self {
        let duration = slowness * motions[0].duration;
        let samples = (duration / SAMPLE_TIME).round() as usize;
        let input = |motion: &Motion| {
            let motion = Motion { duration, ..motion.clone() };
            (0..samples).flat_map(|k| motion.held_input(robot, k)).collect()
        };
        Self {
            times: (0..=samples).map(|k| k as f64 * SAMPLE_TIME).collect(),
            starts: motions.iter().map(|motion| motion.start.clone()).collect(),
            inputs: motions.iter().map(input).collect(),
        }
    }

    fn block(&self, number: usize) -> std::ops::Range<usize> {
        number * BLOCK..((number + 1) * BLOCK).min(self.starts.len())
    }

    /// Simulates the robot over a block by Featherstone's articulated bodies, and returns the
    /// velocities of each motion.
    pub(super) fn robot_velocities(&self, robot: &Robot, block: usize) -> Vec<Velocities> {
        let n = robot.joint_count();
        let start = |q: &Vec<f64>| [&q[..], &vec![0.0; n]].concat();
        let mut field = RobotField::<Number>::new(robot, DrivenBy::Input).by_articulated_bodies();
        let mut velocities =
            vec![Vec::with_capacity(n * self.times.len()); self.block(block).len()];
        self.run(block, &start, &mut field, |run, _, x| velocities[run].extend_from_slice(&x[n..]));
        velocities
    }

    /// Simulates a model over a block and compares it with the velocities of the robot. Returns the
    /// mean |velocity error| over time and joints \[rad/s\] for each motion; none if the model
    /// diverges.
    pub(super) fn errors(
        &self,
        model: &PolynomialModel,
        velocities: &[Velocities],
        block: usize,
    ) -> Vec<Option<f64>> {
        let n = model.joints();
        let start = |q: &Vec<f64>| model.state(q, &vec![0.0; n]);
        let mut sums = vec![0.0; self.block(block).len()];
        let add = |run: usize, sample: usize, x: &[f64]| {
            let exact = &velocities[run][sample * n..];
            sums[run] += x[n..2 * n].iter().zip(exact).map(|(a, b)| (a - b).abs()).sum::<f64>();
        };
        let outcomes = self.run(block, &start, &mut ModelField::<Number>::new(model), add);
        let count = (n * self.times.len()) as f64;
        outcomes
            .iter()
            .zip(&sums)
            .map(|(outcome, sum)| outcome.is_reached().then_some(sum / count))
            .collect()
    }

    /// Simulates the motions of a block from `start` of their positions; `observe` gets the run,
    /// the sample and the state.
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
        let runs: Vec<_> = starts
            .iter()
            .zip(inputs)
            .map(|(start, inputs)| InitialValueProblem { start, inputs })
            .collect();
        let mut ensemble = Ensemble::new(starts[0].len()).bounded_by(BOUND);
        ensemble.integrate(field, &self.times, SUBSTEPS, &runs, observe)
    }
}

#[cfg(test)]
mod tests {
    use reachtube_abstraction::{ExpansionPoint, ModelKind};
    use reachtube_ode::{DormandPrince, Tolerance};

    use super::super::full_speed_motion::full_speed_motion;
    use super::*;
    use crate::random::{SeedableRng, SplitMix64};

    /// Returns the velocities at samples, computed with adaptive steps.
    fn adaptive<F: VectorField<f64>>(
        field: &mut F,
        start: &[f64],
        motions: &Trajectories,
    ) -> Vec<f64> {
        let fine = Tolerance { relative: 1e-10, absolute: 1e-10 };
        let mut velocities = Vec::new();
        let run = InitialValueProblem { start, inputs: &motions.inputs[0] };
        let outcome =
            DormandPrince::new(start.len(), fine).simulate(field, &motions.times, run, |_, x| {
                velocities.extend_from_slice(&x[6..12]);
            });
        assert!(outcome.is_reached());
        velocities
    }

    /// The oracle is another integrator, with the mass matrix in place of articulated bodies.
    #[test]
    fn errors_are_those_of_adaptive_steps() {
        let robot = Robot::lwa4p();
        let motion = full_speed_motion(&robot, 1.5, &mut SplitMix64::seed_from_u64(4)).unwrap();
        let motions = Trajectories::new(&robot, &[motion], 1.0);
        let body = [&motions.starts[0][..], &[0.0; 6]].concat();
        let exact = adaptive(&mut RobotField::new(&robot, DrivenBy::Input), &body, &motions);
        let fixed = motions.robot_velocities(&robot, 0);
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
