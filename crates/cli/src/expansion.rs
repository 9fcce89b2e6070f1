//! The point about which a model is expanded.

use reachtube::abstraction::ExpansionPoint;
use reachtube_robot::Robot;

use crate::error::Result;
use crate::output;

/// Returns the point of `--expansion`. A position beyond the limits of its joint is a warning.
pub(crate) fn expansion_point(values: &[f64], robot: &Robot) -> Result<ExpansionPoint> {
    let point = ExpansionPoint::from_values(values, robot.joint_count())?;
    // Without values the point is 0, which limits of a joint may exclude.
    let beyond = point.beyond_limits(robot).filter(|_| !values.is_empty());
    if let Some((joint, q)) = beyond.map(|index| (&robot.joints()[index], point.q[index])) {
        let ([low, high], unit) = (joint.position_limits, joint.kind.position_unit());
        output::warn(&format!(
            "joint `{}`: --expansion has it at {q} {unit}, but its limits are {low} and {high} \
             {unit}; give a position within the limits",
            joint.name
        ));
    }
    Ok(point)
}
