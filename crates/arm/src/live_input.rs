//! The input u of samples, without allocation.

use std::sync::Arc;

use reachtube_conform::data::LiveInput;
use reachtube_recordings::{Sample, Torque};
use reachtube_robot::{Robot, Workspace};

use crate::arm::Arm;

/// Evaluates the input of an arm as [`reachtube_diagnose::input`] does.
#[derive(Debug)]
pub(super) struct ArmInput {
    robot: Arc<Robot>,
    torque: Torque,
    workspace: Workspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    gravity: Vec<f64>,
}

/// The input of a model that nothing drives: 0.
#[derive(Debug)]
pub(super) struct NoInput;

impl ArmInput {
    pub(super) fn new(arm: &Arm) -> Self {
        let (robot, torque) = (Arc::clone(&arm.robot), arm.settings.torque);
        let zeros = || vec![0.0; robot.joint_count()];
        let [sin, cos, gravity] = [zeros(), zeros(), zeros()];
        Self { workspace: Workspace::new(&robot), robot, torque, sin, cos, gravity }
    }
}

impl LiveInput for NoInput {
    fn evaluate(&mut self, _sample: &Sample, input: &mut [f64]) {
        input.fill(0.0);
    }
}

impl LiveInput for ArmInput {
    fn evaluate(&mut self, sample: &Sample, input: &mut [f64]) {
        input.copy_from_slice(sample.torque());
        if self.torque == Torque::Compensated {
            return;
        }
        let (q, qd) = sample.state().split_at(input.len());
        let Self { robot, sin, cos, gravity, workspace, .. } = self;
        for (j, joint) in robot.joints().iter().enumerate() {
            (sin[j], cos[j]) = joint.kind.sin_cos(&q[j]);
        }
        robot.gravity(sin, cos, workspace, gravity);
        for (j, joint) in robot.joints().iter().enumerate() {
            let (load, qd) = (gravity[j], qd[j]);
            let u = match self.torque {
                Torque::Motor => input[j] - joint.friction.dry_torque(load, qd) - load,
                _ => input[j] - load + joint.friction.viscous.torque(&qd),
            };
            input[j] = u;
        }
    }
}
