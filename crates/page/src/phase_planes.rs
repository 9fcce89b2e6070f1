//! Phase planes: the reachable set in position and velocity of one joint.

use reachtube_conform::claim::PhasePlane;
use reachtube_conform::{Model, Problem};
use reachtube_robot::JointKind;

use super::chart::{Chart, Series};
use crate::error::Result;

/// Grey.
const HULL: [u8; 3] = [150, 156, 164];
/// Blue.
const SET: [u8; 3] = [18, 70, 200];
/// Orange.
const RECORDED: [u8; 3] = [222, 110, 0];

/// Draws the phase plane of each joint at the sample where a recording comes closest to the
/// boundary of the set, or leaves it furthest: the hull, the set in it, and the recordings.
pub(super) fn phase_planes(problem: &Problem, model: &Model) -> Result<Vec<Chart>> {
    let planes = PhasePlane::of_joints(problem, &model.sets())?;
    Ok(planes.iter().map(|plane| chart(plane, model)).collect())
}

fn chart(plane: &PhasePlane, model: &Model) -> Chart {
    let joint = &model.drive.robot.joints[plane.joint];
    let kind: JointKind = joint.kind;
    let [[q_low, q_high], [v_low, v_high]] = plane.hull;
    let line = |points: Vec<(f64, f64)>, colour| Series { points, dots: false, colour };
    let mut series: Vec<Series> = [
        vec![(q_low, v_low), (q_high, v_low)],
        vec![(q_low, v_high), (q_high, v_high)],
        vec![(q_low, v_low), (q_low, v_high)],
        vec![(q_high, v_low), (q_high, v_high)],
    ]
    .map(|points| line(points, HULL))
    .into();
    series.extend(halves(&plane.polygon).map(|points| line(points, SET)));
    let points = plane.points.iter().map(|[q, qd]| (*q, *qd)).collect();
    series.push(Series { points, dots: true, colour: RECORDED });
    Chart {
        title: format!("{}, {:.3} s", joint.name, plane.time),
        x: format!("position [{}]", kind.position_unit()),
        y: format!("velocity [{}]", kind.velocity_unit()),
        area: Vec::new(),
        series,
    }
}

/// The lower and the upper half of a convex polygon, each from left to right.
fn halves(polygon: &[[f64; 2]]) -> [Vec<(f64, f64)>; 2] {
    let count = polygon.len();
    let extreme = |further: fn(f64, f64) -> bool| {
        let at =
            |best: usize, i: usize| if further(polygon[i][0], polygon[best][0]) { i } else { best };
        (0..count).fold(0, at)
    };
    let (left, right) = (extreme(|a, b| a < b), extreme(|a, b| a > b));
    let walk = |from: usize, to: usize| -> Vec<(f64, f64)> {
        let steps = (to + count - from) % count.max(1);
        (0..=steps).map(|step| polygon[(from + step) % count].into()).collect()
    };
    if count == 0 {
        return [Vec::new(), Vec::new()];
    }
    let (lower, mut upper) = (walk(left, right), walk(right, left));
    upper.reverse();
    [lower, upper]
}

#[cfg(test)]
mod tests {
    use super::halves;

    #[test]
    fn a_polygon_is_two_lines_from_left_to_right() {
        let [lower, upper] = halves(&[[1.0, -1.0], [3.0, 0.0], [2.0, 2.0], [0.0, 1.0]]);
        assert_eq!(lower, [(0.0, 1.0), (1.0, -1.0), (3.0, 0.0)]);
        assert_eq!(upper, [(0.0, 1.0), (2.0, 2.0), (3.0, 0.0)]);
        assert_eq!(halves(&[]), [Vec::new(), Vec::new()]);
    }
}
