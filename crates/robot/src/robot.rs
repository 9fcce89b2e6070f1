//! A robot: the constants of all links and joints.

use crate::description::robot_description::RobotDescription;
use crate::inertia::{INERTIAL, LinkInertia};
use crate::joint::Joint;
use crate::joint_geometry::JointGeometry;
use crate::joint_kind::JointKind;
use crate::link::{Link, working_links};
use crate::parameter::{Parameter, ParameterKind};
use nalgebra::{Matrix3, Vector3};
use reachtube_scalar::SineCosine;

/// The constants of a serial robot with revolute and prismatic joints. Scratch memory is kept
/// separately, in a [`Workspace`](crate::Workspace).
///
/// Every link gets a working frame whose +z is the joint's axis and from which the next axis
/// differs by a twist about x. The algorithms use these frames; results in joint space do not
/// depend on them.
///
/// # Examples
///
/// ```
/// use reachtube_robot::Robot;
///
/// let robot = Robot::lwa4p();
/// assert_eq!(robot.joint_count(), 6);
/// let q = [0.0, 0.3, 0.0, 0.0, 0.0, 0.0];
/// let gravity = robot.gravity_torque(&q);
/// let qdd = robot.forward_acceleration(&q, &[0.0; 6], gravity.as_slice());
/// assert!(qdd.amax() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    pub(crate) description: RobotDescription,
    pub(crate) joints: Vec<Joint>,
    pub(crate) links: Vec<Link>,
    /// Whether gravity acts on mass moments of its own.
    pub(crate) separate_gravity: bool,
    /// Gravitational acceleration in the working base frame \[m/s²\].
    pub(crate) working_gravity: [f64; 3],
    /// Rotation from the working base frame to the base frame of the description.
    pub(crate) base: Matrix3<f64>,
    /// Whether a joint is prismatic. The shortest algorithms have a path without such joints, as
    /// the question for each of them takes a tenth of their time.
    pub(crate) slides: bool,
}

impl Robot {
    /// Makes a robot from its description and the parts that were computed from it.
    pub(crate) fn assemble(
        description: RobotDescription,
        joints: Vec<Joint>,
        geometry: &[JointGeometry],
        inertias: &[LinkInertia],
        gravity_inertias: &[LinkInertia],
    ) -> Self {
        let (links, base) = working_links(&joints, geometry, inertias, gravity_inertias);
        let working_gravity = (base.transpose() * Vector3::from(description.gravity)).into();
        let separate_gravity = description.joints.iter().any(|j| j.gravity_moments.is_some());
        let slides = links.iter().any(|link| link.kind == JointKind::Prismatic);
        Self { description, joints, links, separate_gravity, working_gravity, base, slides }
    }

    /// Returns the number of joints n.
    pub fn joint_count(&self) -> usize {
        self.links.len()
    }

    /// Returns the robot's name.
    pub fn name(&self) -> &str {
        &self.description.name
    }

    /// Returns the joints from base to tip.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Returns the kinds of the joints from base to tip.
    pub fn kinds(&self) -> Vec<JointKind> {
        self.joints.iter().map(|joint| joint.kind).collect()
    }

    /// Returns the description that the robot was made from.
    pub fn description(&self) -> &RobotDescription {
        &self.description
    }

    /// Returns the gravitational acceleration in the base frame \[m/s²\].
    pub fn gravity_acceleration(&self) -> [f64; 3] {
        self.description.gravity
    }

    /// Returns the two functions of position that the dynamics takes, n values each: sin q and
    /// cos q, for q in rad. A prismatic joint has its position \[m\] and 1 in their places.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: outer enclosures.
    ///
    /// # Panics
    ///
    /// Panics if the length of `q` is not the number of joints.
    pub fn sin_cos<S: SineCosine>(&self, q: &[S]) -> (Vec<S>, Vec<S>) {
        assert_eq!(q.len(), self.joint_count(), "`{}` takes one position per joint", self.name());
        self.joints.iter().zip(q).map(|(joint, q)| joint.kind.sin_cos(q)).unzip()
    }

    /// Returns the same robot under another gravitational acceleration in the base frame \[m/s²\].
    #[must_use]
    pub fn with_gravity(&self, gravity: [f64; 3]) -> Self {
        let mut robot = self.clone();
        robot.description.gravity = gravity;
        robot.working_gravity = (robot.base.transpose() * Vector3::from(gravity)).into();
        robot
    }

    /// Returns the robot without the inertia of its motors, which torques behind the gears do not
    /// drive.
    #[must_use]
    pub fn without_motors(&self) -> Self {
        let mut robot = self.clone();
        for joint in &mut robot.description.joints {
            (joint.armature, joint.rotor_inertia) = (None, None);
        }
        robot.joints.iter_mut().for_each(|joint| joint.armature = 0.0);
        robot.links.iter_mut().for_each(|link| link.armature = 0.0);
        robot
    }

    /// Returns the fixed geometry between the joints, n, from base to tip.
    pub fn geometry(&self) -> Vec<JointGeometry> {
        let convention = self.description.convention;
        self.description.joints.iter().map(|joint| joint.geometry(convention)).collect()
    }

    /// Returns the ten inertial parameters of each link \[10 n\] in the order of
    /// [`Robot::inertial_regressor`], about the origin of the link's own frame.
    pub fn inertial_parameters(&self) -> Vec<f64> {
        self.description.joints.iter().flat_map(|j| j.link_inertia().parameters()).collect()
    }

    /// Returns the values of these parameters in the robot's description, each in its SI unit.
    ///
    /// Coulomb friction and offset come from the four quadrants at no load. If the quadrants have
    /// slopes, these two values do not describe all of the friction.
    pub fn parameter_values(&self, parameters: &[Parameter]) -> Vec<f64> {
        let inertial = self.inertial_parameters();
        let value = |p: &Parameter| {
            let (viscous, coulomb) =
                (&self.joints[p.joint].friction.viscous, &self.joints[p.joint].friction.coulomb);
            let forward = coulomb.driving_forward.offset + coulomb.braking_forward.offset;
            let backward = coulomb.driving_backward.offset + coulomb.braking_backward.offset;
            match p.kind {
                ParameterKind::MotorInertia => self.joints[p.joint].armature,
                ParameterKind::Viscous1 => viscous.v1,
                ParameterKind::Viscous2 => viscous.v2,
                ParameterKind::Viscous3 => viscous.v3,
                ParameterKind::Coulomb => 0.25 * (forward - backward),
                ParameterKind::Offset => 0.25 * (forward + backward),
                kind => inertial[INERTIAL * p.joint + kind as usize],
            }
        };
        parameters.iter().map(value).collect()
    }
}
