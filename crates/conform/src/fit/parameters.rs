use std::f64::consts::LN_10;

use reachtube_robot::{GravityMoments, ParameterKind, Robot, RobotDescription};

use crate::arm::system::system;
use crate::data::correction::InputCorrection;
use crate::data::settings::Equations;
use crate::data::setup::Setup;
use crate::error::Result;
use crate::fit::group::Group;
use crate::fit::rising::{BEYOND_FITTED, RisingFriction};

/// The number of inertial parameters of a link.
const INERTIAL: usize = ParameterKind::INERTIAL.len();

/// What a number of a fit changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Quantity {
    /// The motor inertia: the number is half the logarithm of the factor on the inertia that the
    /// motor feels at the expansion point. Half, because a velocity that is scaled by a factor
    /// scales its inertia by the square.
    MotorInertia,
    /// The density of a link: half the logarithm of a factor.
    Density,
    /// v1: the logarithm of a factor.
    Viscous,
    /// v2 and v3: a factor minus 1.
    Cubic,
    /// Coulomb friction in these quadrants: a factor minus 1.
    Coulomb([bool; 4]),
    /// The change of v1 with the warmth, in parts of v1.
    WarmUp,
    /// The change of Coulomb friction with the warmth, in parts of it.
    WarmUpCoulomb,
    /// A mass, kg.
    Payload,
}

/// One number that a fit moves. The number 0 stands for the identified value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FreeParameter {
    pub quantity: Quantity,
    /// The joint, from 0.
    pub joint: usize,
    /// The lowest and the highest number allowed.
    pub bounds: [f64; 2],
}

/// The parameters of a fit, and the model that they give.
pub(crate) struct Parameters<'a> {
    setup: &'a Setup,
    /// The diagonal of the mass matrix at the expansion point, n, kg m².
    inertia: Vec<f64>,
    /// The inertial parameters of each link, 10 n.
    links: Vec<f64>,
    /// The temperatures above which warm-up counts, n, °C; `None` if it counts by the run.
    temperatures: Option<Vec<f64>>,
    pub list: Vec<FreeParameter>,
    /// Conditions on friction that could fall with speed.
    pub rising: Vec<RisingFriction>,
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

impl Quantity {
    /// Returns the group.
    pub(crate) fn group(self) -> Group {
        match self {
            Self::MotorInertia | Self::Density => Group::Inertia,
            Self::Viscous => Group::Viscous,
            Self::Cubic => Group::Cubic,
            Self::Coulomb(_) => Group::Coulomb,
            Self::WarmUp | Self::WarmUpCoulomb => Group::WarmUp,
            Self::Payload => Group::Payload,
        }
    }
}

impl<'a> Parameters<'a> {
    /// Lists the parameters of `groups` that the robot has. Without a velocity limit, friction must
    /// rise up to twice the highest speed of each joint in the recordings, `speeds`, rad/s; no
    /// speeds for a model whose friction is linear. Warm-up counts the temperatures above
    /// `temperatures`, n, °C, or ln(run) without them.
    pub(crate) fn new(
        setup: &'a Setup,
        groups: &[Group],
        speeds: &[f64],
        temperatures: Option<Vec<f64>>,
    ) -> Self {
        let robot = &setup.robot;
        let mass_matrix = robot.mass_matrix(&setup.settings.expansion_point.q);
        let inertia = mass_matrix.diagonal().iter().copied().collect();
        let (links, list) = (robot.inertial_parameters(), Vec::new());
        let mut parameters = Self { setup, inertia, links, temperatures, list, rising: Vec::new() };
        for group in Group::ALL.into_iter().filter(|group| groups.contains(group)) {
            for joint in 0..robot.joint_count() {
                let of_joint = parameters.of_joint(group, joint);
                let make = |(quantity, bounds)| FreeParameter { quantity, joint, bounds };
                parameters.list.extend(of_joint.into_iter().map(make));
            }
        }
        let rising = |(joint, speed): (usize, &f64)| {
            let (viscous, limit) =
                (robot.joints()[joint].friction.viscous, robot.joints()[joint].velocity_limit);
            let limit = limit.map_or(BEYOND_FITTED * speed, |limit| limit.max(*speed));
            let own = [viscous.v1, viscous.v2, viscous.v3];
            let fitted = [Quantity::Viscous, Quantity::Cubic].map(|quantity| {
                let is = |own: &FreeParameter| own.joint == joint && own.quantity == quantity;
                parameters.list.iter().position(is)
            });
            RisingFriction::new(fitted, own, limit)
        };
        parameters.rising = speeds.iter().enumerate().filter_map(rising).collect();
        parameters
    }

    /// Returns the parameters that are in none of the groups `held`.
    pub(crate) fn except(&self, held: &[Group]) -> Vec<usize> {
        let list = self.list.iter().enumerate();
        list.filter(|(_, own)| !held.contains(&own.quantity.group())).map(|(p, _)| p).collect()
    }

    /// Returns the numbers that a fit starts from: the identified values, but friction that rises.
    pub(crate) fn start(&self) -> Vec<f64> {
        let mut numbers = vec![0.0; self.len()];
        self.rising.iter().for_each(|condition| condition.start(&mut numbers));
        numbers
    }

    /// Returns the identified model.
    pub(crate) fn setup(&self) -> &'a Setup {
        self.setup
    }

    /// Returns the groups that have parameters.
    pub(crate) fn groups(&self) -> Vec<Group> {
        let has = |group: &Group| self.list.iter().any(|own| own.quantity.group() == *group);
        Group::ALL.into_iter().filter(has).collect()
    }

    /// Returns the number of parameters.
    pub(crate) fn len(&self) -> usize {
        self.list.len()
    }

    fn of_joint(&self, group: Group, joint: usize) -> Vec<(Quantity, [f64; 2])> {
        let drive = &self.setup.robot.joints()[joint];
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
                let coulomb = self.setup.robot.description().joints[joint].friction.coulomb;
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
        let a = self.setup.robot.description().joints[joint].friction.coulomb;
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

    /// Returns whether parameter `p` changes A and B, and not only the nominal motions.
    pub(crate) fn changes_model(&self, p: usize) -> bool {
        match self.list[p].quantity {
            Quantity::Cubic => self.setup.settings.abstraction.order >= 2,
            Quantity::Coulomb(_) | Quantity::WarmUp | Quantity::WarmUpCoulomb => false,
            _ => true,
        }
    }

    /// Returns whether the correction of a nominal motion may need the loads of gravity.
    pub(crate) fn needs_loads(&self) -> bool {
        let is_dry = |own: &FreeParameter| {
            matches!(own.quantity, Quantity::Coulomb(_) | Quantity::WarmUpCoulomb)
        };
        self.list.iter().any(is_dry) || !self.setup.robot.warms_by().is_empty()
    }

    /// Returns the identified and the fitted value of parameter `p`, and what multiplies the
    /// identified value where that is how it changes.
    pub(crate) fn values(&self, p: usize, number: f64) -> (f64, f64, Option<f64>) {
        let FreeParameter { quantity, joint, .. } = self.list[p];
        let viscous = &self.setup.robot.joints()[joint].friction.viscous;
        let times = |identified: f64, factor: f64| (identified, identified * factor, Some(factor));
        match quantity {
            Quantity::MotorInertia => times(self.inertia[joint], (2.0 * number).exp()),
            Quantity::Density => times(self.link(joint)[0], (2.0 * number).exp()),
            Quantity::Viscous => times(viscous.v1, number.exp()),
            Quantity::Cubic => times(viscous.v3, 1.0 + number),
            Quantity::Coulomb(quadrants) => {
                let a = self.setup.robot.description().joints[joint].friction.coulomb;
                times(a[2 * first(quadrants)], 1.0 + number)
            }
            Quantity::WarmUp => (0.0, viscous.v1 * self.per_warmth(number), None),
            Quantity::WarmUpCoulomb => (0.0, self.per_warmth(number), None),
            Quantity::Payload => (0.0, number, None),
        }
    }

    /// Returns whether warm-up counts by temperature.
    pub(crate) fn warms_by_temperature(&self) -> bool {
        self.temperatures.is_some()
    }

    /// Returns the change per unit of warmth that a number of warm-up stands for: per K or ln(run).
    fn per_warmth(&self, number: f64) -> f64 {
        if self.warms_by_temperature() { number / WARMING } else { number }
    }

    /// Returns the standard error of the identified value of parameter `p`, where the robot's
    /// description has it.
    pub(crate) fn standard_error(&self, p: usize) -> Option<f64> {
        let FreeParameter { quantity, joint, .. } = self.list[p];
        let errors = self.setup.robot.description().joints[joint].friction.standard_errors?;
        let error = match quantity {
            Quantity::Viscous => errors.viscous[0],
            Quantity::Cubic => errors.viscous[2],
            Quantity::Coulomb(quadrants) => errors.coulomb[2 * first(quadrants)],
            _ => 0.0,
        };
        (error > 0.0).then_some(error)
    }

    /// Returns the model with these numbers, one per parameter.
    ///
    /// # Errors
    ///
    /// When the robot is not physical at the expansion point.
    pub(crate) fn apply(&self, numbers: &[f64]) -> Result<Setup> {
        let Setup { robot, settings, nominal_starts, .. } = self.setup;
        let mut correction = InputCorrection::none(robot.joint_count());
        let (mut changed, mut values, mut links) = (Vec::new(), Vec::new(), self.links.clone());
        let mut change = |joint, kind, value| {
            changed.push(reachtube_robot::Parameter { joint, kind });
            values.push(value);
        };
        for (parameter, &number) in self.list.iter().zip(numbers) {
            let FreeParameter { quantity, joint, .. } = *parameter;
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
        if self.groups().contains(&Group::WarmUp) {
            correction.reference_temperatures.clone_from(&self.temperatures);
        }
        for (at, (new, old)) in links.iter().zip(&self.links).enumerate() {
            if new != old {
                change(at / INERTIAL, ParameterKind::INERTIAL[at % INERTIAL], *new);
            }
        }
        let mut description = robot.description().with_values(&changed, &values)?;
        if links != self.links {
            keep_weight(robot, &mut description);
        }
        let robot = Robot::from_description(&description)?;
        let correction = Some(correction);
        let (dynamics, condition) = (system(&robot, settings)?, None);
        let (settings, nominal_starts) = (settings.clone(), nominal_starts.clone());
        Ok(Setup { robot, dynamics, settings, nominal_starts, correction, condition })
    }

    /// The quadratic and cubic viscous friction that is missing at the order of the model, about
    /// the velocity of the expansion point. The robot's own equations leave nothing out.
    fn left_out(&self, joint: usize, v2: f64, v3: f64) -> [f64; 2] {
        if self.setup.settings.equations == Equations::Robot {
            return [0.0, 0.0];
        }
        let origin = self.setup.settings.expansion_point.qd[joint];
        match self.setup.settings.abstraction.order {
            1 => [v2 + 3.0 * v3 * origin, v3],
            2 => [0.0, v3],
            _ => [0.0, 0.0],
        }
    }
}

fn half(x: f64) -> f64 {
    0.5 * x
}

/// The first of some quadrants.
fn first(quadrants: [bool; 4]) -> usize {
    quadrants.iter().position(|is| *is).unwrap_or(0)
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
