use reachtube_conform::Group;
use reachtube_robot::JointKind;

/// What a number of a fit changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Quantity {
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

/// What a number of a fit changes, and of which joint (from 0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OfJoint {
    pub quantity: Quantity,
    pub joint: usize,
}

impl Quantity {
    /// Returns the group.
    pub(super) fn group(self) -> Group {
        match self {
            Self::MotorInertia | Self::Density => Group::Inertia,
            Self::Viscous => Group::Viscous,
            Self::Cubic => Group::Cubic,
            Self::Coulomb(_) => Group::Coulomb,
            Self::WarmUp | Self::WarmUpCoulomb => Group::WarmUp,
            Self::Payload => Group::Payload,
        }
    }

    /// Returns a number that differs from kind to kind.
    pub(super) fn kind(self) -> u8 {
        match self {
            Self::MotorInertia => 0,
            Self::Density => 1,
            Self::Viscous => 2,
            Self::Cubic => 3,
            Self::Coulomb(_) => 4,
            Self::WarmUp => 5,
            Self::WarmUpCoulomb => 6,
            Self::Payload => 7,
        }
    }

    /// Returns its name and unit for a joint of a kind, for people.
    pub(super) fn name_and_unit(self, kind: JointKind, by_temperature: bool) -> (String, String) {
        let of_velocity =
            |power| format!("{}/({}){power}", kind.force_unit(), kind.velocity_unit());
        let (name, unit) = match self {
            Self::MotorInertia => ("inertia at the motor", kind.inertia_unit().into()),
            Self::Density => ("mass of the link", "kg".into()),
            Self::Viscous => ("viscous friction", of_velocity("")),
            Self::Cubic => ("cubic friction", of_velocity("³")),
            Self::Coulomb(quadrants) => (coulomb_name(quadrants), kind.force_unit().into()),
            Self::WarmUp if by_temperature => ("viscous friction per K", of_velocity("") + "/K"),
            Self::WarmUp => ("viscous friction per unit of ln(run)", of_velocity("")),
            Self::WarmUpCoulomb => ("part of Coulomb friction per K", "1/K".into()),
            Self::Payload => ("payload", "kg".into()),
        };
        (name.into(), unit)
    }
}

/// The first of some quadrants.
pub(super) fn first(quadrants: [bool; 4]) -> usize {
    quadrants.iter().position(|is| *is).unwrap_or(0)
}

fn coulomb_name(quadrants: [bool; 4]) -> &'static str {
    match quadrants {
        [true, false, false, false] => "Coulomb friction, driving forward",
        [false, true, false, false] => "Coulomb friction, driving backward",
        [false, false, true, false] => "Coulomb friction, braking backward",
        [false, false, false, true] => "Coulomb friction, braking forward",
        _ => "Coulomb friction",
    }
}
