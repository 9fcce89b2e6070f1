//! Friction at speeds that it was not fitted on.

use crate::data::problem::Problem;
use crate::plausibility::warning::{Remark, Warning, WarningKind};

/// Speeds beyond the fitted ones by this part are remarked: filters differ.
const TOLERANCE: f64 = 0.02;

/// Returns the remark that the recordings of a joint (from 0) are faster than the recordings that
/// its friction was fitted to, where the robot's description knows them.
pub(super) fn beyond_fitted(problem: &Problem, joint: usize) -> Option<Remark> {
    let fitted = problem.robot().description().joints[joint].friction.fitted_velocities?;
    let [low, high] = problem.recorded_bounds(problem.joints() + joint);
    let room = TOLERANCE * (fitted[1] - fitted[0]);
    let (speed, limit) = match (fitted[0] - low, high - fitted[1]) {
        (below, above) if below > room.max(above) => (-low, -fitted[0]),
        (_, above) if above > room => (high, fitted[1]),
        _ => return None,
    };
    let unit = problem.robot().kinds()[joint].velocity_unit();
    let text = format!("joint {} {speed:.2} {unit}, {limit:.2}", joint + 1);
    Some(Remark { kind: WarningKind::FrictionRange, joint: joint + 1, text })
}

/// Returns the remark that the viscous friction of a joint (from 0) falls with speed before the
/// velocity limit of the joint, or the highest recorded speed without one.
pub(super) fn falling(problem: &Problem, joint: usize) -> Option<Remark> {
    let own = &problem.robot().joints()[joint];
    let limit = own.velocity_limit.unwrap_or(0.0).max(problem.highest_speed(joint));
    let speed = own.friction.viscous.falls_beyond(limit)?;
    let unit = own.kind.velocity_unit();
    let text = format!("joint {} {speed:.2} {unit}, {limit:.2}", joint + 1);
    Some(Remark { kind: WarningKind::FallingFriction, joint: joint + 1, text })
}

/// Returns a warning where the recordings of a problem are faster than the recordings that friction
/// was fitted to.
pub(crate) fn friction_warning(problem: &Problem) -> Option<Warning> {
    let remarks: Vec<Remark> =
        (0..problem.joints()).filter_map(|joint| beyond_fitted(problem, joint)).collect();
    let all: Vec<&Remark> = remarks.iter().collect();
    (!all.is_empty()).then(|| Warning::of_remarks(WarningKind::FrictionRange, &all))
}
