//! Phase planes: the reachable set in position and velocity of one joint.

use reachtube_arm::ArmModel;
use reachtube_conform::claim::PhasePlane;
use reachtube_conform::{Model, Problem};
use reachtube_robot::JointKind;

use super::chart::{Chart, Series};
use crate::error::Result;
use crate::svg::{BLUE, GREY, ORANGE};

/// Draws the phase plane of each joint at the sample where a recording comes closest to the
/// boundary of the set, or leaves it furthest: the hull, the set in it, and the recordings.
pub(super) fn phase_planes(problem: &Problem, model: &Model) -> Result<Vec<Chart>> {
    let planes = PhasePlane::of_parts(problem, &model.sets())?;
    Ok(planes.iter().map(|plane| chart(plane, model)).collect())
}

fn chart(plane: &PhasePlane, model: &Model) -> Chart {
    let joint = &model.arm().robot.joints[plane.part];
    let kind: JointKind = joint.kind;
    let [[q_low, q_high], [v_low, v_high]] = plane.hull;
    let closed = |corners: &[[f64; 2]], colour| {
        let points = corners.iter().chain(corners.first()).map(|[q, qd]| (*q, *qd));
        Series::line(points.collect(), colour)
    };
    let hull = [[q_low, v_low], [q_high, v_low], [q_high, v_high], [q_low, v_high]];
    let points = plane.points.iter().map(|[q, qd]| (*q, *qd)).collect();
    Chart::new(
        format!("{}, {:.3} s", joint.name, plane.time),
        format!("position [{}]", kind.position_unit()),
        format!("velocity [{}]", kind.velocity_unit()),
        vec![closed(&hull, GREY), closed(&plane.polygon, BLUE), Series::dots(points, ORANGE)],
    )
}
