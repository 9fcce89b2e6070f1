//! Postures in which an arm is stretched, as seen from the axis of one joint.

use reachtube_robot::{JointKind, Robot};

/// Number of positions of a joint that are tried at first.
const GRID: usize = 48;

/// Number of times that each joint is moved in turn.
const ROUNDS: usize = 6;

/// Returns a posture (rad; m) in which the point `tip` of the last link (its frame, m) is `part`
/// of its greatest distance away from the axis of a joint, and gravity turns the joint the most;
/// and that distance in m. The joints before it are at 0, or at their limit next to it. A joint
/// that slides has no axis: all others are then at 0.
///
/// The search tries positions of one joint after the other, and finds no proved maximum.
pub(super) fn stretched(robot: &Robot, joint: usize, part: f64, tip: [f64; 3]) -> (Vec<f64>, f64) {
    let limits = |k: usize| {
        let [low, high] = robot.joints()[k].position_limits;
        let turn = std::f64::consts::PI;
        if robot.joints()[k].kind == JointKind::Prismatic {
            [low, high]
        } else {
            [low.max(-turn), high.min(turn)]
        }
    };
    let n = robot.joint_count();
    let start = |k: usize| 0.0f64.clamp(limits(k)[0], limits(k)[1]);
    let mut q: Vec<f64> = (0..n).map(start).collect();
    if robot.joints()[joint].kind == JointKind::Prismatic {
        return (q, 0.0);
    }
    let distance = |q: &[f64]| from_axis(robot, joint, q, tip);
    for _ in 0..ROUNDS {
        (joint + 1..n).for_each(|k| best(&mut q, k, limits(k), distance));
    }
    let furthest = distance(&q);
    if part < 1.0 {
        let near = |q: &[f64]| -(distance(q) - part * furthest).abs();
        for _ in 0..ROUNDS {
            (joint + 1..n).for_each(|k| best(&mut q, k, limits(k), near));
        }
    }
    let load = |q: &[f64]| robot.gravity_torque(q)[joint].abs();
    best(&mut q, joint, limits(joint), load);
    let reached = distance(&q);
    (q, reached)
}

/// Returns the distance of a point of the last link from the axis of a joint that turns: half the
/// way of the point when the joint makes half a turn.
fn from_axis(robot: &Robot, joint: usize, q: &[f64], tip: [f64; 3]) -> f64 {
    let place = |turn: f64| {
        let mut q = q.to_vec();
        q[joint] += turn;
        let frame = &robot.link_placements(&q)[q.len() - 1];
        frame.rotation * nalgebra::Vector3::from(tip) + frame.translation
    };
    0.5 * (place(std::f64::consts::PI) - place(0.0)).norm()
}

/// Moves joint `k` to where `value` is the greatest, if that is more than where it is.
fn best(q: &mut [f64], k: usize, [low, high]: [f64; 2], value: impl Fn(&[f64]) -> f64) {
    let start = q[k];
    let mut found = (value(q), start);
    let mut cell = (high - low) / GRID as f64;
    let mut grid: Vec<f64> = (0..=GRID).map(|at| low + cell * at as f64).collect();
    while cell > 1e-6 {
        for x in grid {
            q[k] = x;
            let here = value(q);
            if here > found.0 + 1e-12 {
                found = (here, x);
            }
        }
        let around = [-1.0, -0.5, 0.5, 1.0].map(|part| found.1 + part * cell);
        grid = around.into_iter().filter(|x| (low..=high).contains(x)).collect();
        cell *= 0.5;
    }
    q[k] = found.1;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arm_is_stretched_and_bent() {
        let robot = Robot::lwa4p();
        let (q, far) = stretched(&robot, 0, 1.0, [0.0; 3]);
        let (bent, near) = stretched(&robot, 0, 0.33, [0.0; 3]);
        // Upper arm, lower arm and hand lie on a line.
        assert!((far - (0.35 + 0.3012 + 0.1548)).abs() < 1e-6, "{far} {q:?}");
        assert!((near - 0.33 * far).abs() < 1e-3, "{near} {far} {bent:?}");
        // The second joint bears the most with the arm level.
        let (q, _) = stretched(&robot, 1, 1.0, [0.0; 3]);
        let load = robot.gravity_torque(&q)[1].abs();
        for k in 0..60 {
            let mut other = q.clone();
            other[1] = 0.1 * f64::from(k) - 3.0;
            assert!(robot.gravity_torque(&other)[1].abs() <= load + 1e-6);
        }
    }
}
