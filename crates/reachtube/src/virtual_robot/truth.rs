//! The true robot behind the recordings.

use reachtube_robot::friction::{Stribeck, Warming, WarmingBy};
use reachtube_robot::{JointDescription, Robot, RobotDescription};

use super::parameters::VirtualRobotParameters;
use crate::error::Result;

/// A virtual robot: the nominal model that its controller knows, and the true robot.
#[derive(Debug, Clone)]
pub struct VirtualRobot {
    parameters: VirtualRobotParameters,
    nominal: Robot,
    truth: Robot,
    /// Heat capacities of the joints \[J/K\], n.
    capacities: Vec<f64>,
}

impl VirtualRobot {
    /// Makes a virtual robot that differs from `nominal` by `parameters`.
    ///
    /// The controller compensates gravity and Coulomb friction of the nominal model. A Stribeck
    /// effect or a law of warming in the nominal model is not used: the parameters replace them.
    ///
    /// # Errors
    ///
    /// [`VirtualRobotError`](super::VirtualRobotError) for a parameter outside its range, and
    /// [`RobotError`](reachtube_robot::RobotError) where the true robot is not valid.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube::Robot;
    /// use reachtube::virtual_robot::{VirtualRobot, VirtualRobotParameters};
    ///
    /// let robot = VirtualRobot::new(&Robot::lwa4p(), VirtualRobotParameters::default())?;
    /// let (true_gravity, nominal) =
    ///     [robot.truth(), robot.nominal()].map(|robot| robot.gravity_torque(&[0.5; 6])).into();
    /// assert!((true_gravity - nominal).amax() > 0.1);
    /// # Ok::<(), reachtube::Error>(())
    /// ```
    pub fn new(nominal: &Robot, parameters: VirtualRobotParameters) -> Result<Self> {
        parameters.validate()?;
        let truth = Robot::from_description(&true_description(nominal, &parameters))?;
        let capacity = |joint: &JointDescription| {
            let friction = &joint.friction;
            parameters.heat_capacity * (unloaded(&friction.coulomb) + friction.viscous[0].abs())
        };
        let capacities = nominal.description().joints.iter().map(capacity).collect();
        Ok(Self { parameters, nominal: nominal.clone(), truth, capacities })
    }

    /// Returns the parameters.
    #[must_use]
    pub fn parameters(&self) -> &VirtualRobotParameters {
        &self.parameters
    }

    /// Returns the nominal model.
    #[must_use]
    pub fn nominal(&self) -> &Robot {
        &self.nominal
    }

    /// Returns the true robot, with its friction as a law of temperature. Torque ripple is not part
    /// of it.
    #[must_use]
    pub fn truth(&self) -> &Robot {
        &self.truth
    }

    /// Returns the heat capacities of the joints \[J/K\], n.
    pub(super) fn capacities(&self) -> &[f64] {
        &self.capacities
    }
}

/// Returns the mean magnitude of Coulomb friction without load \[N m\].
fn unloaded(coulomb: &[f64; 8]) -> f64 {
    0.25 * coulomb.iter().step_by(2).map(|offset| offset.abs()).sum::<f64>()
}

fn true_description(nominal: &Robot, parameters: &VirtualRobotParameters) -> RobotDescription {
    let mut description = nominal.description().clone();
    description.joints.iter_mut().for_each(|joint| change_joint(joint, parameters));
    let inertial = nominal.inertial_parameters();
    if let Some((joint, own)) = description.joints.last_mut().zip(inertial.chunks_exact(10).last())
    {
        let own: Vec<f64> = own.iter().map(|x| x * parameters.link_ratio).collect();
        add_payload(joint, &own, parameters);
    }
    description
}

/// Changes the weight of a link, its motor and its friction.
fn change_joint(joint: &mut JointDescription, parameters: &VirtualRobotParameters) {
    let ratio = parameters.link_ratio;
    joint.mass *= ratio;
    joint.inertia = joint.inertia.map(|i| i * ratio);
    joint.first_moment = joint.first_moment.map(|h| h.map(|x| x * ratio));
    if let Some(gravity) = &mut joint.gravity_moments {
        gravity.mass *= ratio;
        gravity.first_moment = gravity.first_moment.map(|x| x * ratio);
    }
    joint.armature = joint.armature.map(|a| a * parameters.motor_ratio);
    joint.rotor_inertia = joint.rotor_inertia.map(|i| i * parameters.motor_ratio);
    let excess = parameters.breakaway_ratio * unloaded(&joint.friction.coulomb);
    joint.friction.stribeck = Some(Stribeck { excess, speed: parameters.stribeck_speed });
    joint.friction.warming = Some(Warming {
        by: WarmingBy::Temperature,
        reference: parameters.nominal_temperature,
        time_constant: None,
        coulomb: parameters.coulomb_rate,
        viscous: parameters.viscous_rate,
    });
    joint.friction.standard_errors = None;
}

/// Adds the payload as a point mass to a link with the inertial parameters `own`: m, m c, and ixx,
/// ixy, iyy, ixz, iyz, izz about the origin of its frame.
fn add_payload(joint: &mut JointDescription, own: &[f64], parameters: &VirtualRobotParameters) {
    let (mass, p) = (parameters.payload_mass, parameters.payload_position);
    if mass == 0.0 {
        return;
    }
    let [x, y, z] = p;
    let moment = |i: usize| mass * p[i];
    let first = [own[1] + moment(0), own[2] + moment(1), own[3] + moment(2)];
    (joint.com, joint.first_moment) = (None, Some(first));
    joint.mass = own[0] + mass;
    joint.about = reachtube_robot::InertiaPoint::Origin;
    joint.inertia = [
        own[4] + mass * (y * y + z * z),
        own[5] - mass * x * y,
        own[7] - mass * x * z,
        own[6] + mass * (x * x + z * z),
        own[8] - mass * y * z,
        own[9] + mass * (x * x + y * y),
    ];
    if let Some(gravity) = &mut joint.gravity_moments {
        gravity.mass += mass;
        gravity.first_moment = std::array::from_fn(|i| gravity.first_moment[i] + moment(i));
    }
}
