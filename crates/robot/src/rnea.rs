//! Inverse dynamics by the recursive Newton-Euler algorithm.

use crate::algebra::scale;
use crate::gravity::{GravityLoad, gravity_wrench};
use crate::motion::{Motion, link_wrench};
use crate::robot::Robot;
use crate::workspace::{LinkScratch, Workspace, accumulate_to_parents};
use nalgebra::DVector;
use reachtube_scalar::{Kernel, Scalar};

/// The arguments of [`Robot::newton_euler`].
struct NewtonEuler<'a, S> {
    robot: &'a Robot,
    motion: [&'a [S]; 4],
    gravity: GravityLoad<S>,
    scratch: &'a mut [LinkScratch<S>],
    tau: &'a mut [S],
}

impl<S: Scalar> Kernel for NewtonEuler<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.robot.newton_euler_passes(self.motion, self.gravity, self.scratch, self.tau);
    }
}

impl Robot {
    /// Computes inverse dynamics (3): the link-side torque of a motion \[N m\], armature and
    /// gravity included.
    ///
    /// `tau` = (M(q) + diag(armature)) q̈ + c(q, q̇) + g(q). All slices have one entry per joint:
    /// `sin`, `cos` of [`Robot::sin_cos`], `qd` \[rad/s\], `qdd` \[rad/s²\]. Sine and cosine may be
    /// independent variables: off the circle s² + c² = 1 the value is this algorithm's polynomial
    /// extension, which differs from the extension of [`Robot::crba`].
    ///
    /// Recursive Newton-Euler algorithm (Luh, Walker & Paul 1980) with the link's second moments in
    /// place of its inertia tensor.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure of all torques for arguments in the given intervals.
    ///
    /// # Panics
    ///
    /// Panics if a slice or the workspace has fewer entries than the robot has joints.
    pub fn rnea<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        qd: &[S],
        qdd: &[S],
        ws: &mut Workspace<S>,
        tau: &mut [S],
    ) {
        self.newton_euler([sin, cos, qd, qdd], self.gravity_load(), &mut ws.links, tau);
    }

    /// Runs Newton-Euler for the motion [sin q, cos q, q̇, q̈] under a gravity load.
    pub(crate) fn newton_euler<S: Scalar>(
        &self,
        motion: [&[S]; 4],
        gravity: GravityLoad<S>,
        scratch: &mut [LinkScratch<S>],
        tau: &mut [S],
    ) {
        S::dispatch(NewtonEuler { robot: self, motion, gravity, scratch, tau });
    }

    /// Runs the passes of [`newton_euler`](Self::newton_euler) within a kernel.
    #[inline(always)]
    pub(crate) fn newton_euler_passes<S: Scalar>(
        &self,
        motion: [&[S]; 4],
        gravity: GravityLoad<S>,
        scratch: &mut [LinkScratch<S>],
        tau: &mut [S],
    ) {
        let n = self.links.len();
        let [sin, cos, qd, qdd] = motion.map(|s| &s[..n]);
        let (scratch, tau) = (&mut scratch[..n], &mut tau[..n]);
        let (acceleration, mut gravity_acceleration) = gravity.split();
        let mut state = Motion::at_rest(acceleration);
        let mut gradient = None;
        // Outward pass: motion of each link, and the wrench that it takes.
        for i in 0..n {
            let link = &self.links[i];
            let pose = link.pose(&sin[i], &cos[i]);
            state = match &gradient {
                None => {
                    Motion::of_first_link(link.kind, &pose, &state.acceleration, &qd[i], &qdd[i])
                }
                Some(gradient) => state.of_child(link.kind, gradient, &pose, &qd[i], &qdd[i]),
            };
            let link_gradient = gradient.insert(state.gradient());
            let (mut force, mut moment) = link_wrench(link, &state, link_gradient);
            if let Some(acceleration) = &mut gravity_acceleration {
                *acceleration = pose.to_link(acceleration);
                let (gravity_force, gravity_moment) = gravity_wrench(link, acceleration);
                force.accumulate(&gravity_force);
                moment.accumulate(&gravity_moment);
            }
            scratch[i] = LinkScratch { pose, force, moment };
        }
        // Inward pass: wrenches add up towards the base, and their axis components are the torques.
        accumulate_to_parents(scratch);
        for i in 0..n {
            let link = &self.links[i];
            let torque = link.axis_component(&scratch[i].force, &scratch[i].moment);
            tau[i] = torque + scale(link.armature, &qdd[i]);
        }
    }

    /// Returns the link-side torque of (3) \[N m\] at q \[rad\], q̇ \[rad/s\], q̈ \[rad/s²\].
    pub fn inverse_dynamics(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> DVector<f64> {
        let (sin, cos) = self.sin_cos(q);
        let mut tau = DVector::zeros(q.len());
        self.rnea(&sin, &cos, qd, qdd, &mut Workspace::new(self), tau.as_mut_slice());
        tau
    }
}
