//! Forward dynamics by the articulated-body algorithm.

use crate::algebra::Vec3;
use crate::articulated_body::ArticulatedScratch;
use crate::gravity::GravityLoad;
use crate::joint_kind::JointKind;
use crate::motion::Motion;
use crate::robot::Robot;
use crate::workspace::Workspace;
use reachtube_scalar::Scalar;

impl Robot {
    /// Computes forward dynamics (4) by the articulated-body algorithm: q̈ \[rad/s²\], armature and
    /// gravity included.
    ///
    /// All slices have one entry per joint: `sin`, `cos` of [`Robot::sin_cos`], `qd` \[rad/s\],
    /// link-side torque `tau` \[N m\]. The cost is linear in the number of joints (Featherstone,
    /// IJRR 1983). The result equals the result of [`Robot::forward_dynamics`] on s² + c² = 1.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure, which is all reals if a pivot encloses 0.
    pub fn aba<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        qd: &[S],
        tau: &[S],
        ws: &mut Workspace<S>,
        qdd: &mut [S],
    ) {
        self.aba_under(self.gravity_load(), [sin, cos, qd, tau], ws, qdd);
    }

    /// Runs the algorithm for [sin q, cos q, q̇, tau] under a gravity load.
    pub(crate) fn aba_under<S: Scalar>(
        &self,
        gravity: GravityLoad<S>,
        [sin, cos, qd, tau]: [&[S]; 4],
        ws: &mut Workspace<S>,
        qdd: &mut [S],
    ) {
        let Workspace { links, articulated, torque, .. } = ws;
        let base_acceleration = match gravity {
            GravityLoad::None => Vec3::zero(),
            GravityLoad::Inertial(acceleration) => acceleration,
            GravityLoad::Separate(_) => {
                self.gravity_pass(sin, cos, links, torque);
                torque.iter_mut().zip(tau).for_each(|(g, t)| *g = t.clone() - g.clone());
                return self.articulated_bodies(
                    [sin, cos, qd, torque],
                    Vec3::zero(),
                    articulated,
                    qdd,
                );
            }
        };
        self.articulated_bodies([sin, cos, qd, tau], base_acceleration, articulated, qdd);
    }

    /// Runs the three passes for [sin q, cos q, q̇, tau], the inertial parameters and an
    /// accelerating base.
    fn articulated_bodies<S: Scalar>(
        &self,
        inputs: [&[S]; 4],
        base_acceleration: Vec3<S>,
        scratch: &mut [ArticulatedScratch<S>],
        qdd: &mut [S],
    ) {
        let n = self.links.len();
        let [sin, cos, qd, tau] = inputs.map(|s| &s[..n]);
        let (scratch, qdd) = (&mut scratch[..n], &mut qdd[..n]);
        // Pass 1, outward: velocities, and the bias wrench of each link.
        let mut motion = Motion::at_rest(Vec3::zero());
        for (i, link) in self.links.iter().enumerate() {
            let pose = link.pose(&sin[i], &cos[i]);
            motion = scratch[i].set_velocity_terms(link, pose, &motion, &qd[i]);
        }
        // Pass 2, inward: articulated inertias and bias wrenches.
        for i in (0..n).rev() {
            let (before, after) = scratch.split_at_mut(i);
            after[0].eliminate_joint(&self.links[i], &tau[i]);
            if let Some(parent) = before.last_mut() {
                after[0].accumulate_to_parent(&mut parent.body);
            }
        }
        // Pass 3, outward: accelerations.
        let (mut angular, mut linear) = (Vec3::zero(), base_acceleration);
        for ((state, link), qdd) in scratch.iter().zip(&self.links).zip(qdd) {
            let at_origin = angular.cross(&state.pose.origin).plus(&linear);
            angular = state.pose.to_link(&angular).plus(&state.bias_angular);
            linear = state.pose.to_link(&at_origin).plus(&state.bias_linear);
            let load = state.axis_moment.dot(&angular) + state.axis_force.dot(&linear);
            *qdd = (state.net_torque.clone() - load) * state.inverse_pivot.clone();
            match link.kind {
                JointKind::Revolute => angular.z += qdd.clone(),
                JointKind::Prismatic => linear.z += qdd.clone(),
            }
        }
    }
}
