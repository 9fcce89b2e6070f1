//! Inverse dynamics by recursive Newton-Euler.

use crate::algebra::{Pose, Sym3, Vec3, det2, mul, scale, sum2};
use crate::chain::Link;
use crate::workspace::LinkScratch;
use crate::{Robot, Workspace};
use reachtube_scalar::Scalar;

/// Motion of a link in its own coordinates.
pub(crate) struct Motion<S> {
    pub angular_velocity: Vec3<S>,
    pub angular_acceleration: Vec3<S>,
    /// Acceleration of the frame's origin.
    pub acceleration: Vec3<S>,
}

/// K = [α]× + ω ωᵀ - |ω|² 1: a point at r accelerates by a + K r. Row by row.
pub(crate) struct AccelerationGradient<S>([S; 9]);

impl Robot {
    /// Inverse dynamics (3): link-side torque of a motion, armature and gravity included \[N m\].
    ///
    /// `tau` = (M(q) + diag(armature)) q̈ + c(q, q̇) + g(q). All slices have one entry a joint:
    /// `sin`, `cos` of q, `qd` \[rad/s\], `qdd` \[rad/s²\]. Sine and cosine may be independent
    /// variables: off the circle s² + c² = 1 the value is this algorithm's polynomial extension,
    /// which differs from that of [`Robot::crba`].
    ///
    /// Recursive Newton-Euler (Luh, Walker & Paul 1980) with the link's second moments in place of
    /// its inertia tensor.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure of all torques for arguments in the given intervals.
    ///
    /// # Panics
    ///
    /// When a slice or the workspace is shorter than the robot has joints.
    pub fn rnea<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        qd: &[S],
        qdd: &[S],
        ws: &mut Workspace<S>,
        tau: &mut [S],
    ) {
        self.newton_euler([sin, cos, qd, qdd], self.weight(), &mut ws.links, tau);
    }

    /// Gravity as Newton-Euler takes it.
    pub(crate) fn weight<S: Scalar>(&self) -> Weight<S> {
        let acceleration = self.base_acceleration();
        if self.separate_gravity {
            Weight::Separate(acceleration)
        } else {
            Weight::Inertial(acceleration)
        }
    }

    /// The base's acceleration that acts on every mass as gravity does, in the working base frame
    /// \[m/s²\].
    pub(crate) fn base_acceleration<S: Scalar>(&self) -> Vec3<S> {
        Vec3::constant(self.working_gravity.map(|g| -g))
    }

    /// Newton-Euler over [sin q, cos q, q̇, q̈] under a weight.
    pub(crate) fn newton_euler<S: Scalar>(
        &self,
        motion: [&[S]; 4],
        weight: Weight<S>,
        scratch: &mut [LinkScratch<S>],
        tau: &mut [S],
    ) {
        let n = self.links.len();
        let [sin, cos, qd, qdd] = motion.map(|s| &s[..n]);
        let (scratch, tau) = (&mut scratch[..n], &mut tau[..n]);
        let (acceleration, mut lift) = weight.split();
        let mut state = Motion::at_rest(acceleration);
        let mut gradient = None;
        for i in 0..n {
            let link = &self.links[i];
            let pose = link.pose(&sin[i], &cos[i]);
            state = match &gradient {
                None => Motion::of_first(&pose, &state.acceleration, &qd[i], &qdd[i]),
                Some(gradient) => state.of_child(gradient, &pose, &qd[i], &qdd[i]),
            };
            let at_link = gradient.insert(state.gradient());
            let (mut force, mut moment) = link_wrench(link, &state, at_link);
            if let Some(lift) = &mut lift {
                *lift = pose.to_link(lift);
                let (weight_force, weight_moment) = link.lifted(lift);
                force.accumulate(&weight_force);
                moment.accumulate(&weight_moment);
            }
            scratch[i] = LinkScratch { pose, force, moment };
        }
        hand_down(scratch);
        for i in 0..n {
            tau[i] = scratch[i].moment.z.clone() + scale(self.links[i].armature, &qdd[i]);
        }
    }
}

/// What gravity acts on, with the acceleration of the base that has its effect.
pub(crate) enum Weight<S> {
    /// No gravity.
    None,
    /// The inertial parameters.
    Inertial(Vec3<S>),
    /// The gravity parameters.
    Separate(Vec3<S>),
}

impl<S: Scalar> Weight<S> {
    /// Acceleration of the base, and of the gravity parameters alone.
    fn split(self) -> (Vec3<S>, Option<Vec3<S>>) {
        match self {
            Self::None => (Vec3::zero(), None),
            Self::Inertial(acceleration) => (acceleration, None),
            Self::Separate(acceleration) => (Vec3::zero(), Some(acceleration)),
        }
    }
}

impl Link {
    /// Force and moment that hold the gravity parameters against an acceleration.
    #[inline(always)]
    pub(crate) fn lifted<S: Scalar>(&self, acceleration: &Vec3<S>) -> (Vec3<S>, Vec3<S>) {
        let moment = Vec3::constant(self.gravity_first_moment).cross(acceleration);
        (acceleration.scaled(&S::from(self.gravity_mass)), moment)
    }
}

/// Adds each link's force and moment to its parent's, from the tip to the base.
#[inline(always)]
pub(crate) fn hand_down<S: Scalar>(scratch: &mut [LinkScratch<S>]) {
    for i in (1..scratch.len()).rev() {
        let (before, after) = scratch.split_at_mut(i);
        after[0].hand_down(&mut before[i - 1]);
    }
}

impl<S: Scalar> LinkScratch<S> {
    /// Adds this link's force and moment to its parent's.
    #[inline(always)]
    fn hand_down(&self, parent: &mut Self) {
        let force = self.pose.to_parent(&self.force);
        parent.moment.accumulate(&self.pose.to_parent(&self.moment));
        parent.moment.accumulate(&self.pose.origin.cross(&force));
        parent.force.accumulate(&force);
    }
}

impl<S: Scalar> Motion<S> {
    /// Without velocity; only the origin accelerates.
    #[inline(always)]
    pub fn at_rest(acceleration: Vec3<S>) -> Self {
        Self { angular_velocity: Vec3::zero(), angular_acceleration: Vec3::zero(), acceleration }
    }

    /// The first link's: nothing turns below it.
    #[inline(always)]
    fn of_first(pose: &Pose<S>, base_acceleration: &Vec3<S>, qd: &S, qdd: &S) -> Self {
        Self {
            angular_velocity: Vec3::new(S::zero(), S::zero(), qd.clone()),
            angular_acceleration: Vec3::new(S::zero(), S::zero(), qdd.clone()),
            acceleration: pose.to_link(base_acceleration),
        }
    }

    #[inline(always)]
    fn of_child(
        &self,
        gradient: &AccelerationGradient<S>,
        pose: &Pose<S>,
        qd: &S,
        qdd: &S,
    ) -> Self {
        let mut w = pose.to_link(&self.angular_velocity);
        let mut dw = pose.to_link(&self.angular_acceleration);
        dw.x += mul(&w.y, qd);
        dw.y -= mul(&w.x, qd);
        dw.z += qdd.clone();
        w.z += qd.clone();
        let acceleration = pose.to_link(&gradient.times(&pose.origin).plus(&self.acceleration));
        Self { angular_velocity: w, angular_acceleration: dw, acceleration }
    }

    #[inline(always)]
    pub fn gradient(&self) -> AccelerationGradient<S> {
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

impl<S: Scalar> AccelerationGradient<S> {
    #[inline(always)]
    pub fn times(&self, r: &Vec3<S>) -> Vec3<S> {
        let k = &self.0;
        Vec3::new(
            sum2(&k[0], &r.x, &k[1], &r.y) + mul(&k[2], &r.z),
            sum2(&k[3], &r.x, &k[4], &r.y) + mul(&k[5], &r.z),
            sum2(&k[6], &r.x, &k[7], &r.y) + mul(&k[8], &r.z),
        )
    }

    /// Kᵀ v.
    #[inline(always)]
    pub fn transposed_times(&self, v: &Vec3<S>) -> Vec3<S> {
        let k = &self.0;
        Vec3::new(
            sum2(&k[0], &v.x, &k[3], &v.y) + mul(&k[6], &v.z),
            sum2(&k[1], &v.x, &k[4], &v.y) + mul(&k[7], &v.z),
            sum2(&k[2], &v.x, &k[5], &v.y) + mul(&k[8], &v.z),
        )
    }

    /// The vector of K Σ - (K Σ)ᵀ, which is I α + ω × I ω.
    #[inline(always)]
    fn moment(&self, m: &Sym3<S>) -> Vec3<S> {
        let k = &self.0;
        let spread = |a: &S, b: &S| a.clone() - b.clone();
        Vec3::new(
            det2(&k[6], &m.xy, &k[3], &m.xz)
                + det2(&k[7], &m.yy, &k[5], &m.zz)
                + mul(&spread(&k[8], &k[4]), &m.yz),
            det2(&k[1], &m.yz, &k[7], &m.xy)
                + det2(&k[2], &m.zz, &k[6], &m.xx)
                + mul(&spread(&k[0], &k[8]), &m.xz),
            det2(&k[5], &m.xz, &k[2], &m.yz)
                + det2(&k[3], &m.xx, &k[1], &m.yy)
                + mul(&spread(&k[4], &k[0]), &m.xy),
        )
    }
}

/// Force and moment about the frame's origin that move a link.
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
