//! Velocity and acceleration of a link, and the wrench that moves it.

use crate::algebra::{Sym3, Vec3, det2, mul, sum2};
use crate::joint_kind::JointKind;
use crate::link::Link;
use crate::pose::Pose;
use reachtube_scalar::Scalar;

/// The motion of a link in its own coordinates.
pub(crate) struct Motion<S> {
    pub angular_velocity: Vec3<S>,
    pub angular_acceleration: Vec3<S>,
    /// Acceleration of the frame's origin.
    pub acceleration: Vec3<S>,
}

/// The matrix K = [α]× + ω ωᵀ - |ω|² 1, row by row: a point at r accelerates by a + K r.
pub(crate) struct AccelerationGradient<S>([S; 9]);

impl<S: Scalar> Motion<S> {
    /// Returns a motion without velocity in which only the origin accelerates.
    #[inline(always)]
    pub(crate) fn at_rest(acceleration: Vec3<S>) -> Self {
        Self { angular_velocity: Vec3::zero(), angular_acceleration: Vec3::zero(), acceleration }
    }

    /// Returns the motion of the first link, whose parent does not rotate.
    #[inline(always)]
    pub(crate) fn of_first_link(
        kind: JointKind,
        pose: &Pose<S>,
        base_acceleration: &Vec3<S>,
        qd: &S,
        qdd: &S,
    ) -> Self {
        let along_z = |x: &S| Vec3::new(S::zero(), S::zero(), x.clone());
        let mut acceleration = pose.to_link(base_acceleration);
        match kind {
            JointKind::Revolute => Self {
                angular_velocity: along_z(qd),
                angular_acceleration: along_z(qdd),
                acceleration,
            },
            JointKind::Prismatic => {
                acceleration.z += qdd.clone();
                Self::at_rest(acceleration)
            }
        }
    }

    /// Returns the motion of the next link from this link's motion and acceleration gradient.
    #[inline(always)]
    pub(crate) fn of_child(
        &self,
        kind: JointKind,
        gradient: &AccelerationGradient<S>,
        pose: &Pose<S>,
        qd: &S,
        qdd: &S,
    ) -> Self {
        let mut w = pose.to_link(&self.angular_velocity);
        let mut dw = pose.to_link(&self.angular_acceleration);
        let mut acceleration = pose.to_link(&gradient.times(&pose.origin).plus(&self.acceleration));
        match kind {
            JointKind::Revolute => {
                dw.x += mul(&w.y, qd);
                dw.y -= mul(&w.x, qd);
                dw.z += qdd.clone();
                w.z += qd.clone();
            }
            JointKind::Prismatic => {
                acceleration.accumulate(&coriolis_of_slide(&w, qd));
                acceleration.z += qdd.clone();
            }
        }
        Self { angular_velocity: w, angular_acceleration: dw, acceleration }
    }

    /// Returns K of this motion.
    #[inline(always)]
    pub(crate) fn gradient(&self) -> AccelerationGradient<S> {
        let (w, a) = (&self.angular_velocity, &self.angular_acceleration);
        let (xx, yy, zz) = (mul(&w.x, &w.x), mul(&w.y, &w.y), mul(&w.z, &w.z));
        let (xy, xz, yz) = (mul(&w.x, &w.y), mul(&w.x, &w.z), mul(&w.y, &w.z));
        AccelerationGradient([
            -(yy.clone() + zz.clone()),
            xy.clone() - a.z.clone(),
            xz.clone() + a.y.clone(),
            xy + a.z.clone(),
            -(xx.clone() + zz),
            yz.clone() - a.x.clone(),
            xz - a.y.clone(),
            yz + a.x.clone(),
            -(xx + yy),
        ])
    }
}

/// Returns 2 ω × z q̇, the Coriolis acceleration of a link that slides along z.
#[inline(always)]
pub(crate) fn coriolis_of_slide<S: Scalar>(w: &Vec3<S>, qd: &S) -> Vec3<S> {
    let (x, y) = (mul(&w.y, qd), mul(&w.x, qd));
    Vec3::new(x.clone() + x, -(y.clone() + y), S::zero())
}

impl<S: Scalar> AccelerationGradient<S> {
    #[inline(always)]
    pub(crate) fn times(&self, r: &Vec3<S>) -> Vec3<S> {
        let k = &self.0;
        Vec3::new(
            sum2(&k[0], &r.x, &k[1], &r.y) + mul(&k[2], &r.z),
            sum2(&k[3], &r.x, &k[4], &r.y) + mul(&k[5], &r.z),
            sum2(&k[6], &r.x, &k[7], &r.y) + mul(&k[8], &r.z),
        )
    }

    #[inline(always)]
    pub(crate) fn transposed_times(&self, v: &Vec3<S>) -> Vec3<S> {
        let k = &self.0;
        Vec3::new(
            sum2(&k[0], &v.x, &k[3], &v.y) + mul(&k[6], &v.z),
            sum2(&k[1], &v.x, &k[4], &v.y) + mul(&k[7], &v.z),
            sum2(&k[2], &v.x, &k[5], &v.y) + mul(&k[8], &v.z),
        )
    }

    /// Returns the axial vector of K Σ - (K Σ)ᵀ, which equals I α + ω × I ω.
    #[inline(always)]
    fn moment(&self, m: &Sym3<S>) -> Vec3<S> {
        let k = &self.0;
        let difference = |a: &S, b: &S| a.clone() - b.clone();
        Vec3::new(
            det2(&k[6], &m.xy, &k[3], &m.xz)
                + det2(&k[7], &m.yy, &k[5], &m.zz)
                + mul(&difference(&k[8], &k[4]), &m.yz),
            det2(&k[1], &m.yz, &k[7], &m.xy)
                + det2(&k[2], &m.zz, &k[6], &m.xx)
                + mul(&difference(&k[0], &k[8]), &m.xz),
            det2(&k[5], &m.xz, &k[2], &m.yz)
                + det2(&k[3], &m.xx, &k[1], &m.yy)
                + mul(&difference(&k[4], &k[0]), &m.xy),
        )
    }
}

/// Returns the force, and the moment about the frame's origin, that give a link its motion.
#[inline(always)]
pub(crate) fn link_wrench<S: Scalar>(
    link: &Link,
    motion: &Motion<S>,
    gradient: &AccelerationGradient<S>,
) -> (Vec3<S>, Vec3<S>) {
    let (first_moment, second_moments) = link.moments();
    let a = &motion.acceleration;
    let force = gradient.times(&first_moment).plus(&a.scaled(&S::from(link.mass)));
    let moment = gradient.moment(&second_moments).plus(&first_moment.cross(a));
    (force, moment)
}
