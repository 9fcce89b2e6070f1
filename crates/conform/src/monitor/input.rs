//! The input u of samples, without allocation.

use reachtube_recordings::{Sample, Torque};
use reachtube_robot::{Robot, Workspace};

use crate::error::Result;
use crate::monitor::residual::Residual;

/// Evaluates the input of the model as [`Torque::input`] does.
#[derive(Debug, Clone)]
pub(crate) struct InputOf {
    robot: Robot,
    torque: Torque,
    workspace: Workspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    gravity: Vec<f64>,
}

impl InputOf {
    pub(crate) fn new(robot: &Robot, torque: Torque) -> Self {
        let zeros = || vec![0.0; robot.joint_count()];
        let workspace = Workspace::new(robot);
        let (sin, cos, gravity) = (zeros(), zeros(), zeros());
        Self { robot: robot.clone(), torque, workspace, sin, cos, gravity }
    }

    /// Returns the residual of samples that are `step` \[s\] apart.
    ///
    /// # Errors
    ///
    /// As [`Residual::new`].
    pub(crate) fn residual(&self, step: f64) -> Result<Residual> {
        Residual::new(&self.robot, self.torque, step)
    }

    /// Computes the input at a sample into `input` (n).
    pub(crate) fn evaluate(&mut self, sample: &Sample, input: &mut [f64]) {
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
