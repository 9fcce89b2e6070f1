//! Motors that torque sensors do not show.

use crate::code::Code;
use reachtube_finding::Finding;
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::findings::warning;

/// Returns a warning if torques were measured behind the gears and the robot has joints without
/// motor inertia.
pub(crate) fn unknown_motors(robot: &Robot, torque: Torque) -> Option<Finding> {
    let unknown = robot.joints().iter().filter(|joint| joint.armature == 0.0);
    let names: Vec<&str> = unknown.map(|joint| joint.name.as_str()).collect();
    (torque == Torque::Link && !names.is_empty()).then(|| {
        let text = format!(
            "the torques were measured behind the gears, where the inertia of the motors has no \
                effect, and the description has none for {}: the links of a wrist alone have \
                almost no inertia, so that its sets are wide; give `armature` for these joints, \
                kg m²",
            names.join(", ")
        );
        warning(Code::MotorsUnknown, &text)
    })
}
