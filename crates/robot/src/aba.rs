//! Forward dynamics by articulated bodies.

use crate::algebra::{Pose, Sym3, Vec3, mul};
use crate::chain::Link;
use crate::rnea::{Motion, Weight, link_wrench};
use crate::workspace::{ArticulatedBody, ArticulatedScratch};
use crate::{Robot, Workspace};
use reachtube_scalar::Scalar;

impl Robot {
    /// Forward dynamics (4) by the articulated-body algorithm: q̈ \[rad/s²\], armature and gravity
    /// included.
    ///
    /// Slices have one entry a joint: `sin`, `cos` of q, `qd` \[rad/s\], link-side torque `tau` \[N
    /// m\]. Linear in the number of joints (Featherstone, IJRR 1983); equals
    /// [`Robot::forward_dynamics`] on s² + c² = 1.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure; all reals where a pivot encloses 0.
    pub fn aba<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        qd: &[S],
        tau: &[S],
        ws: &mut Workspace<S>,
        qdd: &mut [S],
    ) {
        self.articulate([sin, cos, qd, tau], self.weight(), ws, qdd);
    }

    /// Forward dynamics over [sin q, cos q, q̇, tau] under a weight.
    pub(crate) fn articulate<S: Scalar>(
        &self,
        [sin, cos, qd, tau]: [&[S]; 4],
        weight: Weight<S>,
        ws: &mut Workspace<S>,
        qdd: &mut [S],
    ) {
        let Workspace { links, articulated, torque, .. } = ws;
        let base_acceleration = match weight {
            Weight::None => Vec3::zero(),
            Weight::Inertial(acceleration) => acceleration,
            Weight::Separate(_) => {
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

    /// The algorithm over [sin q, cos q, q̇, tau] with the inertial parameters, the base
    /// accelerating.
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
        let mut motion = Motion::at_rest(Vec3::zero());
        for (i, link) in self.links.iter().enumerate() {
            motion = scratch[i].start(link, link.pose(&sin[i], &cos[i]), &motion, &qd[i]);
        }
        for i in (0..n).rev() {
            let (before, after) = scratch.split_at_mut(i);
            after[0].condense(self.links[i].armature, &tau[i]);
            if let Some(parent) = before.last_mut() {
                after[0].hand_down(&mut parent.body);
            }
        }
        let (mut angular, mut linear) = (Vec3::zero(), base_acceleration);
        for (state, qdd) in scratch.iter().zip(qdd) {
            let at_origin = angular.cross(&state.pose.origin).plus(&linear);
            angular = state.pose.to_link(&angular).plus(&state.bias_angular);
            linear = state.pose.to_link(&at_origin).plus(&state.bias_linear);
            let load = state.axis_moment.dot(&angular) + state.axis_force.dot(&linear);
            *qdd = (state.drive.clone() - load) * state.inverse_pivot.clone();
            angular.z += qdd.clone();
        }
    }
}

impl<S: Scalar> ArticulatedScratch<S> {
    /// Fills in what velocity alone decides; gives the link's motion at zero joint acceleration.
    #[inline(always)]
    fn start(&mut self, link: &Link, pose: Pose<S>, parent: &Motion<S>, qd: &S) -> Motion<S> {
        let still = S::zero();
        let swing = parent.angular_velocity.cross(&parent.angular_velocity.cross(&pose.origin));
        let mut angular_velocity = pose.to_link(&parent.angular_velocity);
        self.bias_angular =
            Vec3::new(mul(&angular_velocity.y, qd), -mul(&angular_velocity.x, qd), still);
        self.bias_linear = pose.to_link(&swing);
        self.pose = pose;
        angular_velocity.z += qd.clone();
        let motion = Motion {
            angular_velocity,
            angular_acceleration: Vec3::zero(),
            acceleration: Vec3::zero(),
        };
        let (force, moment) = link_wrench(link, &motion, &motion.gradient());
        self.body = ArticulatedBody::rigid(link, force, moment);
        motion
    }

    /// Takes the joint's freedom out of the body: what is left is felt through the joint.
    #[inline(always)]
    fn condense(&mut self, armature: f64, tau: &S) {
        let body = &mut self.body;
        self.axis_moment =
            Vec3::new(body.inertia.xz.clone(), body.inertia.yz.clone(), body.inertia.zz.clone());
        self.axis_force = body.coupling[2].clone();
        self.inverse_pivot = S::one() / (self.axis_moment.z.clone() + S::from(armature));
        self.drive = tau.clone() - body.moment.z.clone();
        let moment = self.axis_moment.scaled(&self.inverse_pivot);
        let force = self.axis_force.scaled(&self.inverse_pivot);
        body.inertia.subtract_product(&self.axis_moment, &moment);
        body.mass.subtract_product(&self.axis_force, &force);
        let [x, y, z] = &mut body.coupling;
        x.subtract(&self.axis_force.scaled(&moment.x));
        y.subtract(&self.axis_force.scaled(&moment.y));
        z.subtract(&self.axis_force.scaled(&moment.z));
        let (push_moment, push_force) = body.times(&self.bias_angular, &self.bias_linear);
        body.moment.accumulate(&push_moment.plus(&moment.scaled(&self.drive)));
        body.force.accumulate(&push_force.plus(&force.scaled(&self.drive)));
    }

    /// Adds the condensed body to the parent's, in the parent's coordinates.
    #[inline(always)]
    fn hand_down(&self, parent: &mut ArticulatedBody<S>) {
        let (pose, body, p) = (&self.pose, &self.body, &self.pose.origin);
        let force = pose.to_parent(&body.force);
        parent.moment.accumulate(&pose.to_parent(&body.moment));
        parent.moment.accumulate(&p.cross(&force));
        parent.force.accumulate(&force);
        let mass = pose.symmetric_to_parent(&body.mass);
        let turned = pose.general_to_parent(&body.coupling);
        let shifted = plus_cross_times(p, &turned, &mass);
        parent.mass.accumulate(&mass);
        parent.inertia.accumulate(&pose.symmetric_to_parent(&body.inertia));
        parent.inertia.add_shift(p, &turned, &shifted);
        parent.coupling.iter_mut().zip(&shifted).for_each(|(c, s)| c.accumulate(s));
    }
}

/// H + [p]× M.
#[inline(always)]
fn plus_cross_times<S: Scalar>(p: &Vec3<S>, h: &[Vec3<S>; 3], m: &Sym3<S>) -> [Vec3<S>; 3] {
    let rows = [
        Vec3::new(m.xx.clone(), m.xy.clone(), m.xz.clone()),
        Vec3::new(m.xy.clone(), m.yy.clone(), m.yz.clone()),
        Vec3::new(m.xz.clone(), m.yz.clone(), m.zz.clone()),
    ];
    let row = |h: &Vec3<S>, a: usize, pa: &S, b: usize, pb: &S| {
        let mut sum = h.clone().plus(&rows[a].scaled(pa));
        sum.subtract(&rows[b].scaled(pb));
        sum
    };
    [row(&h[0], 2, &p.y, 1, &p.z), row(&h[1], 0, &p.z, 2, &p.x), row(&h[2], 1, &p.x, 0, &p.y)]
}

impl<S: Scalar> ArticulatedBody<S> {
    /// A link on its own: H = [h]×.
    #[inline(always)]
    fn rigid(link: &Link, force: Vec3<S>, moment: Vec3<S>) -> Self {
        let [x, y, z] = link.first_moment;
        let [xx, xy, xz, yy, yz, zz] = link.second_moments;
        Self {
            inertia: Sym3::constant([yy + zz, -xy, -xz, xx + zz, -yz, xx + yy]),
            coupling: [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]].map(Vec3::constant),
            mass: Sym3::constant([link.mass, 0.0, 0.0, link.mass, 0.0, link.mass]),
            moment,
            force,
        }
    }

    /// (moment, force) for an acceleration.
    #[inline(always)]
    fn times(&self, angular: &Vec3<S>, linear: &Vec3<S>) -> (Vec3<S>, Vec3<S>) {
        let [x, y, z] = &self.coupling;
        let lever = Vec3::new(x.dot(linear), y.dot(linear), z.dot(linear));
        let mut force = self.mass.times(linear).plus(&x.scaled(&angular.x));
        force.accumulate(&y.scaled(&angular.y));
        force.accumulate(&z.scaled(&angular.z));
        (self.inertia.times(angular).plus(&lever), force)
    }
}

impl<S: Scalar> Vec3<S> {
    #[inline(always)]
    fn subtract(&mut self, b: &Self) {
        self.x -= b.x.clone();
        self.y -= b.y.clone();
        self.z -= b.z.clone();
    }
}

impl<S: Scalar> Sym3<S> {
    /// Subtracts a bᵀ, for b parallel to a.
    #[inline(always)]
    fn subtract_product(&mut self, a: &Vec3<S>, b: &Vec3<S>) {
        self.xx -= mul(&a.x, &b.x);
        self.xy -= mul(&a.x, &b.y);
        self.xz -= mul(&a.x, &b.z);
        self.yy -= mul(&a.y, &b.y);
        self.yz -= mul(&a.y, &b.z);
        self.zz -= mul(&a.z, &b.z);
    }

    /// Adds [p]× H'ᵀ - H [p]×, symmetric for H' = H + [p]× M.
    #[inline(always)]
    fn add_shift(&mut self, p: &Vec3<S>, h: &[Vec3<S>; 3], shifted: &[Vec3<S>; 3]) {
        let lift = |s: &Vec3<S>| p.cross(s);
        // Row i of H [p]× is h_i × p.
        let (x, y, z) = (lift(&shifted[0]), lift(&shifted[1]), lift(&shifted[2]));
        let drop = |h: &Vec3<S>| p.cross(h);
        let (hx, hy, hz) = (drop(&h[0]), drop(&h[1]), drop(&h[2]));
        self.xx += x.x + hx.x;
        self.xy += y.x.clone() + hx.y;
        self.xz += z.x.clone() + hx.z;
        self.yy += y.y + hy.y;
        self.yz += z.y + hy.z;
        self.zz += z.z + hz.z;
    }
}

impl<S: Scalar> Pose<S> {
    /// E H Eᵀ for the rows of H.
    #[inline(always)]
    fn general_to_parent(&self, h: &[Vec3<S>; 3]) -> [Vec3<S>; 3] {
        let [x, y, z] = [0, 1, 2].map(|i| self.to_parent(&h[i]));
        let column =
            |a: &S, b: &S, c: &S| self.to_parent(&Vec3::new(a.clone(), b.clone(), c.clone()));
        let (a, b, c) =
            (column(&x.x, &y.x, &z.x), column(&x.y, &y.y, &z.y), column(&x.z, &y.z, &z.z));
        [Vec3::new(a.x, b.x, c.x), Vec3::new(a.y, b.y, c.y), Vec3::new(a.z, b.z, c.z)]
    }
}
