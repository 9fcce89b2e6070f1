//! The equation of motion of a robot with friction, as a vector field.

use crate::gravity::GravityLoad;
use crate::robot::Robot;
use crate::workspace::Workspace;
use reachtube_ode::VectorField;
use reachtube_scalar::Lanewise;
use std::borrow::Cow;

/// The torque that drives a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrivenBy {
    /// Motor torque tau_m on the link side, (4) with (5):
    /// M_m q̈ = tau_m - tau_c(g(q), q̇) - tau_v(q̇) - c(q, q̇) - g(q).
    Motor,
    /// The input u of (11), which already compensates gravity and Coulomb friction, (10):
    /// M_m q̈ = u - tau_v(q̇) - c(q, q̇).
    Input,
}

/// The equation of motion of a robot with friction, for the integrators of `reachtube-ode`.
///
/// The state is x = (q, q̇) (2n; rad, rad/s) and the input is the torque (n; N m), with m, m/s and
/// N for a prismatic joint. Over lanes, each lane is an independent run. A field that is reused
/// does not allocate.
///
/// Coulomb friction jumps where a joint changes direction and is 0 at rest, so it has no stiction.
/// A joint that would stick chatters about zero velocity, with an amplitude of Coulomb torque times
/// step over inertia, and an adaptive method takes ever smaller steps there.
/// [`regularised_below`](Self::regularised_below) makes the friction continuous.
///
/// # Examples
///
/// ```
/// use reachtube_ode::{DormandPrince, InitialValueProblem, Tolerance};
/// use reachtube_robot::{DrivenBy, Robot, RobotField};
///
/// let robot = Robot::lwa4p();
/// let mut field = RobotField::new(&robot, DrivenBy::Input);
/// let times = [0.0, 0.004, 0.009]; // s, as recorded
/// let run = InitialValueProblem { start: &[0.0; 12], inputs: &[10.0; 12] };
/// let mut solver = DormandPrince::new(12, Tolerance::default());
/// let outcome = solver.simulate(&mut field, &times, run, |sample, x| {
///     assert_eq!(x[0] > 0.0, sample > 0);
/// });
/// assert!(outcome.is_reached());
/// ```
#[derive(Clone, Debug)]
pub struct RobotField<'a, S> {
    robot: Cow<'a, Robot>,
    driven_by: DrivenBy,
    /// Speed \[rad/s; m/s\] below which Coulomb friction is linear in q̇; 0 for none.
    regularisation_speed: f64,
    articulated: bool,
    ws: Workspace<S>,
    sin: Vec<S>,
    cos: Vec<S>,
    /// The load of gravity, then the link-side torque \[N m\].
    torque: Vec<S>,
}

impl<'a, S: Lanewise> RobotField<'a, S> {
    /// Makes the equation of motion of a robot.
    pub fn new(robot: &'a Robot, driven_by: DrivenBy) -> Self {
        let zeros = || vec![S::zero(); robot.joint_count()];
        let (ws, regularisation_speed, articulated) = (Workspace::new(robot), 0.0, false);
        Self {
            robot: Cow::Borrowed(robot),
            driven_by,
            regularisation_speed,
            articulated,
            ws,
            sin: zeros(),
            cos: zeros(),
            torque: zeros(),
        }
    }

    /// Takes a copy of the robot, so that the equation can be kept beside it.
    #[must_use]
    pub fn into_owned(self) -> RobotField<'static, S> {
        let Self { robot, driven_by, regularisation_speed, articulated, ws, sin, cos, torque } =
            self;
        let robot = Cow::Owned(robot.into_owned());
        RobotField { robot, driven_by, regularisation_speed, articulated, ws, sin, cos, torque }
    }

    /// Uses the articulated-body algorithm [`Robot::aba`] in place of [`Robot::forward_dynamics`].
    #[must_use]
    pub fn by_articulated_bodies(self) -> Self {
        Self { articulated: true, ..self }
    }

    /// Regularises Coulomb friction: below a speed \[rad/s; m/s\] it is proportional to |q̇|, and
    /// above that speed it is unchanged. A joint that would stick creeps at no more than this
    /// speed.
    ///
    /// Near rest it damps a joint at a rate of about Coulomb torque over inertia and speed \[1/s\].
    /// Fixed steps should stay below about 2.5 times the inverse of this rate.
    #[must_use]
    pub fn regularised_below(self, regularisation_speed: f64) -> Self {
        Self { regularisation_speed, ..self }
    }

    /// Replaces the load of gravity in `self.torque` by the link-side torque
    /// tau_m - tau_c - tau_v.
    fn subtract_friction(&mut self, qd: &[S], tau_motor: &[S]) {
        for (i, joint) in self.robot.joints().iter().enumerate() {
            let mut coulomb = joint.friction.dry_torque(self.torque[i], qd[i]);
            if self.regularisation_speed > 0.0 {
                coulomb *= qd[i].map(|qd| (qd.abs() / self.regularisation_speed).min(1.0));
            }
            self.torque[i] = tau_motor[i] - (coulomb + joint.friction.viscous.torque(&qd[i]));
        }
    }

    /// Writes u - tau_v into `self.torque`.
    fn subtract_viscous_friction(&mut self, qd: &[S], u: &[S]) {
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
        for (i, (joint, q)) in self.robot.joints().iter().zip(q).enumerate() {
            (self.sin[i], self.cos[i]) = joint.kind.sin_cos(q);
        }
        let gravity = match self.driven_by {
            DrivenBy::Motor => {
                self.robot.gravity(&self.sin, &self.cos, &mut self.ws, &mut self.torque);
                self.subtract_friction(qd, u);
                self.robot.gravity_load()
            }
            DrivenBy::Input => {
                self.subtract_viscous_friction(qd, u);
                GravityLoad::None
            }
        };
        let state = [&self.sin, &self.cos, qd, &self.torque];
        if self.articulated {
            self.robot.aba_under(gravity, state, &mut self.ws, acceleration);
        } else {
            self.robot.forward_dynamics_under(gravity, state, &mut self.ws, acceleration);
        }
    }
}
