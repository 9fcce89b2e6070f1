use crate::error::Result;
use crate::inertia::columns::inertia_part;
use crate::inertia::fit::InertiaFit;
use crate::variant::with_parameters;
use reachtube_robot::{
    FrictionDescription, FrictionErrors, Parameter, ParameterKind, ParameterSet, Robot,
    RobotDescription,
};

/// Returns the description of the identified robot.
///
/// Its friction is `friction`, one entry per joint, plus the friction that was fitted together with
/// the inertial parameters.
///
/// # Errors
///
/// [`Error::Robot`](crate::Error::Robot) if the parameters give no robot.
pub(crate) fn description(
    robot: &Robot,
    found: &InertiaFit,
    friction: &[FrictionDescription],
) -> Result<RobotDescription> {
    let (columns, values) = inertia_part(&found.columns, &found.values);
    let mut out = with_parameters(robot, &columns, &values)?.description().clone();
    out.parameters =
        if found.physical.is_some() { ParameterSet::Physical } else { ParameterSet::Base };
    for (joint, friction) in out.joints.iter_mut().zip(friction) {
        joint.friction = *friction;
    }
    for (column, value) in found.columns.iter().zip(found.values.iter()) {
        add_friction(&mut out.joints[column.joint].friction, column, *value);
    }
    Ok(out)
}

/// Adds the value of a friction column; other columns change nothing.
fn add_friction(friction: &mut FrictionDescription, column: &Parameter, value: f64) {
    let FrictionDescription { coulomb, viscous, .. } = friction;
    // Offsets of driving forward, driving backward, braking backward, braking forward.
    let mut add = |signs: [f64; 4]| (0..4).for_each(|q| coulomb[2 * q] += signs[q] * value);
    match column.kind {
        ParameterKind::Coulomb => add([1.0, -1.0, -1.0, 1.0]),
        ParameterKind::Offset => add([1.0; 4]),
        ParameterKind::Viscous1 => viscous[0] += value,
        ParameterKind::Viscous2 => viscous[1] += value,
        ParameterKind::Viscous3 => viscous[2] += value,
        _ => {}
    }
}

/// Returns the standard errors of the friction of joint `joint`, whose known friction has the
/// standard errors `known`. A coefficient that was corrected by the fit has the errors of the fit.
pub(crate) fn friction_errors(
    found: &InertiaFit,
    joint: usize,
    known: Option<&FrictionDescription>,
) -> Option<FrictionErrors> {
    let start = |known: &FrictionDescription| FrictionErrors {
        coulomb: known.coulomb,
        viscous: known.viscous,
    };
    let mut errors = known.map(start).unwrap_or_default();
    // Constant and offset both take part in the offsets of the quadrants.
    let mut offset = 0.0f64;
    for (column, error) in found.columns.iter().zip(&found.standard_errors) {
        let Some(error) = error.filter(|_| column.joint == joint) else { continue };
        match column.kind {
            ParameterKind::Coulomb | ParameterKind::Offset => offset = offset.hypot(error),
            ParameterKind::Viscous1 => errors.viscous[0] = error,
            ParameterKind::Viscous2 => errors.viscous[1] = error,
            ParameterKind::Viscous3 => errors.viscous[2] = error,
            _ => {}
        }
    }
    if offset > 0.0 {
        errors.coulomb.iter_mut().step_by(2).for_each(|error| *error = offset);
    }
    (errors != FrictionErrors::default()).then_some(errors)
}
