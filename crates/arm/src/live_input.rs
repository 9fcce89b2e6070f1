//! The input u of samples, without allocation.

use std::sync::Arc;

use reachtube_conform::data::LiveInput;
use reachtube_recordings::{Sample, Torque};
use reachtube_robot::{Robot, Workspace};

use crate::arm::Arm;
use crate::delayed::Delayed;

/// Evaluates the input of an arm as [`reachtube_diagnose::input`] does.
#[derive(Debug)]
pub(super) struct ArmInput {
    /// What evaluates the input; `None` where it is 0.
    evaluation: Option<Evaluation>,
    delayed: Option<Delayed>,
    /// The sample that was taken last, and whether its input was asked for.
    newest: Sample,
    is_known: bool,
    /// The input, n.
    input: Vec<f64>,
}

#[derive(Debug)]
struct Evaluation {
    robot: Arc<Robot>,
    torque: Torque,
    workspace: Workspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    gravity: Vec<f64>,
}

impl ArmInput {
    /// Prepares the input of samples that are `step` \[s\] apart.
    pub(super) fn new(arm: &Arm, step: f64) -> Self {
        let (robot, torque, n) =
            (Arc::clone(&arm.robot), arm.settings.torque, arm.robot.joint_count());
        let zeros = || vec![0.0; n];
        let delayed = Delayed::new(&robot, torque, step);
        let workspace = Workspace::new(&robot);
        let (sin, cos, gravity) = (zeros(), zeros(), zeros());
        let evaluation = Some(Evaluation { robot, torque, workspace, sin, cos, gravity });
        let newest = Sample::zeros(n);
        Self { evaluation, delayed, newest, is_known: true, input: zeros() }
    }

    /// Makes the input of `n` joints that is 0 at each sample.
    pub(super) fn zero(n: usize) -> Self {
        let (newest, input) = (Sample::zeros(n), vec![0.0; n]);
        Self { evaluation: None, delayed: None, newest, is_known: true, input }
    }
}

impl LiveInput for ArmInput {
    fn take(&mut self, sample: &Sample) {
        match &mut self.delayed {
            Some(delayed) => delayed.take(sample),
            None => {
                self.newest.copy(sample);
                self.is_known = false;
            }
        }
    }

    fn next(&mut self, is_over: bool, judge: &mut dyn FnMut(&Sample, &[f64])) -> bool {
        let Self { evaluation, delayed, newest, is_known, input } = self;
        let sample = match delayed {
            Some(delayed) => delayed.next(is_over),
            None => (!std::mem::replace(is_known, true)).then_some(&*newest),
        };
        let Some(sample) = sample else { return false };
        evaluation.iter_mut().for_each(|evaluation| evaluation.evaluate(sample, input));
        judge(sample, input);
        true
    }

    /// Torques behind the gear need the velocities of later samples, from which the motors' inertia
    /// is computed.
    fn delay(&self) -> f64 {
        self.delayed.as_ref().map_or(0.0, Delayed::delay)
    }

    fn waiting(&self) -> usize {
        self.delayed.as_ref().map_or(0, Delayed::waiting)
    }

    fn clear(&mut self) {
        self.is_known = true;
        self.delayed.iter_mut().for_each(Delayed::clear);
    }
}

impl Evaluation {
    /// Computes the input at a sample into `input` (n).
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
            input[j] = u + sample.added[j];
        }
    }
}
