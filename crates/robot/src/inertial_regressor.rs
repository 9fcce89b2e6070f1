//! The joint-torque regressor of the inertial parameters.

use crate::algebra::{Vec3, mul, sum2};
use crate::inertia::INERTIAL;
use crate::joint_kind::JointKind;
use crate::link::Link;
use crate::motion::{AccelerationGradient, Motion};
use crate::placement::{Placement, rotation_x, rotation_z};
use crate::robot::Robot;
use nalgebra::{Matrix3, Vector3};
use reachtube_scalar::Scalar;

/// Scratch memory and constants of [`Robot::inertial_regressor`] for one robot and one scalar.
///
/// The other algorithms use the working frames; the regressor uses the links' original frames. Its
/// columns are wanted in those frames, and their conversion would cost more than the recursion.
#[derive(Clone, Debug)]
pub struct RegressorWorkspace<S> {
    frames: Vec<LinkFrame>,
    twists: Vec<Twist<S>>,
}

/// A link's original frame relative to the original frame of the previous link.
#[derive(Clone, Debug)]
struct LinkFrame {
    kind: JointKind,
    /// Rotation E(q) from the link's frame to the previous one, row by row.
    rotation: [RotationEntry; 9],
    /// A point of the joint's axis in the previous frame \[m\]; the link slides away from it.
    axis_point: [f64; 3],
    /// Unit vector of the joint's axis in the previous frame.
    axis_in_previous: [f64; 3],
    /// Unit vector of the joint's axis in the link's frame.
    axis: [f64; 3],
    /// Vector from the axis point to the frame's origin at q = 0, in the link's frame \[m\]; `None`
    /// if they coincide.
    offset: Option<[f64; 3]>,
}

/// An entry of a rotation by q: constant + sine · sin q + cosine · cos q.
#[derive(Clone, Copy, Debug)]
struct RotationEntry {
    constant: f64,
    sine: f64,
    cosine: f64,
}

/// The twist of a link while one joint moves at 1 rad/s or 1 m/s: angular velocity, and velocity of
/// the frame's origin.
#[derive(Clone, Debug)]
struct Twist<S> {
    angular: Vec3<S>,
    linear: Vec3<S>,
}

/// A rotation E at one position, row by row.
struct Rotation<S>([S; 9]);

impl<S: Scalar> RegressorWorkspace<S> {
    /// Allocates scratch memory for a robot. It fits this robot's geometry only, not every robot
    /// with as many joints.
    pub fn new(robot: &Robot) -> Self {
        let mut previous = Placement::rotation(robot.base.transpose());
        let mut frames = Vec::with_capacity(robot.joint_count());
        for link in &robot.links {
            frames.push(LinkFrame::new(link, &previous));
            previous = link.original.clone();
        }
        let rest = Twist { angular: Vec3::zero(), linear: Vec3::zero() };
        Self { twists: vec![rest; frames.len()], frames }
    }
}

impl LinkFrame {
    /// Makes the frame of a link whose previous link has its original frame at `previous` in its
    /// working frame.
    fn new(link: &Link, previous: &Placement) -> Self {
        let to_previous = previous.rotation.transpose();
        let lead = to_previous
            * rotation_x((link.sin_twist, link.cos_twist))
            * rotation_z((link.sin_offset, link.cos_offset));
        let own = &link.original.rotation;
        let part = |m: Matrix3<f64>| lead * m * own;
        let along = Matrix3::from_diagonal(&Vector3::z());
        let [constant, sine, cosine] = match link.kind {
            JointKind::Revolute => {
                [along, rotation_z((1.0, 0.0)) - along, Matrix3::identity() - along].map(part)
            }
            JointKind::Prismatic => [part(Matrix3::identity()), Matrix3::zeros(), Matrix3::zeros()],
        };
        let entry = |k: usize| {
            let at = (k / 3, k % 3);
            RotationEntry { constant: constant[at], sine: sine[at], cosine: cosine[at] }
        };
        let offset = own.transpose() * link.original.translation;
        Self {
            kind: link.kind,
            rotation: core::array::from_fn(entry),
            axis_point: (to_previous * (Vector3::from(link.origin) - previous.translation)).into(),
            axis_in_previous: (lead * Vector3::z()).into(),
            axis: (own.transpose() * Vector3::z()).into(),
            offset: (offset != Vector3::zeros()).then(|| offset.into()),
        }
    }

    /// Returns E for sin q and cos q.
    #[inline(always)]
    fn rotation_at<S: Scalar>(&self, sin: &S, cos: &S) -> Rotation<S> {
        if self.kind == JointKind::Prismatic {
            return Rotation(core::array::from_fn(|k| S::from(self.rotation[k].constant)));
        }
        Rotation(core::array::from_fn(|k| {
            let w = &self.rotation[k];
            S::from(w.constant) + sum2(&S::from(w.sine), sin, &S::from(w.cosine), cos)
        }))
    }

    /// Returns the point of the axis from which the link's frame has the constant offset, in the
    /// previous frame; `sin` is q for a prismatic joint.
    #[inline(always)]
    fn axis_point_at<S: Scalar>(&self, sin: &S) -> Vec3<S> {
        let point = Vec3::constant(self.axis_point);
        match self.kind {
            JointKind::Revolute => point,
            JointKind::Prismatic => point.plus(&Vec3::constant(self.axis_in_previous).scaled(sin)),
        }
    }

    /// Returns the motion of the link, with the acceleration of the axis point, from the motion of
    /// the previous link.
    #[inline(always)]
    fn propagate<S: Scalar>(
        &self,
        previous: &Motion<S>,
        gradient: &AccelerationGradient<S>,
        (rotation, axis_point): (&Rotation<S>, &Vec3<S>),
        qd: &S,
        qdd: &S,
    ) -> Motion<S> {
        let axis = Vec3::constant(self.axis);
        let carried = rotation.to_link(&previous.angular_velocity);
        let speed = axis.scaled(qd);
        let angular_acceleration = rotation.to_link(&previous.angular_acceleration);
        let at_axis = gradient.times(axis_point).plus(&previous.acceleration);
        let acceleration = rotation.to_link(&at_axis);
        let coriolis = carried.cross(&speed);
        match self.kind {
            JointKind::Revolute => Motion {
                angular_velocity: carried.plus(&speed),
                angular_acceleration: angular_acceleration.plus(&coriolis).plus(&axis.scaled(qdd)),
                acceleration,
            },
            JointKind::Prismatic => Motion {
                angular_velocity: carried,
                angular_acceleration,
                acceleration: acceleration.plus(&coriolis).plus(&coriolis).plus(&axis.scaled(qdd)),
            },
        }
    }

    /// Returns the twist that the link's own joint gives it.
    #[inline(always)]
    fn own_twist<S: Scalar>(&self) -> Twist<S> {
        let axis = Vec3::constant(self.axis);
        match self.kind {
            JointKind::Revolute => self.at_origin(axis, Vec3::zero()),
            JointKind::Prismatic => Twist { angular: Vec3::zero(), linear: axis },
        }
    }

    /// Returns the twist that an earlier joint gives this link from the one that it gives the
    /// previous link.
    #[inline(always)]
    fn propagate_twist<S: Scalar>(
        &self,
        twist: &Twist<S>,
        (rotation, axis_point): (&Rotation<S>, &Vec3<S>),
    ) -> Twist<S> {
        let at_axis = twist.angular.cross(axis_point).plus(&twist.linear);
        self.at_origin(rotation.to_link(&twist.angular), rotation.to_link(&at_axis))
    }

    /// Returns the twist whose linear velocity is given at the axis point.
    #[inline(always)]
    fn at_origin<S: Scalar>(&self, angular: Vec3<S>, linear: Vec3<S>) -> Twist<S> {
        let linear = match self.offset {
            None => linear,
            Some(offset) => linear.plus(&angular.cross(&Vec3::constant(offset))),
        };
        Twist { angular, linear }
    }
}

impl<S: Scalar> Rotation<S> {
    /// Returns Eᵀ v.
    #[inline(always)]
    fn to_link(&self, v: &Vec3<S>) -> Vec3<S> {
        let e = &self.0;
        let row = |k: usize| sum2(&e[k], &v.x, &e[k + 3], &v.y) + mul(&e[k + 6], &v.z);
        Vec3::new(row(0), row(1), row(2))
    }
}

impl Robot {
    /// Computes the regressor Y of inverse dynamics \[n x 10 n, row by row\]:
    /// tau = Y(q, q̇, q̈) θ \[N m\].
    ///
    /// For each link, θ holds the ten inertial parameters m, m c_x, m c_y, m c_z, Ixx, Ixy, Iyy,
    /// Ixz, Iyz, Izz. The inertia is about the origin of the link's original frame, in its axes
    /// (see [`Robot::inertial_parameters`]). Y does not contain motor inertia. All slices have one
    /// entry per joint: `sin`, `cos` of [`Robot::sin_cos`], `qd` \[rad/s\], `qdd` \[rad/s²\].
    ///
    /// In Y, gravity acts on the inertial parameters. For a robot with `gravity_moments`,
    /// [`Robot::rnea`] is the sum of two products: Y without gravity ([`Robot::with_gravity`])
    /// times θ, and Y at rest times the gravity parameters.
    ///
    /// The recursion propagates the twist that each joint gives each link. The torque of joint j is
    /// the power of link i's wrench on that twist (Atkeson, An & Hollerbach 1986, in the dual
    /// form). Columns of links before joint j are zero. With independent sine and cosine, Y θ is
    /// the polynomial of [`Robot::rnea`].
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure, entry by entry, for the link frames as computed in
    /// double precision.
    ///
    /// # Panics
    ///
    /// Panics if a slice is too short, or if the workspace was made for a robot with fewer joints.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::{RegressorWorkspace, Robot};
    ///
    /// let robot = Robot::lwa4p().with_gravity([0.0; 3]);
    /// let ((sin, cos), qdd) = (robot.sin_cos(&[0.3; 6]), [1.0; 6]);
    /// let (mut ws, mut y) = (RegressorWorkspace::new(&robot), [0.0; 360]);
    /// robot.inertial_regressor(&sin, &cos, &[0.0; 6], &qdd, &mut ws, &mut y);
    /// let theta = robot.inertial_parameters();
    /// let torque: f64 = y[..60].iter().zip(&theta).map(|(y, p)| y * p).sum();
    /// let motor = robot.joints()[0].armature;
    /// assert!((torque + motor - robot.mass_matrix(&[0.3; 6]).row(0).sum()).abs() < 1e-12);
    /// ```
    pub fn inertial_regressor<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        qd: &[S],
        qdd: &[S],
        ws: &mut RegressorWorkspace<S>,
        y: &mut [S],
    ) {
        let n = self.joint_count();
        let [sin, cos, qd, qdd] = [sin, cos, qd, qdd].map(|s| &s[..n]);
        let (frames, twists) = (&ws.frames[..n], &mut ws.twists[..n]);
        let y = &mut y[..INERTIAL * n * n];
        let mut motion = Motion::at_rest(Vec3::constant(self.description.gravity.map(|g| -g)));
        let mut gradient = motion.gradient();
        for i in 0..n {
            let frame = &frames[i];
            // Motion of link i at its origin, and the twist of its own joint.
            let pose = (&frame.rotation_at(&sin[i], &cos[i]), &frame.axis_point_at(&sin[i]));
            motion = frame.propagate(&motion, &gradient, pose, &qd[i], &qdd[i]);
            gradient = motion.gradient();
            if let Some(offset) = frame.offset {
                motion.acceleration.accumulate(&gradient.times(&Vec3::constant(offset)));
            }
            twists[i] = frame.own_twist();
            // Columns of link i: its wrench per parameter, on the twist of each joint j up to i.
            for (j, row) in y.chunks_exact_mut(INERTIAL * n).enumerate() {
                let block = &mut row[INERTIAL * i..INERTIAL * (i + 1)];
                if j > i {
                    block.fill(S::zero());
                    continue;
                }
                if j < i {
                    twists[j] = frame.propagate_twist(&twists[j], pose);
                }
                twists[j].powers(&motion, &gradient, block);
            }
        }
    }
}

impl<S: Scalar> Twist<S> {
    /// Computes the power of a link's wrench on this twist, for a unit of each of the link's ten
    /// inertial parameters.
    #[inline(always)]
    fn powers(&self, motion: &Motion<S>, gradient: &AccelerationGradient<S>, out: &mut [S]) {
        let (u, v, a) = (&self.angular, &self.linear, &motion.acceleration);
        let (w, dw) = (&motion.angular_velocity, &motion.angular_acceleration);
        // The wrench is the force m a + K h and the moment h × a + I α + ω × I ω about the origin.
        let h = gradient.transposed_times(v).plus(&a.cross(u));
        let x = u.cross(w);
        out[0] = v.dot(a);
        (out[1], out[2], out[3]) = (h.x, h.y, h.z);
        out[4] = sum2(&u.x, &dw.x, &x.x, &w.x);
        out[5] = sum2(&u.x, &dw.y, &u.y, &dw.x) + sum2(&x.x, &w.y, &x.y, &w.x);
        out[6] = sum2(&u.y, &dw.y, &x.y, &w.y);
        out[7] = sum2(&u.x, &dw.z, &u.z, &dw.x) + sum2(&x.x, &w.z, &x.z, &w.x);
        out[8] = sum2(&u.y, &dw.z, &u.z, &dw.y) + sum2(&x.y, &w.z, &x.z, &w.y);
        out[9] = sum2(&u.z, &dw.z, &x.z, &w.z);
    }
}
