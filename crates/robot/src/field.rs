//! The robot with friction as a differential equation.

use crate::rnea::Weight;
use crate::{Robot, Workspace};
use reachtube_ode::VectorField;
use reachtube_scalar::Lanewise;

/// What the torque is that drives a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrivenBy {
    /// Motor torque tau_m on the link's side, (4) with (5): M_m q̈ = tau_m - tau_c(g(q), q̇) -
    /// tau_v(q̇) - c(q, q̇) - g(q).
    Motor,
    /// The input u of (11), which has gravity and Coulomb friction in it, (10): M_m q̈ = u -
    /// tau_v(q̇) - c(q, q̇).
    Input,
}

/// The equation of motion of a robot with friction, for the integrators of `reachtube-ode`: x = (q,
/// q̇) (2n; rad, rad/s), and the torque (n; N m) as the input. Over lanes each lane is a robot of
/// its own; reused, it does not allocate.
///
/// Coulomb friction jumps where a joint turns and is 0 at rest. As such it has no stiction: a joint
/// that would stick chatters about zero velocity, with an amplitude of Coulomb torque times step
/// over inertia, and an adaptive method takes ever smaller steps there.
/// [`sticking_below`](Self::sticking_below) makes it continuous.
///
/// # Examples
///
/// ```
/// use reachtube_ode::{DormandPrince, Run, Tolerance};
/// use reachtube_robot::{DrivenBy, Robot, RobotField};
///
/// let robot = Robot::lwa4p();
/// let mut field = RobotField::new(&robot, DrivenBy::Input);
/// let times = [0.0, 0.004, 0.009]; // s, as recorded
/// let run = Run { start: &[0.0; 12], inputs: &[10.0; 12] };
/// let outcome = DormandPrince::new(12, Tolerance::default()).simulate(&mut field, &times, run, |sample, x| {
///     assert_eq!(x[0] > 0.0, sample > 0);
/// });
/// assert!(outcome.is_reached());
/// ```
#[derive(Clone, Debug)]
pub struct RobotField<'a, S> {
    robot: &'a Robot,
    driven_by: DrivenBy,
    sticking_speed: f64,
    articulated: bool,
    ws: Workspace<S>,
    sin: Vec<S>,
    cos: Vec<S>,
    torque: Vec<S>,
}

impl<'a, S: Lanewise> RobotField<'a, S> {
    /// The motion of one robot.
    pub fn new(robot: &'a Robot, driven_by: DrivenBy) -> Self {
        let zeros = || vec![S::zero(); robot.joint_count()];
        let (ws, sticking_speed, articulated) = (Workspace::new(robot), 0.0, false);
        Self {
            robot,
            driven_by,
            sticking_speed,
            articulated,
            ws,
            sin: zeros(),
            cos: zeros(),
            torque: zeros(),
        }
    }

    /// The same motion by Featherstone's articulated bodies, [`Robot::aba`], in place of
    /// [`Robot::forward_dynamics`].
    #[must_use]
    pub fn by_articulated_bodies(self) -> Self {
        Self { articulated: true, ..self }
    }

    /// The same with Coulomb friction in proportion to |q̇| below a speed \[rad/s\], and as it is
    /// from there on: a joint that would stick creeps, at that speed at most.
    ///
    /// Near rest it damps a joint with about Coulomb torque over inertia and speed \[1/s\]; steps
    /// longer than about 2.5 over that do not follow it.
    #[must_use]
    pub fn sticking_below(self, sticking_speed: f64) -> Self {
        Self { sticking_speed, ..self }
    }

    /// Turns the load of gravity in `self.torque` into the link-side torque tau_m - tau_c - tau_v.
    fn take_off_friction(&mut self, qd: &[S], tau_motor: &[S]) {
        for (i, joint) in self.robot.joints().iter().enumerate() {
            let mut coulomb = joint.friction.coulomb.torque(self.torque[i], qd[i]);
            if self.sticking_speed > 0.0 {
                coulomb *= qd[i].map(|qd| (qd.abs() / self.sticking_speed).min(1.0));
            }
            self.torque[i] = tau_motor[i] - (coulomb + joint.friction.viscous.torque(&qd[i]));
        }
    }

    fn take_off_viscous_friction(&mut self, qd: &[S], u: &[S]) {
        for (i, joint) in self.robot.joints().iter().enumerate() {
            self.torque[i] = u[i] - joint.friction.viscous.torque(&qd[i]);
        }
    }
}

impl<S: Lanewise> VectorField<S> for RobotField<'_, S> {
    fn rate(&mut self, _: f64, x: &[S], u: &[S], dx: &mut [S]) {
        let n = self.robot.joint_count();
        let (q, qd) = x.split_at(n);
        let (velocity, acceleration) = dx.split_at_mut(n);
        velocity.copy_from_slice(qd);
        for ((sin, cos), q) in self.sin.iter_mut().zip(&mut self.cos).zip(q) {
            (*sin, *cos) = q.sin_cos();
        }
        let weight = match self.driven_by {
            DrivenBy::Motor => {
                self.robot.gravity(&self.sin, &self.cos, &mut self.ws, &mut self.torque);
                self.take_off_friction(qd, u);
                self.robot.weight()
            }
            DrivenBy::Input => {
                self.take_off_viscous_friction(qd, u);
                Weight::None
            }
        };
        let state = [&self.sin, &self.cos, qd, &self.torque];
        if self.articulated {
            self.robot.articulate(state, weight, &mut self.ws, acceleration);
        } else {
            self.robot.accelerate(state, weight, &mut self.ws, acceleration);
        }
    }
}
