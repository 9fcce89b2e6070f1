use std::f64::consts::LN_10;

use reachtube_robot::{GravityMoments, ParameterKind, Robot, RobotDescription};

use crate::dynamics::Dynamics;
use crate::error::Result;
use crate::fitting::group::Group;
use crate::nominal::correction::{InputCorrection, WarmthLaw};
use crate::problem::problem::Setup;

/// One number that a fit moves. The number 0 stands for the identified value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Parameter {
    pub group: Group,
    /// The joint, from 0.
    pub joint: usize,
    /// Which quadrants of Coulomb friction it scales.
    pub quadrants: [bool; 4],
    /// The lowest and the highest number allowed.
    pub bounds: [f64; 2],
}

/// The parameters of a fit, and the model that they give.
pub(crate) struct Parameters<'a> {
    setup: &'a Setup,
    law: Option<WarmthLaw>,
    has: Vec<Group>,
    /// The diagonal of the mass matrix at the expansion point, n, kg m².
    inertia: Vec<f64>,
    pub list: Vec<Parameter>,
}

/// The largest payload that is tried, kg.
const LARGEST_PAYLOAD: f64 = 100.0;

impl<'a> Parameters<'a> {
    /// Lists the parameters of `groups` that the robot has; `law` measures warmth.
    pub fn new(setup: &'a Setup, groups: &[Group], law: Option<WarmthLaw>) -> Self {
        let robot = &setup.robot;
        let n = robot.joint_count();
        let mass_matrix = robot.mass_matrix(&setup.settings.expansion_point.q);
        let inertia: Vec<f64> = (0..n).map(|j| mass_matrix[(j, j)]).collect();
        let has: Vec<Group> = Group::ALL.into_iter().filter(|g| groups.contains(g)).collect();
        let mut parameters = Self { setup, law, has, inertia, list: Vec::new() };
        for group in parameters.has.clone() {
            for joint in 0..n {
                let of_joint = parameters.of_joint(group, joint);
                parameters.list.extend(of_joint);
            }
        }
        parameters
    }

    /// Returns the number of parameters.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    fn of_joint(&self, group: Group, joint: usize) -> Vec<Parameter> {
        let friction = &self.setup.robot.joints()[joint].friction;
        let armature = self.setup.robot.joints()[joint].armature;
        let make = |low: f64, high: f64| Parameter {
            group,
            joint,
            quadrants: [true; 4],
            bounds: [low, high],
        };
        match group {
            Group::Inertia => {
                // The motor inertia must not become negative.
                let least = (1.0 - armature / self.inertia[joint]).max(0.1).ln();
                vec![make(least.min(0.0), LN_10)]
            }
            Group::Links if self.setup.robot.inertial_parameters()[10*joint..10*joint+10].iter().any(|x| *x != 0.0) => vec![make(-LN_10, LN_10)],
            Group::Viscous if friction.viscous.v1 > 0.0 => vec![make(-LN_10, LN_10)],
            Group::Cubic if friction.viscous.v2 != 0.0 || friction.viscous.v3 != 0.0 => {
                vec![make(-1.0, 5.0)]
            }
            Group::Coulomb => self.coulomb(joint),
            Group::WarmUp if friction.viscous.v1 > 0.0 => vec![make(-0.9, 2.0)],
            Group::Payload if joint + 1 == self.setup.robot.joint_count() => {
                vec![make(0.0, LARGEST_PAYLOAD)]
            }
            Group::Links | Group::Viscous | Group::Cubic | Group::WarmUp | Group::Payload => Vec::new(),
        }
    }

    /// One parameter per quadrant where the quadrants differ, one for all where they do not, none
    /// without Coulomb friction.
    fn coulomb(&self, joint: usize) -> Vec<Parameter> {
        let a = self.setup.robot.description().joints[joint].friction.coulomb;
        let whole =
            Parameter { group: Group::Coulomb, joint, quadrants: [true; 4], bounds: [-1.0, 5.0] };
        let is_plain = a[1..].iter().step_by(2).all(|slope| *slope == 0.0)
            && a.iter().step_by(2).all(|offset| offset.abs() == a[0].abs());
        if a == [0.0; 8] {
            Vec::new()
        } else if is_plain {
            vec![whole]
        } else {
            let of = |at: usize| Parameter { quadrants: [0, 1, 2, 3].map(|q| q == at), ..whole };
            (0..4).map(of).collect()
        }
    }

    /// Returns whether parameter `p` changes A and B, and not only the nominal motions.
    pub fn changes_model(&self, p: usize) -> bool {
        match self.list[p].group {
            Group::Inertia | Group::Links | Group::Viscous | Group::Payload => true,
            Group::Cubic => self.setup.settings.abstraction.order >= 2,
            Group::Coulomb | Group::WarmUp => false,
        }
    }

    /// Returns the identified and the fitted value of parameter `p`, and what it multiplies the
    /// identified value by where it is a factor.
    pub fn values(&self, p: usize, number: f64) -> (f64, f64, Option<f64>) {
        let Parameter { group, joint, quadrants, .. } = self.list[p];
        let viscous = &self.setup.robot.joints()[joint].friction.viscous;
        match group {
            Group::Inertia => {
                let identified = self.inertia[joint];
                (identified, identified * number.exp(), Some(number.exp()))
            }
            Group::Links => (1.0, number.exp(), Some(number.exp())),
            Group::Viscous => (viscous.v1, viscous.v1 * number.exp(), Some(number.exp())),
            Group::Cubic => (viscous.v3, viscous.v3 * (1.0 + number), Some(1.0 + number)),
            Group::Coulomb => {
                let a = self.setup.robot.description().joints[joint].friction.coulomb;
                let at = quadrants.iter().position(|is| *is).unwrap_or(0);
                (a[2 * at], a[2 * at] * (1.0 + number), Some(1.0 + number))
            }
            Group::WarmUp => (0.0, viscous.v1 * number, None),
            Group::Payload => (0.0, number, None),
        }
    }

    /// Returns the model with these numbers, one per parameter.
    ///
    /// # Errors
    ///
    /// When the robot is not physical at the expansion point.
    pub fn apply(&self, numbers: &[f64]) -> Result<Setup> {
        let Setup { robot, settings, nominal_starts, .. } = self.setup;
        let mut correction = InputCorrection::none(robot.joint_count());
        correction.warmth = self.law.clone().filter(|_| self.has.contains(&Group::WarmUp));
        let (mut changed, mut values) = (Vec::new(), Vec::new());
        let links = robot.inertial_parameters();
        let mut change = |joint, kind, value| {
            changed.push(reachtube_robot::Parameter { joint, kind });
            values.push(value);
        };
        for (parameter, &number) in self.list.iter().zip(numbers) {
            let Parameter { group, joint, quadrants, .. } = *parameter;
            let identified = &robot.joints()[joint];
            let viscous = &identified.friction.viscous;
            let corrected = &mut correction.joints[joint];
            match group {
                Group::Inertia => {
                    let armature = identified.armature + self.inertia[joint] * number.exp_m1();
                    change(joint, ParameterKind::MotorInertia, armature.max(0.0));
                }
                Group::Links => {
                    let link = &links[10 * joint..10 * joint + 10];
                    for (kind, value) in ParameterKind::INERTIAL.into_iter().zip(link) {
                        change(joint, kind, value * number.exp());
                    }
                }
                Group::Viscous => {
                    change(joint, ParameterKind::Viscous1, viscous.v1 * number.exp());
                }
                Group::Cubic => {
                    let [v2, v3] = [viscous.v2, viscous.v3].map(|v| v * (1.0 + number));
                    change(joint, ParameterKind::Viscous2, v2);
                    change(joint, ParameterKind::Viscous3, v3);
                    let left_out = self.left_out(joint, v2, v3);
                    [corrected.quadratic, corrected.cubic] = left_out;
                }
                Group::Coulomb => {
                    let parts = corrected.coulomb.iter_mut().zip(quadrants);
                    parts.filter(|(_, is)| *is).for_each(|(part, _)| *part = number);
                }
                Group::WarmUp => corrected.warm_up = viscous.v1 * number,
                Group::Payload => {
                    correction.payload = number;
                    let mass = robot.description().joints[joint].mass + number;
                    change(joint, ParameterKind::Mass, mass);
                }
            }
        }
        let mut description = robot.description().with_values(&changed, &values)?;
        if correction.payload != 0.0 || self.has.contains(&Group::Links) {
            keep_weight(robot, &mut description);
        }
        let robot = Robot::from_description(&description)?;
        let dynamics = Dynamics::new(&robot, settings)?;
        let (settings, nominal_starts) = (settings.clone(), nominal_starts.clone());
        Ok(Setup { robot, dynamics, settings, nominal_starts, correction: Some(correction) })
    }

    /// The quadratic and cubic viscous friction that the order of the model leaves out, about the
    /// velocity of the expansion point.
    fn left_out(&self, joint: usize, v2: f64, v3: f64) -> [f64; 2] {
        let origin = self.setup.settings.expansion_point.qd[joint];
        match self.setup.settings.abstraction.order {
            1 => [v2 + 3.0 * v3 * origin, v3],
            2 => [0.0, v3],
            _ => [0.0, 0.0],
        }
    }
}

/// Gives the links of a description the weight they have in `robot`: what is added to them is not
/// in the recorded inputs.
fn keep_weight(robot: &Robot, description: &mut RobotDescription) {
    let links = robot.inertial_parameters();
    for (joint, link) in description.joints.iter_mut().zip(links.chunks_exact(10)) {
        let weight = GravityMoments { mass: link[0], first_moment: [link[1], link[2], link[3]] };
        joint.gravity_moments.get_or_insert(weight);
    }
}
