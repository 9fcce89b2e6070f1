use crate::chain::{JointGeometry, Link, reorient};
use crate::description::RobotDescription;
use crate::friction::Friction;
use crate::inertia::LinkInertia;
use nalgebra::{Matrix3, Vector3};

/// A serial robot of revolute joints: its constants. Scratch memory is apart, in a
/// [`Workspace`](crate::Workspace).
///
/// At load every link frame is turned so that its joint's axis is +z and the next axis is a twist
/// about x away; the algorithms work in these frames, results in joint space do not depend on them.
///
/// # Examples
///
/// ```
/// use reachtube_robot::Robot;
///
/// let robot = Robot::lwa4p();
/// assert_eq!(robot.joint_count(), 6);
/// let gravity = robot.gravity_torque(&[0.0, 0.3, 0.0, 0.0, 0.0, 0.0]);
/// let qdd = robot.forward_acceleration(&[0.0, 0.3, 0.0, 0.0, 0.0, 0.0], &[0.0; 6], gravity.as_slice());
/// assert!(qdd.amax() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    pub(crate) description: RobotDescription,
    pub(crate) joints: Vec<Joint>,
    pub(crate) links: Vec<Link>,
    /// Whether gravity has mass moments of its own.
    pub(crate) separate_gravity: bool,
    /// Gravity in the working base frame [m/s²].
    pub(crate) working_gravity: [f64; 3],
    /// Takes working base coordinates to those of the description.
    pub(crate) base: Matrix3<f64>,
}

/// What a joint adds to the rigid body that it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name, unique in the robot.
    pub name: String,
    /// Lowest and highest position \[rad\].
    pub position_limits: [f64; 2],
    /// Highest speed \[rad/s\], where one is known.
    pub velocity_limit: Option<f64>,
    /// Gear ratio k_r, where one is known.
    pub gear_ratio: Option<f64>,
    /// Motor inertia on the link's side k_r² I_m \[kg m²\].
    pub armature: f64,
    /// Friction.
    pub friction: Friction,
}

impl Robot {
    pub(crate) fn assemble(
        description: RobotDescription,
        joints: Vec<Joint>,
        geometry: &[JointGeometry],
        inertias: &[LinkInertia],
        gravity_inertias: &[LinkInertia],
    ) -> Self {
        let armatures: Vec<_> = joints.iter().map(|j| j.armature).collect();
        let (links, base) = reorient(geometry, inertias, gravity_inertias, &armatures);
        let working_gravity = (base.transpose() * Vector3::from(description.gravity)).into();
        let separate_gravity = description.joints.iter().any(|j| j.gravity_moments.is_some());
        Self { description, joints, links, separate_gravity, working_gravity, base }
    }

    /// Number of joints n.
    pub fn joint_count(&self) -> usize {
        self.links.len()
    }

    /// The robot's name.
    pub fn name(&self) -> &str {
        &self.description.name
    }

    /// The joints from base to tip.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// What the robot was made from.
    pub fn description(&self) -> &RobotDescription {
        &self.description
    }

    /// Gravitational acceleration in the base frame \[m/s²\].
    pub fn gravity_acceleration(&self) -> [f64; 3] {
        self.description.gravity
    }

    /// (sin q, cos q), n values each, for q in rad.
    ///
    /// # Panics
    ///
    /// When `q` has another length than the robot has joints.
    pub fn sin_cos(&self, q: &[f64]) -> (Vec<f64>, Vec<f64>) {
        assert_eq!(q.len(), self.joint_count(), "`{}` takes one position a joint", self.name());
        q.iter().map(|q| q.sin_cos()).unzip()
    }
}
