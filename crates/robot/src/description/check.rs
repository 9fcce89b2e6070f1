//! Values that make no robot, each found with the key it stands under and a remedy.

use super::{InertiaPoint, JointDescription, Parameters, RobotDescription, SCHEMA_VERSION};
use crate::inertia::LinkInertia;
use nalgebra::{Matrix3, Vector3};
use std::collections::HashSet;

/// Rotations and mass distributions are accepted to this relative error, well above what printing
/// 12 digits loses.
const TOLERANCE: f64 = 1e-9;

/// A value that makes no robot.
pub(crate) struct Finding {
    /// Index of the joint, or `None` for the robot as a whole.
    pub joint: Option<usize>,
    pub key: &'static str,
    pub problem: String,
    pub remedy: &'static str,
}

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
    /// The first value that makes no robot.
    pub(crate) fn check(&self) -> Result<(), Finding> {
        self.check_whole().map_err(|f| finding(None, f))?;
        let mut names = HashSet::new();
        for (i, joint) in self.joints.iter().enumerate() {
            let unique = names.insert(joint.name.as_str());
            require(unique, "name", "give each joint its own name", || {
                "the name occurs twice".into()
            })
            .and_then(|()| self.check_joint(joint))
            .map_err(|f| finding(Some(i), f))?;
        }
        Ok(())
    }

    fn check_whole(&self) -> Checked {
        require(
            self.schema_version == SCHEMA_VERSION,
            "schema_version",
            "use the version of reachtube that wrote it, or rewrite it",
            || format!("schema_version {} is not {SCHEMA_VERSION}", self.schema_version),
        )?;
        require(!self.joints.is_empty(), "joint", "add a [[joint]] for each joint", || {
            "no joints".into()
        })?;
        finite("gravity", &self.gravity)
    }

    fn check_joint(&self, joint: &JointDescription) -> Checked {
        require(!joint.name.is_empty(), "name", "name the joint", || "the name is empty".into())?;
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
        if self.parameters == Parameters::Physical { check_body(joint) } else { Ok(()) }
    }
}

fn finding(
    joint: Option<usize>,
    (key, problem, remedy): (&'static str, String, &'static str),
) -> Finding {
    Finding { joint, key, problem, remedy }
}

fn finite(key: &'static str, values: &[f64]) -> Checked {
    let bad = values.iter().find(|v| !v.is_finite());
    require(bad.is_none(), key, "give a finite number", || {
        format!("{key} holds {}", bad.unwrap_or(&0.0))
    })
}

fn check_geometry(joint: &JointDescription) -> Checked {
    require(
        joint.dh.is_some() != joint.placement.is_some(),
        if joint.dh.is_some() { "dh" } else { "name" },
        "give either `dh` or `placement`",
        || "the geometry is given twice or not at all".into(),
    )?;
    if let Some(dh) = joint.dh {
        require(joint.axis.is_none(), "axis", "leave the axis out: with dh it is z", || {
            "axis beside dh".into()
        })?;
        finite("dh", &[dh.a, dh.alpha, dh.theta, dh.d])?;
    }
    check_placement(joint)?;
    let axis = Vector3::from(joint.axis.unwrap_or([0.0, 0.0, 1.0]));
    finite("axis", axis.as_slice())?;
    require(axis.norm() > TOLERANCE, "axis", "give the direction of the joint's axis", || {
        format!("the axis {:?} has no direction", axis.as_slice())
    })
}

fn check_placement(joint: &JointDescription) -> Checked {
    let Some(placement) = joint.placement else { return Ok(()) };
    finite("placement", &placement.translation)?;
    finite("placement", &placement.rpy.unwrap_or_default())?;
    let Some(rows) = placement.rotation else { return Ok(()) };
    require(placement.rpy.is_none(), "placement", "give either `rotation` or `rpy`", || {
        "rotation beside rpy".into()
    })?;
    finite("placement", rows.as_flattened())?;
    let r = Matrix3::from_row_slice(rows.as_flattened());
    let error = (r * r.transpose() - Matrix3::identity()).amax();
    require(
        error < TOLERANCE && r.determinant() > 0.0,
        "placement",
        "print the rotation with 12 digits",
        || {
            let det = r.determinant();
            format!(
                "rotation is not one: |R Rᵀ - 1| = {error:.1e} (limit {TOLERANCE:.0e}), det R = {det:.3}"
            )
        },
    )
}

fn check_drive(joint: &JointDescription) -> Checked {
    require(
        joint.armature.is_none() || joint.rotor_inertia.is_none(),
        "rotor_inertia",
        "give either `armature` (link's side) or `rotor_inertia` (motor's side)",
        || "the motor inertia is given twice".into(),
    )?;
    require(
        joint.rotor_inertia.is_none() || joint.gear_ratio.is_some(),
        "rotor_inertia",
        "add `gear_ratio`, or give `armature` on the link's side",
        || "rotor_inertia without gear_ratio".into(),
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
    finite("friction", &joint.friction.coulomb)?;
    finite("friction", &joint.friction.viscous)
}

fn check_limits(joint: &JointDescription) -> Checked {
    let [low, high] = joint.position_limits.unwrap_or([0.0, 1.0]);
    finite("position_limits", &[low, high])?;
    require(low < high, "position_limits", "give the lower limit first", || {
        format!("position_limits [{low}, {high}] hold no position")
    })?;
    let speed = joint.velocity_limit.unwrap_or(1.0);
    finite("velocity_limit", &[speed])?;
    require(speed > 0.0, "velocity_limit", "give a positive speed in rad/s", || {
        format!("velocity_limit = {speed} allows no motion")
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
        || "an inertia about the centre of mass with first_moment".into(),
    )?;
    let heavy = joint.gravity_moments.unwrap_or_default();
    finite("gravity_moments", &[heavy.mass])?;
    finite("gravity_moments", &heavy.first_moment)
}

/// Checks that some distribution of mass has these parameters.
fn check_body(joint: &JointDescription) -> Checked {
    let remedy =
        "correct it, or set parameters = \"base\" where only identified combinations are meant";
    require(joint.mass >= 0.0, "mass", remedy, || format!("mass = {} kg is negative", joint.mass))?;
    let (_, _, about_com) = joint.about_own_com();
    let principal = principal_spreads(&about_com);
    let scale = principal.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let least = principal.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    require(least >= -TOLERANCE * scale, "inertia", remedy, || {
        format!(
            "inertia {:?} about the centre of mass is that of no body: one principal inertia exceeds the sum of the \
             other two by {:.3e} kg m²",
            about_com,
            -2.0 * least
        )
    })?;
    let least = joint.link_inertia().smallest_relative_eigenvalue();
    require(least >= -TOLERANCE, "inertia", remedy, || {
        format!("mass {} kg and inertia {:?} belong to no body", joint.mass, joint.inertia)
    })
}

/// Half of what each principal inertia lacks to the sum of the other two: the principal second
/// moments.
fn principal_spreads(inertia: &[f64; 6]) -> [f64; 3] {
    let [xx, xy, xz, yy, yz, zz] = *inertia;
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let link = LinkInertia::about_origin(0.0, Vector3::zeros(), &tensor);
    link.second_moments.symmetric_eigenvalues().into()
}
