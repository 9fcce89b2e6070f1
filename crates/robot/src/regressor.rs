//! The joint-torque regressor: torque as a matrix times the inertial parameters.

use crate::Robot;
use crate::algebra::{Vec3, mul, sum2};
use crate::placement::{Placement, rotation_x, rotation_z};
use crate::rnea::{AccelerationGradient, Motion};
use nalgebra::{Matrix3, Vector3};
use reachtube_scalar::Scalar;

/// Inertial parameters a link: m, m c_x, m c_y, m c_z, Ixx, Ixy, Iyy, Ixz, Iyz, Izz.
pub(crate) const INERTIAL: usize = 10;

/// Scratch memory and constants of [`Robot::inertial_regressor`] for one robot and one scalar.
///
/// Where the other algorithms work in turned frames, the regressor works in the links' own: its
/// columns are asked for there, and converting them would cost more than the recursion.
#[derive(Clone, Debug)]
pub struct RegressorWorkspace<S> {
    frames: Vec<LinkFrame>,
    twists: Vec<Twist<S>>,
}

/// A link's own frame relative to that of the link before.
#[derive(Clone, Debug)]
struct LinkFrame {
    /// x_before = E(q) x_link + ..., row by row; each entry constant + sine · sin q + cosine · cos
    /// q.
    rotation: [Wave; 9],
    /// A point of the joint's axis in the frame before \[m\].
    axis_point: [f64; 3],
    /// Unit vector of the joint's axis in the link's frame.
    axis: [f64; 3],
    /// The frame's origin seen from the axis point, in the link's frame \[m\]; none where it lies
    /// there.
    offset: Option<[f64; 3]>,
}

/// constant + sine · sin q + cosine · cos q.
#[derive(Clone, Copy, Debug)]
struct Wave {
    constant: f64,
    sine: f64,
    cosine: f64,
}

/// How a link moves with one joint at 1 rad/s: angular velocity, and velocity of its frame's
/// origin.
#[derive(Clone, Debug)]
struct Twist<S> {
    angular: Vec3<S>,
    linear: Vec3<S>,
}

/// Rows of a rotation E at one position.
struct Turn<S>([S; 9]);

impl<S: Scalar> RegressorWorkspace<S> {
    /// Scratch memory for a robot; it belongs to this robot's geometry, not only to its number of
    /// joints.
    pub fn new(robot: &Robot) -> Self {
        let mut before = Placement::rotation(robot.base.transpose());
        let mut frames = Vec::with_capacity(robot.joint_count());
        for link in &robot.links {
            frames.push(LinkFrame::new(link, &before));
            before = link.original.clone();
        }
        let rest = Twist { angular: Vec3::zero(), linear: Vec3::zero() };
        Self { twists: vec![rest; frames.len()], frames }
    }
}

impl LinkFrame {
    /// A frame behind one that has the placement `before` in its own working frame.
    fn new(link: &crate::chain::Link, before: &Placement) -> Self {
        let to_before = before.rotation.transpose();
        let lead = to_before
            * rotation_x((link.sin_twist, link.cos_twist))
            * rotation_z((link.sin_offset, link.cos_offset));
        let own = &link.original.rotation;
        let part = |m: Matrix3<f64>| lead * m * own;
        let constant = part(Matrix3::from_diagonal(&Vector3::z()));
        let sine = part(rotation_z((1.0, 0.0)) - Matrix3::from_diagonal(&Vector3::z()));
        let cosine = part(Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0)));
        let wave = |k: usize| {
            let at = (k / 3, k % 3);
            Wave { constant: constant[at], sine: sine[at], cosine: cosine[at] }
        };
        let offset = own.transpose() * link.original.translation;
        Self {
            rotation: core::array::from_fn(wave),
            axis_point: (to_before * (Vector3::from(link.origin) - before.translation)).into(),
            axis: (own.transpose() * Vector3::z()).into(),
            offset: (offset != Vector3::zeros()).then(|| offset.into()),
        }
    }

    #[inline(always)]
    fn turn<S: Scalar>(&self, sin: &S, cos: &S) -> Turn<S> {
        Turn(core::array::from_fn(|k| {
            let w = &self.rotation[k];
            S::from(w.constant) + sum2(&S::from(w.sine), sin, &S::from(w.cosine), cos)
        }))
    }

    /// The link's motion from that of the link before.
    #[inline(always)]
    fn carry<S: Scalar>(
        &self,
        before: &Motion<S>,
        gradient: &AccelerationGradient<S>,
        turn: &Turn<S>,
        qd: &S,
        qdd: &S,
    ) -> Motion<S> {
        let axis = Vec3::constant(self.axis);
        let carried = turn.to_link(&before.angular_velocity);
        let spin = axis.scaled(qd);
        let angular_acceleration = turn
            .to_link(&before.angular_acceleration)
            .plus(&carried.cross(&spin))
            .plus(&axis.scaled(qdd));
        let at_axis = gradient.times(&Vec3::constant(self.axis_point)).plus(&before.acceleration);
        Motion {
            angular_velocity: carried.plus(&spin),
            angular_acceleration,
            acceleration: turn.to_link(&at_axis),
        }
    }

    /// The twist of an earlier joint from that of the link before.
    #[inline(always)]
    fn carry_twist<S: Scalar>(&self, twist: &Twist<S>, turn: &Turn<S>) -> Twist<S> {
        let at_axis = twist.angular.cross(&Vec3::constant(self.axis_point)).plus(&twist.linear);
        self.at_origin(turn.to_link(&twist.angular), turn.to_link(&at_axis))
    }

    /// The twist whose velocity is given at the axis point.
    #[inline(always)]
    fn at_origin<S: Scalar>(&self, angular: Vec3<S>, linear: Vec3<S>) -> Twist<S> {
        let linear = match self.offset {
            None => linear,
            Some(offset) => linear.plus(&angular.cross(&Vec3::constant(offset))),
        };
        Twist { angular, linear }
    }
}

impl<S: Scalar> Turn<S> {
    /// Eᵀ v.
    #[inline(always)]
    fn to_link(&self, v: &Vec3<S>) -> Vec3<S> {
        let e = &self.0;
        let row = |k: usize| sum2(&e[k], &v.x, &e[k + 3], &v.y) + mul(&e[k + 6], &v.z);
        Vec3::new(row(0), row(1), row(2))
    }
}

impl Robot {
    /// The regressor Y of inverse dynamics \[n x 10 n, row by row\]: tau = Y(q, q̇, q̈) θ \[N m\].
    ///
    /// θ holds for each link the ten inertial parameters m, m c_x, m c_y, m c_z, Ixx, Ixy, Iyy,
    /// Ixz, Iyz, Izz, the inertia about the origin of the link's own frame, in its axes (see
    /// [`Robot::inertial_parameters`]). Gravity acts on them; where a robot has `gravity_moments`
    /// of its own, Y of [`Robot::with_gravity`] zero times θ and Y at rest times the gravity
    /// parameters give [`Robot::rnea`]. Motors are not in Y. All slices have one entry a joint:
    /// `sin`, `cos` of q, `qd` \[rad/s\], `qdd` \[rad/s²\].
    ///
    /// Links are carried outward with the twist that each joint gives them; the torque of joint j
    /// is the power of link i's wrench on that twist (Atkeson, An & Hollerbach 1986, in the dual
    /// form). Columns of links before j are zero. With independent sine and cosine Y θ is the
    /// polynomial of [`Robot::rnea`].
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure, entry by entry, for the link frames as computed in
    /// double precision.
    ///
    /// # Panics
    ///
    /// When a slice is shorter than asked for, or the workspace is of a robot with fewer joints.
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
            let turn = frame.turn(&sin[i], &cos[i]);
            motion = frame.carry(&motion, &gradient, &turn, &qd[i], &qdd[i]);
            gradient = motion.gradient();
            if let Some(offset) = frame.offset {
                motion.acceleration.accumulate(&gradient.times(&Vec3::constant(offset)));
            }
            twists[i] = frame.at_origin(Vec3::constant(frame.axis), Vec3::zero());
            for (j, row) in y.chunks_exact_mut(INERTIAL * n).enumerate() {
                let block = &mut row[INERTIAL * i..INERTIAL * (i + 1)];
                if j > i {
                    block.fill(S::zero());
                    continue;
                }
                if j < i {
                    twists[j] = frame.carry_twist(&twists[j], &turn);
                }
                twists[j].powers(&motion, &gradient, block);
            }
        }
    }

    /// The regressor at one state, \[n x 10 n\]; allocates, for q \[rad\], q̇ \[rad/s\], q̈
    /// \[rad/s²\].
    pub fn inertial_regressor_matrix(
        &self,
        q: &[f64],
        qd: &[f64],
        qdd: &[f64],
    ) -> nalgebra::DMatrix<f64> {
        let (n, (sin, cos)) = (self.joint_count(), self.sin_cos(q));
        let mut y = vec![0.0; INERTIAL * n * n];
        self.inertial_regressor(&sin, &cos, qd, qdd, &mut RegressorWorkspace::new(self), &mut y);
        nalgebra::DMatrix::from_row_slice(n, INERTIAL * n, &y)
    }
}

impl<S: Scalar> Twist<S> {
    /// The power that a link's wrench has on this twist, for a unit of each of its ten inertial
    /// parameters.
    #[inline(always)]
    fn powers(&self, motion: &Motion<S>, gradient: &AccelerationGradient<S>, out: &mut [S]) {
        let (u, v, a) = (&self.angular, &self.linear, &motion.acceleration);
        let (w, dw) = (&motion.angular_velocity, &motion.angular_acceleration);
        // Force m a + K h and moment h × a + I α + ω × I ω about the origin.
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
