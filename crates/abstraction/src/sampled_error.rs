//! The truncation error of a model at sampled states.

use rand::RngExt;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::SeedableRng;
use reachtube_robot::{Robot, Workspace};

use crate::operating_box::OperatingBox;
use crate::polynomial_model::{ModelWorkspace, PolynomialModel};

/// Number of sampled states.
const SAMPLES: usize = 20_000;

/// Searches the largest truncation error |f - f_p| of each joint in a box, n, rad/s².
///
/// The search evaluates [`SAMPLES`] random states, half of whose values are at an end of the box,
/// and climbs from the best of them.
///
/// # Guarantee
///
/// Inner, up to rounding: the largest error is at least the result.
pub(crate) fn sampled_error(
    model: &PolynomialModel,
    robot: &Robot,
    operating_box: &OperatingBox,
) -> Vec<f64> {
    let n = robot.joint_count();
    let sides: Vec<[f64; 2]> = [&operating_box.q, &operating_box.qd, &operating_box.u]
        .into_iter()
        .flatten()
        .copied()
        .collect();
    let mut random = SplitMix64::seed_from_u64(1);
    let mut errors = Errors::new(model, robot);
    let mut best = vec![(0.0, Vec::new()); n];
    for _ in 0..SAMPLES {
        let point = |[low, high]: &[f64; 2]| match -1.0 + 2.0 * random.random::<f64>() {
            part if part < -0.5 => *low,
            part if part > 0.5 => *high,
            part => low + (part + 0.5) * (high - low),
        };
        let z: Vec<f64> = sides.iter().map(point).collect();
        for (best, error) in best.iter_mut().zip(errors.at(&z)) {
            if error.abs() > best.0 {
                *best = (error.abs(), z.clone());
            }
        }
    }
    best.into_iter()
        .enumerate()
        .map(|(joint, (error, z))| climb(&mut errors, &sides, joint, z, error))
        .collect()
}

/// Moves one coordinate after the other as long as the error of `joint` grows, by ever smaller
/// steps, and returns the largest error found.
fn climb(
    errors: &mut Errors,
    sides: &[[f64; 2]],
    joint: usize,
    mut z: Vec<f64>,
    mut largest: f64,
) -> f64 {
    for shrink in [1.0, 0.25, 0.0625, 0.015625] {
        for i in 0..z.len() {
            let [low, high] = sides[i];
            for sign in [-1.0, 1.0] {
                let before = z[i];
                z[i] = (before + sign * shrink * (high - low)).clamp(low, high);
                let error = errors.at(&z)[joint].abs();
                if error > largest {
                    largest = error;
                } else {
                    z[i] = before;
                }
            }
        }
    }
    largest
}

/// Forward dynamics minus model, with scratch memory for many evaluations.
struct Errors<'a> {
    model: &'a PolynomialModel,
    robot: &'a Robot,
    robot_scratch: Workspace<f64>,
    model_scratch: ModelWorkspace<f64>,
    rate: Vec<f64>,
    torque: Vec<f64>,
    error: Vec<f64>,
}

impl<'a> Errors<'a> {
    fn new(model: &'a PolynomialModel, robot: &'a Robot) -> Self {
        let n = robot.joint_count();
        Self {
            model,
            robot,
            robot_scratch: Workspace::new(robot),
            model_scratch: model.workspace(),
            rate: vec![0.0; model.states()],
            torque: vec![0.0; n],
            error: vec![0.0; n],
        }
    }

    /// Returns f - f_p of each joint at z = (q, q̇, u), n, rad/s².
    fn at(&mut self, z: &[f64]) -> &[f64] {
        let n = self.error.len();
        let (q, rest) = z.split_at(n);
        let (qd, u) = rest.split_at(n);
        let (sin, cos) = self.robot.sin_cos(q);
        // The forward dynamics subtracts gravity, which u does not contain.
        self.robot.gravity(&sin, &cos, &mut self.robot_scratch, &mut self.torque);
        for (i, joint) in self.robot.joints().iter().enumerate() {
            self.torque[i] += u[i] - joint.friction.viscous.torque(&qd[i]);
        }
        let Self { robot_scratch, torque, error, .. } = self;
        self.robot.forward_dynamics(&sin, &cos, qd, torque, robot_scratch, error);
        self.model.rate_into(&self.model.state(q, qd), u, &mut self.model_scratch, &mut self.rate);
        self.error.iter_mut().zip(&self.rate[n..]).for_each(|(e, f)| *e -= f);
        &self.error
    }
}
