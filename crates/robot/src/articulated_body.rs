//! One link's share of the articulated-body algorithm, in the notation of Featherstone, Rigid Body
//! Dynamics Algorithms, 2008, ch. 7.

use crate::algebra::{Sym3, Vec3, mul};
use crate::joint_kind::JointKind;
use crate::link::Link;
use crate::motion::{Motion, coriolis_of_slide, link_wrench};
use crate::pose::Pose;
use reachtube_scalar::Scalar;

/// Values of one link that the articulated-body algorithm keeps between its passes.
#[derive(Clone, Debug)]
pub(crate) struct ArticulatedScratch<S> {
    pub pose: Pose<S>,
    /// Velocity-dependent angular acceleration relative to the parent.
    pub bias_angular: Vec3<S>,
    /// Velocity-dependent linear acceleration relative to the parent.
    pub bias_linear: Vec3<S>,
    pub body: ArticulatedBody<S>,
    /// Moment part of U = I^A S, the articulated inertia times the joint's axis.
    pub axis_moment: Vec3<S>,
    /// Force part of U.
    pub axis_force: Vec3<S>,
    /// 1 / D with D = Sᵀ U plus the armature.
    pub inverse_pivot: S,
    /// u = tau - Sᵀ p^A, the joint torque minus the bias torque.
    pub net_torque: S,
}

/// An articulated body: its wrench (moment, force) is [[I, H], [Hᵀ, M]] times its (angular, linear)
/// acceleration, plus the bias wrench (`moment`, `force`).
#[derive(Clone, Debug)]
pub(crate) struct ArticulatedBody<S> {
    pub inertia: Sym3<S>,
    /// Rows of H.
    pub coupling: [Vec3<S>; 3],
    pub mass: Sym3<S>,
    pub moment: Vec3<S>,
    pub force: Vec3<S>,
}

impl<S: Scalar> ArticulatedScratch<S> {
    /// Returns scratch memory with neutral contents.
    pub(crate) fn blank() -> Self {
        let zero = Vec3::zero;
        let symmetric = || Sym3::constant([0.0; 6]);
        let body = ArticulatedBody {
            inertia: symmetric(),
            coupling: [zero(), zero(), zero()],
            mass: symmetric(),
            moment: zero(),
            force: zero(),
        };
        Self {
            pose: Pose::identity(),
            bias_angular: zero(),
            bias_linear: zero(),
            body,
            axis_moment: zero(),
            axis_force: zero(),
            inverse_pivot: S::zero(),
            net_torque: S::zero(),
        }
    }

    /// Computes all terms that depend on position and velocity only, and returns the link's motion
    /// at zero joint acceleration.
    #[inline(always)]
    pub(crate) fn set_velocity_terms(
        &mut self,
        link: &Link,
        pose: Pose<S>,
        parent: &Motion<S>,
        qd: &S,
    ) -> Motion<S> {
        let zero = S::zero();
        let centripetal =
            parent.angular_velocity.cross(&parent.angular_velocity.cross(&pose.origin));
        let mut angular_velocity = pose.to_link(&parent.angular_velocity);
        self.bias_linear = pose.to_link(&centripetal);
        match link.kind {
            JointKind::Revolute => {
                self.bias_angular =
                    Vec3::new(mul(&angular_velocity.y, qd), -mul(&angular_velocity.x, qd), zero);
                angular_velocity.z += qd.clone();
            }
            JointKind::Prismatic => {
                self.bias_angular = Vec3::zero();
                self.bias_linear.accumulate(&coriolis_of_slide(&angular_velocity, qd));
            }
        }
        self.pose = pose;
        let motion = Motion {
            angular_velocity,
            angular_acceleration: Vec3::zero(),
            acceleration: Vec3::zero(),
        };
        let (force, moment) = link_wrench(link, &motion, &motion.gradient());
        self.body = ArticulatedBody::rigid(link, force, moment);
        motion
    }

    /// Replaces the body by what its parent feels through the joint: I^a = I^A - U Uᵀ / D and the
    /// bias wrench p^a = p^A + I^a c + U u / D.
    #[inline(always)]
    pub(crate) fn eliminate_joint(&mut self, link: &Link, tau: &S) {
        let body = &mut self.body;
        (self.axis_moment, self.axis_force) = body.along_axis(link.kind);
        let own = link.axis_component(&self.axis_force, &self.axis_moment);
        self.inverse_pivot = S::one() / (own + S::from(link.armature));
        self.net_torque = tau.clone() - link.axis_component(&body.force, &body.moment);
        let moment = self.axis_moment.scaled(&self.inverse_pivot);
        let force = self.axis_force.scaled(&self.inverse_pivot);
        body.inertia.subtract_product(&self.axis_moment, &moment);
        body.mass.subtract_product(&self.axis_force, &force);
        let [x, y, z] = &mut body.coupling;
        x.subtract(&self.axis_force.scaled(&moment.x));
        y.subtract(&self.axis_force.scaled(&moment.y));
        z.subtract(&self.axis_force.scaled(&moment.z));
        let (bias_moment, bias_force) = body.times(&self.bias_angular, &self.bias_linear);
        body.moment.accumulate(&bias_moment.plus(&moment.scaled(&self.net_torque)));
        body.force.accumulate(&bias_force.plus(&force.scaled(&self.net_torque)));
    }

    /// Adds the body, whose joint is eliminated, to its parent's in the parent's coordinates.
    #[inline(always)]
    pub(crate) fn accumulate_to_parent(&self, parent: &mut ArticulatedBody<S>) {
        let (pose, body, p) = (&self.pose, &self.body, &self.pose.origin);
        let force = pose.to_parent(&body.force);
        parent.moment.accumulate(&pose.to_parent(&body.moment));
        parent.moment.accumulate(&p.cross(&force));
        parent.force.accumulate(&force);
        let mass = pose.symmetric_to_parent(&body.mass);
        let rotated = pose.general_to_parent(&body.coupling);
        let shifted = plus_cross_times(p, &rotated, &mass);
        parent.mass.accumulate(&mass);
        parent.inertia.accumulate(&pose.symmetric_to_parent(&body.inertia));
        parent.inertia.add_shift(p, &rotated, &shifted);
        parent.coupling.iter_mut().zip(&shifted).for_each(|(c, s)| c.accumulate(s));
    }
}

impl<S: Scalar> ArticulatedBody<S> {
    /// Returns the body of a single link, for which H = [h]×.
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

    /// Returns the articulated inertia times a unit acceleration about or along z, as (moment,
    /// force).
    #[inline(always)]
    fn along_axis(&self, kind: JointKind) -> (Vec3<S>, Vec3<S>) {
        let [x, y, z] = &self.coupling;
        let column = |m: &Sym3<S>| Vec3::new(m.xz.clone(), m.yz.clone(), m.zz.clone());
        match kind {
            JointKind::Revolute => (column(&self.inertia), z.clone()),
            JointKind::Prismatic => {
                (Vec3::new(x.z.clone(), y.z.clone(), z.z.clone()), column(&self.mass))
            }
        }
    }

    /// Returns the articulated inertia times an acceleration, as (moment, force).
    #[inline(always)]
    fn times(&self, angular: &Vec3<S>, linear: &Vec3<S>) -> (Vec3<S>, Vec3<S>) {
        let [x, y, z] = &self.coupling;
        let coupled = Vec3::new(x.dot(linear), y.dot(linear), z.dot(linear));
        let mut force = self.mass.times(linear).plus(&x.scaled(&angular.x));
        force.accumulate(&y.scaled(&angular.y));
        force.accumulate(&z.scaled(&angular.z));
        (self.inertia.times(angular).plus(&coupled), force)
    }
}

/// Returns the rows of H + [p]× M.
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
