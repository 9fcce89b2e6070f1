//! The columns of a regressor by name: inertial parameters, motor inertia, friction and offset of
//! each joint.

use crate::inertia::LinkInertia;
use crate::regressor::INERTIAL;
use crate::{InertiaPoint, RegressorWorkspace, Robot, RobotDescription, RobotError};
use core::fmt;
use nalgebra::{DMatrix, Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// One parameter that torque is linear in, and so one column of a regressor.
///
/// # Examples
///
/// ```
/// use reachtube_robot::{Column, ColumnKind};
///
/// assert_eq!(Column { joint: 2, kind: ColumnKind::Ixx }.to_string(), "Ixx3");
/// assert_eq!(Column { joint: 1, kind: ColumnKind::Viscous1 }.to_string(), "v1_2");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Column {
    /// Index of the joint, from 0; names count from 1.
    pub joint: usize,
    /// Which of the joint's parameters.
    pub kind: ColumnKind,
}

/// The kinds of parameter that a joint with its link has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum ColumnKind {
    /// Mass m \[kg\].
    Mass,
    /// First moment m c_x \[kg m\] in the link's frame.
    MomentX,
    /// First moment m c_y \[kg m\].
    MomentY,
    /// First moment m c_z \[kg m\].
    MomentZ,
    /// Moment of inertia about the link's origin \[kg m²\].
    Ixx,
    /// Entry xy of the inertia tensor about the link's origin \[kg m²\] (minus the product of
    /// inertia ∫ x y dm).
    Ixy,
    /// Moment of inertia about the link's origin \[kg m²\].
    Iyy,
    /// Entry xz of the inertia tensor about the link's origin \[kg m²\].
    Ixz,
    /// Entry yz of the inertia tensor about the link's origin \[kg m²\].
    Iyz,
    /// Moment of inertia about the link's origin \[kg m²\].
    Izz,
    /// Motor inertia on the link's side J = k_r² I_m \[kg m²\]: column q̈.
    MotorInertia,
    /// Viscous friction v1 \[N m s/rad\]: column q̇.
    Viscous1,
    /// Viscous friction v2 \[N m s²/rad²\]: column q̇².
    Viscous2,
    /// Viscous friction v3 \[N m s³/rad³\]: column q̇³.
    Viscous3,
    /// Coulomb friction of one magnitude \[N m\]: column sign(q̇), 0 at rest.
    Coulomb,
    /// Constant torque \[N m\], as of a sensor's zero: column 1.
    Offset,
}

impl ColumnKind {
    /// The ten inertial parameters in the order of [`Robot::inertial_regressor`].
    pub const INERTIAL: [Self; INERTIAL] = [
        Self::Mass,
        Self::MomentX,
        Self::MomentY,
        Self::MomentZ,
        Self::Ixx,
        Self::Ixy,
        Self::Iyy,
        Self::Ixz,
        Self::Iyz,
        Self::Izz,
    ];

    /// The name before the joint's number: `m`, `mx`, `Ixx`, `J`, `v1_`, `fc`, `o`.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Mass => "m",
            Self::MomentX => "mx",
            Self::MomentY => "my",
            Self::MomentZ => "mz",
            Self::Ixx => "Ixx",
            Self::Ixy => "Ixy",
            Self::Iyy => "Iyy",
            Self::Ixz => "Ixz",
            Self::Iyz => "Iyz",
            Self::Izz => "Izz",
            Self::MotorInertia => "J",
            Self::Viscous1 => "v1_",
            Self::Viscous2 => "v2_",
            Self::Viscous3 => "v3_",
            Self::Coulomb => "fc",
            Self::Offset => "o",
        }
    }

    /// Whether it is one of the ten inertial parameters.
    pub fn is_inertial(self) -> bool {
        (self as usize) < INERTIAL
    }

    /// The column's only entry, in the joint's own row; inertial columns have none.
    fn own_entry(self, qd: f64, qdd: f64) -> f64 {
        match self {
            Self::MotorInertia => qdd,
            Self::Viscous1 => qd,
            Self::Viscous2 => qd * qd,
            Self::Viscous3 => qd * qd * qd,
            Self::Coulomb if qd == 0.0 => 0.0,
            Self::Coulomb => qd.signum(),
            Self::Offset => 1.0,
            _ => 0.0,
        }
    }
}

impl Column {
    /// The columns of n joints, joint by joint, each with the given kinds.
    pub fn of_joints(n: usize, kinds: &[ColumnKind]) -> Vec<Self> {
        (0..n).flat_map(|joint| kinds.iter().map(move |&kind| Self { joint, kind })).collect()
    }
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.kind.symbol(), self.joint + 1)
    }
}

/// The regressor of chosen columns over f64: motor torque = Y θ with friction and offsets where
/// they are chosen.
///
/// # Examples
///
/// ```
/// use reachtube_robot::{Column, ColumnKind, Regressor, Robot};
///
/// let robot = Robot::lwa4p();
/// let columns = Column::of_joints(6, &[ColumnKind::MotorInertia, ColumnKind::Viscous1]);
/// let mut regressor = Regressor::new(&robot, &columns);
/// let mut y = vec![0.0; 6 * 12];
/// regressor.fill(&[0.1; 6], &[0.2; 6], &[0.3; 6], &mut y);
/// assert_eq!(y[..3], [0.3, 0.2, 0.0]);
/// ```
#[derive(Clone, Debug)]
pub struct Regressor<'a> {
    robot: &'a Robot,
    columns: Vec<Column>,
    ws: RegressorWorkspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    inertial: Vec<f64>,
}

impl<'a> Regressor<'a> {
    /// A regressor with these columns, in their order.
    ///
    /// # Panics
    ///
    /// When a column belongs to a joint that the robot does not have.
    pub fn new(robot: &'a Robot, columns: &[Column]) -> Self {
        let n = robot.joint_count();
        assert!(columns.iter().all(|c| c.joint < n), "`{}` has {n} joints", robot.name());
        Self {
            robot,
            columns: columns.to_vec(),
            ws: RegressorWorkspace::new(robot),
            sin: vec![0.0; n],
            cos: vec![0.0; n],
            inertial: vec![0.0; INERTIAL * n * n],
        }
    }

    /// The columns, in their order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Writes Y \[n x columns, row by row\] at q \[rad\], q̇ \[rad/s\], q̈ \[rad/s²\]; does not
    /// allocate.
    ///
    /// # Panics
    ///
    /// When a slice is shorter than asked for.
    pub fn fill(&mut self, q: &[f64], qd: &[f64], qdd: &[f64], y: &mut [f64]) {
        let n = self.robot.joint_count();
        for (i, q) in q[..n].iter().enumerate() {
            (self.sin[i], self.cos[i]) = q.sin_cos();
        }
        if self.columns.iter().any(|c| c.kind.is_inertial()) {
            let Self { robot, ws, sin, cos, inertial, .. } = self;
            robot.inertial_regressor(sin, cos, qd, qdd, ws, inertial);
        }
        let width = self.columns.len();
        for (i, row) in y[..n * width].chunks_exact_mut(width).enumerate() {
            for (y, column) in row.iter_mut().zip(&self.columns) {
                *y = match column {
                    c if c.kind.is_inertial() => {
                        self.inertial[INERTIAL * (i * n + c.joint) + c.kind as usize]
                    }
                    c if c.joint == i => c.kind.own_entry(qd[i], qdd[i]),
                    _ => 0.0,
                };
            }
        }
    }

    /// The regressors of many states \[(q, q̇, q̈)\], one below the other: (n · states) x columns.
    pub fn stacked(&mut self, states: &[[Vec<f64>; 3]]) -> DMatrix<f64> {
        let (n, width) = (self.robot.joint_count(), self.columns.len());
        let mut rows = vec![0.0; n * width * states.len()];
        for ([q, qd, qdd], y) in states.iter().zip(rows.chunks_exact_mut((n * width).max(1))) {
            self.fill(q, qd, qdd, y);
        }
        DMatrix::from_row_slice(n * states.len(), width, &rows)
    }
}

impl Robot {
    /// The same robot under another gravitational acceleration in the base frame \[m/s²\].
    pub fn with_gravity(&self, gravity: [f64; 3]) -> Self {
        let mut robot = self.clone();
        robot.description.gravity = gravity;
        robot.working_gravity = (robot.base.transpose() * Vector3::from(gravity)).into();
        robot
    }

    /// The ten inertial parameters of each link \[10 n\] in the order of
    /// [`Robot::inertial_regressor`], about the origin of the link's own frame.
    pub fn inertial_parameters(&self) -> Vec<f64> {
        self.description.joints.iter().flat_map(|j| j.link_inertia().parameters()).collect()
    }

    /// The values of these parameters in the robot's description, each in its SI unit.
    ///
    /// Coulomb friction and offset are those of its four quadrants at no load: with slopes they are
    /// not all of it.
    pub fn column_values(&self, columns: &[Column]) -> Vec<f64> {
        let inertial = self.inertial_parameters();
        let value = |c: &Column| {
            let (viscous, coulomb) =
                (&self.joints[c.joint].friction.viscous, &self.joints[c.joint].friction.coulomb);
            let forward = coulomb.driving_forward.offset + coulomb.braking_forward.offset;
            let backward = coulomb.driving_backward.offset + coulomb.braking_backward.offset;
            match c.kind {
                ColumnKind::MotorInertia => self.joints[c.joint].armature,
                ColumnKind::Viscous1 => viscous.v1,
                ColumnKind::Viscous2 => viscous.v2,
                ColumnKind::Viscous3 => viscous.v3,
                ColumnKind::Coulomb => 0.25 * (forward - backward),
                ColumnKind::Offset => 0.25 * (forward + backward),
                kind => inertial[INERTIAL * c.joint + kind as usize],
            }
        };
        columns.iter().map(value).collect()
    }
}

impl RobotDescription {
    /// The description with other values of these parameters; what is not among them keeps its
    /// value.
    ///
    /// Links that change are written with first moment and inertia about the origin of their frame;
    /// Coulomb friction loses its dependence on load where it changes. Whether a robot results,
    /// [`Robot::from_description`] says; combinations that no single body has need
    /// [`Parameters::Base`](crate::Parameters::Base).
    ///
    /// # Errors
    ///
    /// As [`Robot::from_description`] for the description before the change.
    ///
    /// # Panics
    ///
    /// When there are fewer values than columns, or a column's joint does not exist.
    pub fn with_values(&self, columns: &[Column], values: &[f64]) -> Result<Self, RobotError> {
        let robot = Robot::from_description(self)?;
        let all = Column::of_joints(self.joints.len(), &[ColumnKind::Coulomb, ColumnKind::Offset]);
        let mut level = robot.column_values(&all);
        let mut inertial = robot.inertial_parameters();
        let mut out = self.clone();
        for (c, &value) in columns.iter().zip(&values[..columns.len()]) {
            let joint = &mut out.joints[c.joint];
            match c.kind {
                ColumnKind::MotorInertia => joint.set_armature(value),
                ColumnKind::Viscous1 => joint.friction.viscous[0] = value,
                ColumnKind::Viscous2 => joint.friction.viscous[1] = value,
                ColumnKind::Viscous3 => joint.friction.viscous[2] = value,
                ColumnKind::Coulomb => level[2 * c.joint] = value,
                ColumnKind::Offset => level[2 * c.joint + 1] = value,
                kind => inertial[INERTIAL * c.joint + kind as usize] = value,
            }
            if c.kind.is_inertial() {
                joint.set_inertial(&inertial[INERTIAL * c.joint..]);
            } else if matches!(c.kind, ColumnKind::Coulomb | ColumnKind::Offset) {
                let (f, o) = (level[2 * c.joint], level[2 * c.joint + 1]);
                joint.friction.coulomb = [o + f, 0.0, o - f, 0.0, o - f, 0.0, o + f, 0.0];
            }
        }
        Ok(out)
    }
}

impl crate::JointDescription {
    /// Motor inertia on the link's side, kept as the rotor's where that is how it is given.
    fn set_armature(&mut self, armature: f64) {
        match (self.rotor_inertia, self.gear_ratio) {
            (Some(_), Some(ratio)) if ratio != 0.0 => {
                self.rotor_inertia = Some(armature / ratio.powi(2))
            }
            _ => self.armature = Some(armature),
        }
    }

    fn set_inertial(&mut self, p: &[f64]) {
        self.mass = p[0];
        (self.com, self.first_moment) = (None, Some([p[1], p[2], p[3]]));
        self.inertia = [p[4], p[5], p[7], p[6], p[8], p[9]];
        self.about = InertiaPoint::Origin;
    }
}

impl LinkInertia {
    /// m, m c_x, m c_y, m c_z, Ixx, Ixy, Iyy, Ixz, Iyz, Izz about the frame's origin.
    pub fn parameters(&self) -> [f64; INERTIAL] {
        let (h, i) = (&self.first_moment, self.tensor());
        let [xx, xy, yy, xz, yz, zz] =
            [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)].map(|k| i[k]);
        [self.mass, h.x, h.y, h.z, xx, xy, yy, xz, yz, zz]
    }

    /// A link from m, m c_x, m c_y, m c_z, Ixx, Ixy, Iyy, Ixz, Iyz, Izz about the frame's origin.
    pub fn from_parameters(p: &[f64; INERTIAL]) -> Self {
        let tensor = Matrix3::new(p[4], p[5], p[7], p[5], p[6], p[8], p[7], p[8], p[9]);
        Self::about_origin(p[0], Vector3::new(p[1], p[2], p[3]), &tensor)
    }
}
