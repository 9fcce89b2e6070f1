use std::f64::consts::LN_10;
use std::sync::Arc;

use reachtube_conform::Group;
use reachtube_conform::Setup;
use reachtube_conform::data::{Asked, FreeParameter, Parameters};
use reachtube_conform::fit::FittedParameter;
use reachtube_conform::{Error, Result};
use reachtube_robot::{GravityMoments, ParameterKind, Robot, RobotDescription};

use crate::arm::Arm;
use crate::correction::InputCorrection;
use crate::quantity::{OfJoint, Quantity, first};
use crate::rising::{BEYOND_FITTED, RisingFriction};
use crate::settings::Equations;
use crate::setup::OfArm;
use crate::system::system;

/// The number of inertial parameters of a link.
const INERTIAL: usize = ParameterKind::INERTIAL.len();

/// The parameters of a fit, and the model that they give.
#[derive(Debug, Clone)]
pub(super) struct ArmParameters {
    arm: Arm,
    setup: Setup,
    /// The diagonal of the mass matrix at the expansion point, n, kg m².
    inertia: Vec<f64>,
    /// The inertial parameters of each link, 10 n.
    links: Vec<f64>,
    /// The temperatures above which warm-up counts, n, °C; `None` if it counts by the run.
    temperatures: Option<Vec<f64>>,
    list: Vec<FreeParameter>,
    of: Vec<OfJoint>,
    /// Conditions on friction that could fall with speed.
    rising: Vec<RisingFriction>,
}

/// Numbers of logarithms lie within this distance from 0: a factor of 10.
const WIDEST: f64 = LN_10;

/// Highest number of the inertia that a motor feels: a factor of 100. Where torque is measured
/// behind the gear, the links alone may have nearly none.
const LARGEST_INERTIA: f64 = LN_10;

/// The least factor on the inertia that a motor feels.
const LEAST_INERTIA: f64 = 0.1;

/// The largest payload that is tried, kg.
const LARGEST_PAYLOAD: f64 = 100.0;

/// Numbers of warm-up by temperature change friction by a part per this many K. They are then as
/// large as the numbers of warm-up by ln(run).
const WARMING: f64 = 10.0;

impl ArmParameters {
    /// Lists the parameters of the groups that the robot has. Without a velocity limit, friction
    /// that may fall with speed must rise up to twice the highest speed of each joint in the
    /// recordings. Warm-up counts temperatures above the requested ones, or ln(run) without them.
    pub(super) fn new(arm: &Arm, setup: &Setup, asked: &Asked) -> Self {
        let robot = arm.robot();
        let mass_matrix = robot.mass_matrix(&arm.settings.expansion_point.q);
        let mut parameters = Self {
            arm: arm.clone(),
            setup: setup.clone(),
            inertia: mass_matrix.diagonal().iter().copied().collect(),
            links: robot.inertial_parameters(),
            temperatures: asked.temperatures.clone(),
            list: Vec::new(),
            of: Vec::new(),
            rising: Vec::new(),
        };
        for group in Group::ALL.into_iter().filter(|group| asked.groups.contains(group)) {
            for joint in 0..robot.joint_count() {
                for (quantity, bounds) in parameters.of_joint(group, joint) {
                    let changes_system = parameters.changes_system(quantity);
                    let (group, kind) = (quantity.group(), quantity.kind());
                    parameters.list.push(FreeParameter { group, kind, bounds, changes_system });
                    parameters.of.push(OfJoint { quantity, joint });
                }
            }
        }
        // A linear model whose friction is linear too has none that falls with speed.
        let is_cubic = asked.is_nonlinear
            || arm.settings.equations == Equations::Robot
            || asked.groups.contains(&Group::Cubic);
        let speeds = asked.bounds.iter().skip(robot.joint_count()).filter(|_| is_cubic);
        let rising = speeds.enumerate().filter_map(|(j, bounds)| parameters.rising(j, bounds));
        parameters.rising = rising.collect();
        parameters
    }

    /// Returns the condition on the friction of a joint (from 0) whose recorded velocities lie
    /// between bounds.
    fn rising(&self, joint: usize, [low, high]: &[f64; 2]) -> Option<RisingFriction> {
        let (drive, speed) = (&self.arm.robot.joints()[joint], high.max(-low));
        let viscous = drive.friction.viscous;
        let limit = drive.velocity_limit.map_or(BEYOND_FITTED * speed, |limit| limit.max(speed));
        let fitted = [Quantity::Viscous, Quantity::Cubic]
            .map(|quantity| self.of.iter().position(|own| *own == OfJoint { quantity, joint }));
        RisingFriction::new(fitted, [viscous.v1, viscous.v2, viscous.v3], limit)
    }

    fn robot(&self) -> &Robot {
        &self.arm.robot
    }

    fn of_joint(&self, group: Group, joint: usize) -> Vec<(Quantity, [f64; 2])> {
        let drive = &self.arm.robot.joints()[joint];
        let viscous = &drive.friction.viscous;
        let is_last = joint + 1 == self.inertia.len();
        let if_any =
            |any: bool, quantity, bounds| if any { vec![(quantity, bounds)] } else { Vec::new() };
        match group {
            Group::Inertia => {
                // The motor inertia must not become negative.
                let rest = (1.0 - drive.armature / self.inertia[joint]).max(LEAST_INERTIA);
                let motor = (Quantity::MotorInertia, [half(rest.ln().min(0.0)), LARGEST_INERTIA]);
                let link = self.link(joint).iter().any(|x| *x != 0.0);
                let density = if_any(link, Quantity::Density, [-WIDEST, WIDEST].map(half));
                [vec![motor], density].concat()
            }
            Group::Viscous => if_any(viscous.v1 > 0.0, Quantity::Viscous, [-WIDEST, WIDEST]),
            Group::Cubic => {
                if_any(viscous.v2 != 0.0 || viscous.v3 != 0.0, Quantity::Cubic, [-1.0, 5.0])
            }
            Group::Coulomb => self.coulomb(joint),
            Group::WarmUp => {
                // By the run, Coulomb friction warms up as far as the robot's own law has it.
                let coulomb = self.arm.robot.description().joints[joint].friction.coulomb;
                let is_coulomb = self.temperatures.is_some() && coulomb != [0.0; 8];
                let bounds = [-0.9, 2.0];
                let mut both = if_any(viscous.v1 > 0.0, Quantity::WarmUp, bounds);
                both.extend(if_any(is_coulomb, Quantity::WarmUpCoulomb, bounds));
                both
            }
            Group::Payload => if_any(is_last, Quantity::Payload, [0.0, LARGEST_PAYLOAD]),
        }
    }

    /// One parameter per quadrant where the quadrants differ, one for all where they do not, none
    /// without Coulomb friction.
    fn coulomb(&self, joint: usize) -> Vec<(Quantity, [f64; 2])> {
        let a = self.arm.robot.description().joints[joint].friction.coulomb;
        let is_plain = a[1..].iter().step_by(2).all(|slope| *slope == 0.0)
            && a.iter().step_by(2).all(|offset| offset.abs() == a[0].abs());
        let quadrants: Vec<[bool; 4]> = if a == [0.0; 8] {
            Vec::new()
        } else if is_plain {
            vec![[true; 4]]
        } else {
            (0..4).map(|at| [0, 1, 2, 3].map(|quadrant| quadrant == at)).collect()
        };
        quadrants.into_iter().map(|of| (Quantity::Coulomb(of), [-1.0, 5.0])).collect()
    }

    fn link(&self, joint: usize) -> &[f64] {
        &self.links[INERTIAL * joint..INERTIAL * (joint + 1)]
    }

    /// Returns whether a quantity changes A and B, and not only the nominal motions.
    fn changes_system(&self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::Cubic => self.arm.settings.abstraction.order >= 2,
            Quantity::Coulomb(_) | Quantity::WarmUp | Quantity::WarmUpCoulomb => false,
            _ => true,
        }
    }

    /// Returns the identified and the fitted value of parameter `p`, and what multiplies the
    /// identified value where that is how it changes.
    fn values(&self, p: usize, number: f64) -> (f64, f64, Option<f64>) {
        let OfJoint { quantity, joint } = self.of[p];
        let viscous = &self.arm.robot.joints()[joint].friction.viscous;
        let times = |identified: f64, factor: f64| (identified, identified * factor, Some(factor));
        match quantity {
            Quantity::MotorInertia => times(self.inertia[joint], (2.0 * number).exp()),
            Quantity::Density => times(self.link(joint)[0], (2.0 * number).exp()),
            Quantity::Viscous => times(viscous.v1, number.exp()),
            Quantity::Cubic => times(viscous.v3, 1.0 + number),
            Quantity::Coulomb(quadrants) => {
                let a = self.arm.robot.description().joints[joint].friction.coulomb;
                times(a[2 * first(quadrants)], 1.0 + number)
            }
            Quantity::WarmUp => (0.0, viscous.v1 * self.per_warmth(number), None),
            Quantity::WarmUpCoulomb => (0.0, self.per_warmth(number), None),
            Quantity::Payload => (0.0, number, None),
        }
    }

    /// Returns the change per unit of warmth that a number of warm-up stands for: per K or ln(run).
    fn per_warmth(&self, number: f64) -> f64 {
        if self.temperatures.is_some() { number / WARMING } else { number }
    }

    /// Returns the standard error of the identified value of parameter `p`, where the robot's
    /// description has it.
    fn standard_error(&self, p: usize) -> Option<f64> {
        let OfJoint { quantity, joint } = self.of[p];
        let errors = self.arm.robot.description().joints[joint].friction.standard_errors?;
        let error = match quantity {
            Quantity::Viscous => errors.viscous[0],
            Quantity::Cubic => errors.viscous[2],
            Quantity::Coulomb(quadrants) => errors.coulomb[2 * first(quadrants)],
            _ => 0.0,
        };
        (error > 0.0).then_some(error)
    }

    /// The quadratic and cubic viscous friction that is missing at the order of the model, about
    /// the velocity of the expansion point. The robot's own equations leave nothing out.
    fn left_out(&self, joint: usize, v2: f64, v3: f64) -> [f64; 2] {
        if self.arm.settings.equations == Equations::Robot {
            return [0.0, 0.0];
        }
        let origin = self.arm.settings.expansion_point.qd[joint];
        match self.arm.settings.abstraction.order {
            1 => [v2 + 3.0 * v3 * origin, v3],
            2 => [0.0, v3],
            _ => [0.0, 0.0],
        }
    }
}

impl Parameters for ArmParameters {
    fn list(&self) -> &[FreeParameter] {
        &self.list
    }

    fn setup(&self) -> &Setup {
        &self.setup
    }

    fn apply(&self, numbers: &[f64]) -> Result<Setup> {
        let robot = self.robot();
        let mut correction = InputCorrection::none(robot.joint_count());
        let (mut changed, mut values, mut links) = (Vec::new(), Vec::new(), self.links.clone());
        let mut change = |joint, kind, value| {
            changed.push(reachtube_robot::Parameter { joint, kind });
            values.push(value);
        };
        for (&OfJoint { quantity, joint }, &number) in self.of.iter().zip(numbers) {
            let (drive, corrected) = (&robot.joints()[joint], &mut correction.joints[joint]);
            let viscous = &drive.friction.viscous;
            match quantity {
                Quantity::MotorInertia => {
                    let armature = drive.armature + self.inertia[joint] * (2.0 * number).exp_m1();
                    change(joint, ParameterKind::MotorInertia, armature.max(0.0));
                }
                Quantity::Density => {
                    let link = &mut links[INERTIAL * joint..INERTIAL * (joint + 1)];
                    link.iter_mut().for_each(|value| *value *= (2.0 * number).exp());
                }
                Quantity::Viscous => {
                    change(joint, ParameterKind::Viscous1, viscous.v1 * number.exp());
                }
                Quantity::Cubic => {
                    let [v2, v3] = [viscous.v2, viscous.v3].map(|v| v * (1.0 + number));
                    change(joint, ParameterKind::Viscous2, v2);
                    change(joint, ParameterKind::Viscous3, v3);
                    [corrected.quadratic, corrected.cubic] = self.left_out(joint, v2, v3);
                }
                Quantity::Coulomb(quadrants) => {
                    let parts = corrected.coulomb.iter_mut().zip(quadrants);
                    parts.filter(|(_, is)| *is).for_each(|(part, _)| *part = number);
                }
                Quantity::WarmUp => corrected.warm_up = viscous.v1 * self.per_warmth(number),
                Quantity::WarmUpCoulomb => corrected.warm_up_coulomb = self.per_warmth(number),
                Quantity::Payload => {
                    correction.payload = number;
                    links[INERTIAL * joint] += number;
                }
            }
        }
        if self.list.iter().any(|own| own.group == Group::WarmUp) {
            correction.reference_temperatures.clone_from(&self.temperatures);
        }
        for (at, (new, old)) in links.iter().zip(&self.links).enumerate() {
            if new != old {
                change(at / INERTIAL, ParameterKind::INERTIAL[at % INERTIAL], *new);
            }
        }
        let mut description =
            robot.description().with_values(&changed, &values).map_err(Error::other)?;
        if links != self.links {
            keep_weight(robot, &mut description);
        }
        let robot = Robot::from_description(&description).map_err(Error::other)?;
        let dynamics = system(&robot, &self.arm.settings, self.setup.settings().method)?;
        let arm = Arm { robot: Arc::new(robot), correction: Some(correction), ..self.arm.clone() };
        Ok(self.setup.with_drive(Arc::new(arm), dynamics))
    }

    fn check(&self, setup: &Setup) -> Result<()> {
        setup.robot().check_physical().map_err(Error::other)?;
        Ok(())
    }

    fn none(&self) -> Box<dyn Parameters> {
        Box::new(Self::new(&self.arm, &self.setup, &Asked::default()))
    }

    /// Returns the identified values, but friction that rises.
    fn start(&self) -> Vec<f64> {
        let mut numbers = vec![0.0; self.list.len()];
        self.rising.iter().for_each(|condition| condition.start(&mut numbers));
        numbers
    }

    fn conditions(&self, numbers: &[f64]) -> Vec<(Vec<(usize, f64)>, f64)> {
        self.rising.iter().map(|condition| condition.tangent(numbers)).collect()
    }

    /// Returns whether the correction of a nominal motion may need the loads of gravity.
    fn has_near(&self) -> bool {
        let is_dry =
            |own: &OfJoint| matches!(own.quantity, Quantity::Coulomb(_) | Quantity::WarmUpCoulomb);
        self.of.iter().any(is_dry) || !self.arm.robot.warms_by().is_empty()
    }

    fn describe(&self, numbers: &[f64]) -> Vec<FittedParameter> {
        let of = |(p, number): (usize, &f64)| {
            let OfJoint { quantity, joint } = self.of[p];
            let kind = self.robot().joints()[joint].kind;
            let (identified, fitted, factor) = self.values(p, *number);
            let (name, unit) = quantity.name_and_unit(kind, self.temperatures.is_some());
            let (group, part, standard_error) =
                (quantity.group(), joint + 1, self.standard_error(p));
            FittedParameter { group, name, part, unit, identified, standard_error, fitted, factor }
        };
        numbers.iter().enumerate().map(of).collect()
    }
}

fn half(x: f64) -> f64 {
    0.5 * x
}

/// Gives the links of a description the weight they have in `robot`: what is added to them is not
/// in the recorded inputs.
fn keep_weight(robot: &Robot, description: &mut RobotDescription) {
    let links = robot.inertial_parameters();
    for (joint, link) in description.joints.iter_mut().zip(links.chunks_exact(INERTIAL)) {
        let weight = GravityMoments { mass: link[0], first_moment: [link[1], link[2], link[3]] };
        joint.gravity_moments.get_or_insert(weight);
    }
}
