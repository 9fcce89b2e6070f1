//! The controllers of the virtual robot. They use the nominal model only.

use std::collections::VecDeque;

use reachtube_robot::{Robot, Workspace};

use super::elementary::{sin_cos, tanh};
use super::parameters::VirtualRobotParameters;
use super::rounding::rounded;
use super::truth::VirtualRobot;
use crate::motion::Planned;

/// Decimals of a command and of an input \[N m\]: 1 mN m.
const TORQUE_DECIMALS: usize = 3;

/// The controllers, and the commands that are under way to the motors.
pub(super) struct Controller<'a> {
    parameters: &'a VirtualRobotParameters,
    nominal: &'a Robot,
    ws: Workspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    gravity: Vec<f64>,
    desired: Vec<f64>,
    /// The input u of the last cycle \[N m\], n.
    pub input: Vec<f64>,
    /// Commands, the newest last: as many as are needed for the delay.
    commands: VecDeque<Vec<f64>>,
}

impl<'a> Controller<'a> {
    /// Returns controllers that have held the arm at rest at `q` \[rad\] by the nominal gravity
    /// torque.
    pub(super) fn at_rest(robot: &'a VirtualRobot, q: &[f64]) -> Self {
        let (nominal, zeros) = (robot.nominal(), vec![0.0; q.len()]);
        let mut controller = Self {
            parameters: robot.parameters(),
            nominal,
            ws: Workspace::new(nominal),
            sin: zeros.clone(),
            cos: zeros.clone(),
            gravity: zeros.clone(),
            desired: zeros.clone(),
            input: zeros.clone(),
            commands: VecDeque::new(),
        };
        for _ in 0..2 + robot.parameters().delay_cycles as usize {
            controller.open_loop(q, &zeros, &zeros);
        }
        controller
    }

    /// Commands the torque that follows `plan` from measured q \[rad\] and q̇ \[rad/s\]:
    /// u = M_m (q̈_d + ω² e + 2 ζ ω ė) + c + τ_v, with gravity and with Coulomb friction at the
    /// planned velocity.
    pub(super) fn follow(&mut self, q: &[f64], qd: &[f64], plan: &Planned) {
        let (frequency, damping) =
            (self.parameters.natural_frequency, self.parameters.damping_ratio);
        for (i, desired) in self.desired.iter_mut().enumerate() {
            let [error, rate] = [plan.q[i] - q[i], plan.qd[i] - qd[i]];
            *desired = plan.qdd[i] + frequency * (frequency * error + 2.0 * damping * rate);
        }
        sin_cos(self.nominal.joints(), q, &mut self.sin, &mut self.cos);
        // Newton-Euler includes the nominal gravity, which `command` adds.
        let Self { nominal, sin, cos, desired, input, gravity, ws, .. } = self;
        nominal.rnea(sin, cos, qd, desired, ws, input);
        nominal.gravity(sin, cos, ws, gravity);
        for (i, joint) in nominal.joints().iter().enumerate() {
            input[i] += joint.friction.viscous.torque(&qd[i]) - gravity[i];
            input[i] = rounded(input[i], TORQUE_DECIMALS);
        }
        self.command(&plan.qd);
    }

    /// Commands an input \[N m\] with gravity at measured q \[rad\], and with Coulomb friction at
    /// the planned velocity \[rad/s\].
    pub(super) fn open_loop(&mut self, q: &[f64], planned: &[f64], input: &[f64]) {
        self.input.copy_from_slice(input);
        sin_cos(self.nominal.joints(), q, &mut self.sin, &mut self.cos);
        self.nominal.gravity(&self.sin, &self.cos, &mut self.ws, &mut self.gravity);
        self.command(planned);
    }

    /// Adds the nominal gravity, and the nominal Coulomb friction at the planned velocity
    /// \[rad/s\], to the input. At the measured velocity, compensation would let a joint that
    /// sticks stay where it is.
    fn command(&mut self, planned: &[f64]) {
        let delay = 2 + self.parameters.delay_cycles as usize;
        let recycled = if self.commands.len() < delay { None } else { self.commands.pop_front() };
        let mut command = recycled.unwrap_or_else(|| vec![0.0; self.input.len()]);
        for (i, joint) in self.nominal.joints().iter().enumerate() {
            let [load, qd] = [self.gravity[i], planned[i]];
            let smooth = tanh(qd.abs() / self.parameters.compensation_speed);
            let coulomb = joint.friction.coulomb.torque(load, qd) * smooth;
            command[i] = rounded(self.input[i] + load + coulomb, TORQUE_DECIMALS);
        }
        self.commands.push_back(command);
    }

    pub(super) fn newest(&self) -> &[f64] {
        &self.commands[self.commands.len() - 1]
    }

    /// Returns the torques that act during a cycle \[N m\] and the part of the cycle at which the
    /// second replaces the first \[-\].
    pub(super) fn acting(&self) -> ([&[f64]; 2], f64) {
        let whole = self.parameters.delay_cycles.floor();
        let newest = self.commands.len() - 1 - whole as usize;
        ([&self.commands[newest - 1], &self.commands[newest]], self.parameters.delay_cycles - whole)
    }
}
