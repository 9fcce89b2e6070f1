//! The true robot behind the recordings.

use reachtube_robot::friction::{Stribeck, Warming, WarmingBy};
use reachtube_robot::{
    BaseParameters, InertiaPoint, JointDescription, Parameter, ParameterKind, Robot,
    RobotDescription,
};

use super::parameters::VirtualRobotParameters;
use crate::error::Result;

/// A virtual robot: the nominal model of its controller, and the true robot.
#[derive(Debug, Clone)]
pub(crate) struct VirtualRobot {
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
    /// [`Error::Parameter`](crate::Error::Parameter) for a parameter outside its range, and
    /// [`RobotError`](reachtube_robot::RobotError) where the true robot is not valid.
    pub(crate) fn new(nominal: &Robot, parameters: VirtualRobotParameters) -> Result<Self> {
        parameters.validate()?;
        let truth = Robot::from_description(&true_description(nominal, &parameters))?;
        let capacity = |joint: &JointDescription| {
            let friction = &joint.friction;
            parameters.heat_capacity * (unloaded(&friction.coulomb) + friction.viscous[0].abs())
        };
        let capacities = nominal.description().joints.iter().map(capacity).collect();
        Ok(Self { parameters, nominal: nominal.clone(), truth, capacities })
    }

    pub(crate) fn parameters(&self) -> &VirtualRobotParameters {
        &self.parameters
    }

    pub(crate) fn nominal(&self) -> &Robot {
        &self.nominal
    }

    /// Returns the true robot, with its friction as a law of temperature. Torque ripple is not part
    /// of it.
    pub(crate) fn truth(&self) -> &Robot {
        &self.truth
    }

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
    let mut inertial = united_moments(nominal);
    inertial.iter_mut().for_each(|x| *x *= parameters.link_ratio);
    if let Some(last) = inertial.chunks_exact_mut(10).last() {
        add_payload(last, parameters);
    }
    for (joint, inertial) in description.joints.iter_mut().zip(inertial.chunks_exact(10)) {
        change_drive(joint, parameters);
        set_inertial(joint, inertial);
    }
    description
}

/// Returns the ten inertial parameters of each link: the nominal robot's, or, where gravity has
/// mass moments of its own, the nearest that show its gravity torque. The true links are bodies,
/// for which gravity and inertia cannot differ.
fn united_moments(nominal: &Robot) -> Vec<f64> {
    let columns = Parameter::of_joints(nominal.joint_count(), &ParameterKind::INERTIAL);
    let inertial = nominal.parameter_values(&columns);
    let joints = &nominal.description().joints;
    if joints.iter().all(|joint| joint.gravity_moments.is_none()) {
        return inertial;
    }
    let mut gravity = inertial.clone();
    for (values, joint) in gravity.chunks_exact_mut(10).zip(joints) {
        if let Some(moments) = joint.gravity_moments {
            values[0] = moments.mass;
            values[1..4].copy_from_slice(&moments.first_moment);
        }
    }
    let base = BaseParameters::at_rest(nominal, &columns);
    let united = base.lift_near(base.reduce(&gravity).as_slice(), &inertial);
    // The base is computed with functions of the platform, whose last bits differ.
    united.iter().map(|x| (x * 1e9).round() / 1e9).collect()
}

fn change_drive(joint: &mut JointDescription, parameters: &VirtualRobotParameters) {
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

/// Adds the payload as a point mass to the parameters of a link: m, m c, and ixx, ixy, iyy, ixz,
/// iyz, izz about the origin of its frame.
fn add_payload(link: &mut [f64], parameters: &VirtualRobotParameters) {
    let (mass, [x, y, z]) = (parameters.payload_mass, parameters.payload_position);
    let squares = [y * y + z * z, -x * y, x * x + z * z, -x * z, -y * z, x * x + y * y];
    let payload = [1.0, x, y, z].into_iter().chain(squares);
    link.iter_mut().zip(payload).for_each(|(own, more)| *own += mass * more);
}

/// Gives a link its parameters, for gravity as well.
fn set_inertial(joint: &mut JointDescription, p: &[f64]) {
    joint.mass = p[0];
    (joint.com, joint.first_moment) = (None, Some([p[1], p[2], p[3]]));
    joint.inertia = [p[4], p[5], p[7], p[6], p[8], p[9]];
    joint.about = InertiaPoint::Origin;
    joint.gravity_moments = None;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_true_robot_has_other_gravity_than_the_nominal_one() {
        let robot = VirtualRobot::new(&Robot::lwa4p(), VirtualRobotParameters::default()).unwrap();
        let [truth, nominal] =
            [robot.truth(), robot.nominal()].map(|robot| robot.gravity_torque(&[0.5; 6]));
        assert!((truth - nominal).amax() > 0.1);
    }
}
