//! The error of a model at sampled states.

use reachtube_robot::{Robot, Workspace};

use super::{OperatingBox, PolynomialModel};
use crate::random::SplitMix64;

/// States that are sampled.
const SAMPLES: usize = 20_000;

/// The largest |f - f_p| of each joint at [`SAMPLES`] states of a box, half of the values at its ends, rad/s².
///
/// # Guarantee
///
/// Inner, up to rounding: the largest error is no less.
pub(super) fn seen_error(model: &PolynomialModel, robot: &Robot, operating_box: &OperatingBox) -> Vec<f64> {
    let n = robot.joint_count();
    let mut random = SplitMix64::new(1);
    let mut errors = Errors::new(model, robot);
    let mut seen = vec![0.0; n];
    for _ in 0..SAMPLES {
        let mut draw = |sides: &[[f64; 2]]| -> Vec<f64> {
            let point = |[low, high]: &[f64; 2]| match random.uniform(-1.0, 1.0) {
                part if part < -0.5 => *low,
                part if part > 0.5 => *high,
                part => low + (part + 0.5) * (high - low),
            };
            sides.iter().map(point).collect()
        };
        let (q, qd, u) = (draw(&operating_box.q), draw(&operating_box.qd), draw(&operating_box.u));
        let found = errors.at(&q, &qd, &u);
        seen.iter_mut().zip(found).for_each(|(s, e): (&mut f64, _)| *s = s.max(e.abs()));
    }
    seen
}

/// Forward dynamics minus model, over and over.
pub(super) struct Errors<'a> {
    model: &'a PolynomialModel,
    robot: &'a Robot,
    scratch: Workspace<f64>,
    model_scratch: super::ModelWorkspace<f64>,
    rate: Vec<f64>,
    torque: Vec<f64>,
    error: Vec<f64>,
}

impl<'a> Errors<'a> {
    pub fn new(model: &'a PolynomialModel, robot: &'a Robot) -> Self {
        let n = robot.joint_count();
        Self {
            model,
            robot,
            scratch: Workspace::new(robot),
            model_scratch: model.workspace(),
            rate: vec![0.0; model.states()],
            torque: vec![0.0; n],
            error: vec![0.0; n],
        }
    }

    /// f - f_p of each joint, rad/s².
    pub fn at(&mut self, q: &[f64], qd: &[f64], u: &[f64]) -> &[f64] {
        let n = q.len();
        let (sin, cos) = self.robot.sin_cos(q);
        self.robot.gravity(&sin, &cos, &mut self.scratch, &mut self.torque);
        for (i, joint) in self.robot.joints().iter().enumerate() {
            self.torque[i] += u[i] - joint.friction.viscous.torque(&qd[i]);
        }
        self.robot.forward_dynamics(&sin, &cos, qd, &self.torque, &mut self.scratch, &mut self.error);
        self.model.rate_into(&self.model.state(q, qd), u, &mut self.model_scratch, &mut self.rate);
        self.error.iter_mut().zip(&self.rate[n..]).for_each(|(e, f)| *e -= f);
        &self.error
    }
}
