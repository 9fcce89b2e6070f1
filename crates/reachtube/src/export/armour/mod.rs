//! The header of the planner ARMOUR (Michaux et al., "Can't Touch This: Real-Time, Safe Motion
//! Planning and Control for Manipulators Under Uncertainty"): an arm with ratios of uncertainty
//! and bounds of its mass matrix.

mod arm;
mod friction;
mod header;
mod settings;

use nalgebra::Vector3;
use reachtube_robot::{Physicality, Robot};
use reachtube_scalar::Interval;
use reachtube_verify::Capsules;

use super::{ExportError, ExportFile};
use arm::Arm;
use friction::JointFriction;
pub use settings::ArmourSettings;
use settings::refused;

/// Number of boxes of positions for each bound of the mass matrix.
const BOXES: usize = 3000;

/// Part by which written bounds are wider than the computed ones, for the rounding of rotations.
const ROUNDING: f64 = 1e-9;

/// Largest angle, as a sine, between gravity and the base's z axis.
const UPRIGHT: f64 = 1e-9;

/// What the header says of a robot.
#[derive(Debug, Clone)]
pub struct Armour {
    /// A lower bound of the least and an upper bound of the largest eigenvalue of the mass matrix,
    /// kg m².
    pub mass_matrix: [f64; 2],
    /// Bound of the friction of each joint that is no viscous line \[N m\].
    pub friction: Vec<f64>,
    /// The file.
    pub files: Vec<ExportFile>,
}

impl Armour {
    /// Proves the bounds and writes the header.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding, for the numbers in the header: `mass_matrix` holds at all
    /// positions within the limits for every arm whose masses and entries of inertia differ by at
    /// most the ratio from the header's; `friction` holds for loads up to the torque limit and
    /// velocities up to the velocity limit. Nothing is proved of the ratio itself.
    ///
    /// # Errors
    ///
    /// [`ExportError::Refused`] for a robot or setting that ARMOUR cannot have, and
    /// [`ExportError::NotPhysical`] or [`ExportError::SeparateGravity`] for links that are no
    /// bodies.
    pub fn new(
        robot: &Robot,
        capsules: &Capsules,
        settings: &ArmourSettings,
    ) -> Result<Self, ExportError> {
        check(robot, settings)?;
        let arm = Arm::new(robot, capsules)?;
        let mass_matrix = mass_matrix_bounds(&arm, robot, settings.uncertainty)?;
        let friction: Vec<JointFriction> = (0..robot.joint_count())
            .map(|j| JointFriction::new(robot, j, settings.torque_limits[j]))
            .collect::<Result<_, _>>()?;
        let text = header::text(robot, &arm, settings, mass_matrix, &friction);
        let friction = friction.iter().map(|friction| friction.dry).collect();
        Ok(Self { mass_matrix, friction, files: vec![ExportFile::new("RobotInfo.h", text)] })
    }
}

/// Checks the settings, and that gravity points down the base's z axis.
fn check(robot: &Robot, settings: &ArmourSettings) -> Result<(), ExportError> {
    let n = robot.joint_count();
    if settings.torque_limits.len() != n || !settings.torque_limits.iter().all(|t| *t > 0.0) {
        let problem = format!("{} torque limits are given", settings.torque_limits.len());
        let remedy = format!("give {n} positive limits in N m, one per joint");
        return Err(refused(robot, "torque limits", &problem, &remedy));
    }
    if !(0.0..1.0).contains(&settings.uncertainty) {
        let problem = format!("the ratio {} is not in 0 to 1", settings.uncertainty);
        return Err(refused(robot, "uncertainty", &problem, "0.03 means 3 %"));
    }
    let gravity = Vector3::from(robot.gravity_acceleration());
    let across = gravity.x.hypot(gravity.y);
    if across > UPRIGHT * gravity.norm() || gravity.z > 0.0 {
        let problem = "gravity does not point down the base's z axis, as ARMOUR takes it";
        return Err(refused(robot, "gravity", problem, "describe the robot in a base that stands"));
    }
    Ok(())
}

/// Bounds the eigenvalues of the mass matrices of all arms within the ratio.
///
/// Let M = A + L with the armatures A. A mass that differs by the ratio r changes a part of L that
/// is positive semidefinite by at most r of it. An inertia I that differs by r in each entry
/// changes ωᵀ I ω by at most r ‖I‖∞ |ω|², and link i of unit axes has |ω|² ≤ i |q̇|². With e the
/// sum of these, (1 - r) L - e ≤ L' ≤ (1 + r) L + e.
fn mass_matrix_bounds(arm: &Arm, robot: &Robot, ratio: f64) -> Result<[f64; 2], ExportError> {
    let bodies = matches!(arm.robot.check_physical(), Ok(Physicality::Links { .. }));
    if ratio > 0.0 && !bodies {
        let problem = "its links are not proved to be bodies, so that no ratio can be considered";
        let remedy = "identify it with physical links (model.physical = true in the settings of \
                      identify)";
        return Err(refused(robot, "links", problem, remedy));
    }
    let [least, largest] = arm.robot.mass_matrix_bounds(BOXES).map(Interval::point);
    let r = Interval::point(ratio);
    let one = Interval::point(1.0);
    let spread = arm.links.iter().enumerate().fold(Interval::ZERO, |sum, (i, link)| {
        let rows = (0..3).map(|row| {
            let entries = (0..3).map(|k| Interval::point(link.inertia[(row, k)].abs()));
            entries.fold(Interval::ZERO, |sum, entry| sum + entry).hi()
        });
        let norm = rows.fold(0.0, f64::max);
        sum + Interval::point(norm) * Interval::point((i + 1) as f64)
    });
    let armatures = arm.links.iter().map(|link| link.armature);
    let smallest = Interval::point(armatures.fold(f64::INFINITY, f64::min));
    let low = (one - r) * least + r * (smallest - spread);
    let high = (one + r) * largest + r * (spread - smallest);
    let low = (low * Interval::point(1.0 - ROUNDING)).lo();
    if low <= 0.0 {
        let problem = format!(
            "its mass matrix is not proved positive definite within the ratio (bound {low:.2e})"
        );
        let remedy = "give a smaller ratio, or the motor inertias (armature) of the joints";
        return Err(refused(robot, "mass matrix", &problem, remedy));
    }
    Ok([low, (high * Interval::point(1.0 + ROUNDING)).hi()])
}
