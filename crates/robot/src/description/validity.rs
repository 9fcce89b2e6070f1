//! Checks of a description: the first invalid value, with its key and a remedy.

use super::joint_description::{FrictionErrors, InertiaPoint, JointDescription};
use super::robot_description::{ParameterSet, RobotDescription, SCHEMA_VERSION};
use crate::friction::stribeck::Stribeck;
use crate::friction::warming::{Warming, WarmingBy};
use crate::inertia::LinkInertia;
use crate::joint_kind::JointKind;
use nalgebra::{Matrix3, Vector3};
use std::collections::HashSet;

/// Relative error up to which rotations and mass distributions are accepted. It is well above the
/// error of numbers with 12 digits.
const TOLERANCE: f64 = 1e-9;

/// Largest number of joints. The dynamics need memory that grows with its square.
const MOST_JOINTS: usize = 100;

/// An invalid value of a description.
pub(crate) struct InvalidValue {
    /// Index of the joint, or `None` for the robot as a whole.
    pub joint: Option<usize>,
    /// Key of the value in the description.
    pub key: &'static str,
    pub problem: String,
    pub remedy: &'static str,
}

/// The result of a check; the error is (key, problem, remedy).
type Checked = Result<(), (&'static str, String, &'static str)>;

fn require(
    holds: bool,
    key: &'static str,
    remedy: &'static str,
    problem: impl FnOnce() -> String,
) -> Checked {
    if holds { Ok(()) } else { Err((key, problem(), remedy)) }
}

impl RobotDescription {
    /// Returns the joints whose link has a mass and an inertia that no body has.
    #[must_use]
    pub fn impossible_links(&self) -> Vec<&str> {
        let is_impossible = |joint: &&JointDescription| {
            check_link_numbers(joint).is_ok() && check_body(joint).is_err()
        };
        self.joints.iter().filter(is_impossible).map(|joint| joint.name.as_str()).collect()
    }

    /// Checks all values; the error is the first invalid one.
    pub(crate) fn check(&self) -> Result<(), InvalidValue> {
        self.check_robot().map_err(|e| invalid(None, e))?;
        let mut names = HashSet::new();
        for (i, joint) in self.joints.iter().enumerate() {
            let unique = names.insert(joint.name.as_str());
            require(unique, "name", "give each joint its own name", || {
                "the name occurs twice".into()
            })
            .and_then(|()| self.check_joint(joint))
            .map_err(|e| invalid(Some(i), e))?;
        }
        Ok(())
    }

    fn check_robot(&self) -> Checked {
        require(
            self.schema_version == SCHEMA_VERSION,
            "schema_version",
            "use the version of reachtube that wrote the description, or convert it",
            || {
                format!(
                    "schema_version {} is not supported, only {SCHEMA_VERSION} is",
                    self.schema_version
                )
            },
        )?;
        require(!self.joints.is_empty(), "joint", "add a [[joint]] table for each joint", || {
            "the robot has no joints".into()
        })?;
        let count = self.joints.len();
        require(count <= MOST_JOINTS, "joint", "describe one serial chain", || {
            format!("the robot has {count} joints, but at most {MOST_JOINTS} are supported")
        })?;
        finite("gravity", &self.gravity)
    }

    fn check_joint(&self, joint: &JointDescription) -> Checked {
        require(!joint.name.is_empty(), "name", "give the joint a name", || {
            "the name is empty".into()
        })?;
        check_geometry(joint)?;
        check_drive(joint)?;
        check_limits(joint)?;
        check_link_numbers(joint)?;
        let all = self
            .joints
            .iter()
            .all(|j| j.gravity_moments.is_some() == joint.gravity_moments.is_some());
        require(all, "gravity_moments", "give gravity_moments for all joints or for none", || {
            "only some joints have gravity_moments".into()
        })?;
        if self.parameters == ParameterSet::Physical { check_body(joint) } else { Ok(()) }
    }
}

fn invalid(
    joint: Option<usize>,
    (key, problem, remedy): (&'static str, String, &'static str),
) -> InvalidValue {
    InvalidValue { joint, key, problem, remedy }
}

fn finite(key: &'static str, values: &[f64]) -> Checked {
    let bad = values.iter().find(|v| !v.is_finite());
    require(bad.is_none(), key, "give finite numbers", || {
        format!("{key} contains {}", bad.unwrap_or(&0.0))
    })
}

fn check_geometry(joint: &JointDescription) -> Checked {
    require(
        joint.dh.is_some() != joint.placement.is_some(),
        if joint.dh.is_some() { "dh" } else { "name" },
        "give either `dh` or `placement`",
        || match joint.dh {
            Some(_) => "both `dh` and `placement` are given".into(),
            None => "neither `dh` nor `placement` is given".into(),
        },
    )?;
    if let Some(dh) = joint.dh {
        require(joint.axis.is_none(), "axis", "remove `axis`: the axis of `dh` is z", || {
            "`axis` is given together with `dh`".into()
        })?;
        finite("dh", &[dh.a, dh.alpha, dh.theta, dh.d])?;
    }
    check_placement(joint)?;
    let axis = Vector3::from(joint.axis.unwrap_or([0.0, 0.0, 1.0]));
    finite("axis", axis.as_slice())?;
    require(axis.norm() > TOLERANCE, "axis", "give a vector of positive length", || {
        format!("the axis {:?} has no direction", axis.as_slice())
    })
}

fn check_placement(joint: &JointDescription) -> Checked {
    let Some(placement) = joint.placement else { return Ok(()) };
    finite("placement", &placement.translation)?;
    finite("placement", &placement.rpy.unwrap_or_default())?;
    let Some(rows) = placement.rotation else { return Ok(()) };
    require(placement.rpy.is_none(), "placement", "give either `rotation` or `rpy`", || {
        "both `rotation` and `rpy` are given".into()
    })?;
    finite("placement", rows.as_flattened())?;
    let r = Matrix3::from_row_slice(rows.as_flattened());
    let error = (r * r.transpose() - Matrix3::identity()).amax();
    require(
        error < TOLERANCE && r.determinant() > 0.0,
        "placement",
        "give an orthonormal, right-handed matrix with 12 digits",
        || {
            let det = r.determinant();
            format!(
                "`rotation` is not a rotation matrix: |R Rᵀ - 1| = {error:.1e} \
                 (limit {TOLERANCE:.0e}), det R = {det:.3}"
            )
        },
    )
}

fn check_drive(joint: &JointDescription) -> Checked {
    require(
        joint.armature.is_none() || joint.rotor_inertia.is_none(),
        "rotor_inertia",
        "give either `armature` (link side) or `rotor_inertia` (motor side)",
        || "the motor inertia is given twice".into(),
    )?;
    require(
        joint.rotor_inertia.is_none() || joint.gear_ratio.is_some(),
        "rotor_inertia",
        "add `gear_ratio`, or give `armature` in place of `rotor_inertia`",
        || "`rotor_inertia` is given without `gear_ratio`".into(),
    )?;
    let given = [joint.armature, joint.rotor_inertia, joint.gear_ratio];
    for (key, value) in ["armature", "rotor_inertia", "gear_ratio"].into_iter().zip(given) {
        let value = value.unwrap_or_default();
        finite(key, &[value])?;
        require(
            value >= 0.0 || key == "gear_ratio",
            key,
            "give a motor inertia of at least 0",
            || format!("{key} = {value} is negative"),
        )?;
    }
    require(
        joint.gear_ratio != Some(0.0),
        "gear_ratio",
        "give the gear's ratio, or remove it",
        || "gear_ratio = 0 leaves no motor inertia".into(),
    )?;
    finite("friction", &joint.friction.coulomb)?;
    finite("friction", &joint.friction.viscous)?;
    if let Some(FrictionErrors { coulomb, viscous }) = joint.friction.standard_errors {
        let errors = [&coulomb[..], &viscous[..]].concat();
        finite("friction", &errors)?;
        require(
            errors.iter().all(|error| *error >= 0.0),
            "friction",
            "give standard errors of at least 0",
            || "a standard error is negative".into(),
        )?;
    }
    if let Some([low, high]) = joint.friction.fitted_velocities {
        finite("friction", &[low, high])?;
        require(low <= high, "friction", "give the lower velocity first", || {
            let unit = joint.kind.velocity_unit();
            format!("fitted_velocities [{low}, {high}] {unit}: the first exceeds the second")
        })?;
    }
    check_stribeck(joint)?;
    check_warming(joint)
}

fn check_stribeck(joint: &JointDescription) -> Checked {
    let Some(Stribeck { excess, speed }) = joint.friction.stribeck else { return Ok(()) };
    finite("friction", &[excess, speed])?;
    require(
        joint.friction.dissipates_at_standstill(),
        "friction",
        "give breakaway minus Coulomb friction; a negative excess must not exceed Coulomb friction",
        || {
            let unit = joint.kind.force_unit();
            format!("stribeck: with excess = {excess} {unit}, friction drives near standstill")
        },
    )?;
    require(speed > 0.0, "friction", "give a positive speed, or remove `stribeck`", || {
        format!("stribeck: speed = {speed} {} is not positive", joint.kind.velocity_unit())
    })
}

fn check_warming(joint: &JointDescription) -> Checked {
    let Some(law) = joint.friction.warming else { return Ok(()) };
    let Warming { by, reference, time_constant, coulomb, viscous } = law;
    finite("friction", &[reference, coulomb, viscous, time_constant.unwrap_or(1.0)])?;
    let (largest, unit) = (most_rate(by), by.rate_unit());
    for (name, rate) in [("coulomb", coulomb), ("viscous", viscous)] {
        require(rate.abs() <= largest, "friction", "give the rate per unit of warmth", || {
            format!("warming: {name} = {rate} exceeds ±{largest} {unit}")
        })?;
    }
    let by_runs = by != WarmingBy::Temperature;
    require(!by_runs || reference >= 1.0, "friction", "count runs from 1", || {
        format!("warming: reference = {reference} is no run")
    })?;
    require(
        time_constant.is_some() == (by == WarmingBy::Thermal),
        "friction",
        "give `time_constant` with by = \"thermal\", and only with it",
        || "warming: `time_constant` does not suit `by`".into(),
    )?;
    require(time_constant.is_none_or(|tau| tau > 0.0), "friction", "give runs above 0", || {
        format!(
            "warming: time_constant = {} runs is not positive",
            time_constant.unwrap_or_default()
        )
    })
}

/// Returns the largest rate at which friction stays finite at all temperatures and runs.
fn most_rate(by: WarmingBy) -> f64 {
    match by {
        WarmingBy::Temperature => 0.5,
        WarmingBy::Runs | WarmingBy::Thermal => 10.0,
    }
}

fn check_limits(joint: &JointDescription) -> Checked {
    let (unit, kind) = (joint.kind.position_unit(), joint.kind);
    require(
        joint.position_limits.is_some() || kind == JointKind::Revolute,
        "name",
        "give the lowest and the highest position in m; a turn bounds a revolute joint, but \
         nothing bounds a slide, and the mass matrix is checked over all positions",
        || "the joint is prismatic and has no position limits".into(),
    )?;
    let [low, high] = joint.position_limits.unwrap_or([0.0, 1.0]);
    finite("position_limits", &[low, high])?;
    require(low < high, "position_limits", "give the lower limit first", || {
        format!(
            "position_limits [{low}, {high}] {unit}: the lower limit is not less than the upper one"
        )
    })?;
    let speed = joint.velocity_limit.unwrap_or(1.0);
    finite("velocity_limit", &[speed])?;
    require(speed > 0.0, "velocity_limit", "give a positive speed", || {
        format!("velocity_limit = {speed} {} is not positive", kind.velocity_unit())
    })
}

fn check_link_numbers(joint: &JointDescription) -> Checked {
    finite("mass", &[joint.mass])?;
    finite("com", &joint.com.unwrap_or_default())?;
    finite("first_moment", &joint.first_moment.unwrap_or_default())?;
    finite("inertia", &joint.inertia)?;
    require(
        joint.com.is_none() || joint.first_moment.is_none(),
        "first_moment",
        "give either `com` or `first_moment`",
        || "the centre of mass is given twice".into(),
    )?;
    require(
        joint.about == InertiaPoint::Origin || joint.first_moment.is_none(),
        "about",
        "set about = \"origin\", or give `com`",
        || "`first_moment` is given, but `inertia` is about the centre of mass".into(),
    )?;
    let gravity = joint.gravity_moments.unwrap_or_default();
    finite("gravity_moments", &[gravity.mass])?;
    finite("gravity_moments", &gravity.first_moment)
}

/// Checks that some distribution of mass has these parameters.
fn check_body(joint: &JointDescription) -> Checked {
    let remedy = "correct the value, or set parameters = \"base\" if only the base parameters have \
                  a meaning";
    require(joint.mass >= 0.0, "mass", remedy, || format!("mass = {} kg is negative", joint.mass))?;
    let (_, _, about_com) = joint.about_own_com();
    let principal = principal_second_moments(&about_com);
    let scale = principal.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let least = principal.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    require(least >= -TOLERANCE * scale, "inertia", remedy, || {
        format!(
            "inertia {:?} kg m² about the centre of mass belongs to no body: one principal moment \
             of inertia exceeds the sum of the other two by {:.3e} kg m²",
            about_com,
            -2.0 * least
        )
    })?;
    let least = joint.link_inertia().smallest_relative_eigenvalue();
    require(least >= -TOLERANCE, "inertia", remedy, || {
        format!(
            "mass {} kg and inertia {:?} kg m² belong to no body: the smallest relative \
             eigenvalue of the pseudo-inertia is {least:.1e}, but it must be at least 0",
            joint.mass, joint.inertia
        )
    })
}

/// Returns the principal second moments: for each principal moment of inertia, half the amount by
/// which the sum of the other two exceeds it.
fn principal_second_moments(inertia: &[f64; 6]) -> [f64; 3] {
    let [xx, xy, xz, yy, yz, zz] = *inertia;
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let link = LinkInertia::about_origin(0.0, Vector3::zeros(), &tensor);
    link.second_moments.symmetric_eigenvalues().into()
}
