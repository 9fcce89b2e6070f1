//! Signs that a recording is not in rad and rad/s: wrong units are far more likely than a robot
//! that is several times faster than its limits.

use std::f64::consts::PI;
use std::path::Path;

use reachtube_robot::{JointDescription, Robot};

use crate::defect::Defect;
use crate::run::Run;

/// Motion of a joint below which q and the integral of q̇ are not compared, rad.
const MIN_MOTION: f64 = 0.05;

/// A position or velocity beyond this multiple of the joint's limit is not in rad or rad/s.
const LIMIT_FACTOR: f64 = 5.0;

/// Ratios of motion to integrated velocity that are plausible.
const PLAUSIBLE_RATIO: std::ops::RangeInclusive<f64> = 0.5..=2.0;

/// Returns each joint (from 0) whose q does not follow ∫q̇ dt, with the slope of q over ∫q̇ dt
/// where this is implausible. Joints that hardly move are skipped.
#[must_use]
pub fn velocity_mismatch(run: &Run) -> Vec<(usize, f64)> {
    (0..run.joints)
        .filter_map(|joint| {
            let slope = position_per_integral(run, joint)?;
            (!PLAUSIBLE_RATIO.contains(&slope)).then_some((joint, slope))
        })
        .collect()
}

/// Returns the largest difference of q and ∫q̇ dt (trapezoidal rule) of `joint` (from 0) over a
/// run, rad.
#[must_use]
pub fn integral_gap(run: &Run, joint: usize) -> f64 {
    let (mut integral, mut largest) = (run.q(0)[joint], 0.0f64);
    for k in 1..run.len() {
        integral +=
            0.5 * (run.times[k] - run.times[k - 1]) * (run.qd(k)[joint] + run.qd(k - 1)[joint]);
        largest = largest.max((run.q(k)[joint] - integral).abs());
    }
    largest
}

/// Returns the least-squares slope of q over ∫q̇ dt, both from the first sample; `None` for a joint
/// that hardly moves.
fn position_per_integral(run: &Run, joint: usize) -> Option<f64> {
    let (mut integral, mut cross, mut square, mut largest) = (0.0f64, 0.0, 0.0, 0.0f64);
    for k in 1..run.len() {
        let dt = run.times[k] - run.times[k - 1];
        integral += 0.5 * dt * (run.qd(k)[joint] + run.qd(k - 1)[joint]);
        let moved = run.q(k)[joint] - run.q(0)[joint];
        cross += moved * integral;
        square += integral * integral;
        largest = largest.max(integral.abs()).max(moved.abs());
    }
    (largest > MIN_MOTION && square > 0.0).then(|| cross / square)
}

/// Returns the defects of a run whose values cannot be in rad and rad/s for this robot: q against
/// ∫q̇ dt, then positions and velocities far beyond the joints' limits. `path` names the run.
///
/// # Panics
///
/// Panics where the robot and the run differ in their number of joints.
#[must_use]
pub fn check_limits(path: &Path, run: &Run, robot: &Robot) -> Vec<Defect> {
    let mut defects = degree_defects(path, run);
    defects.extend(position_defects(path, run, robot));
    defects.extend(velocity_defects(path, run, robot));
    defects
}

/// Returns a defect for each joint of which q or q̇, but not both, looks like degrees.
fn degree_defects(path: &Path, run: &Run) -> Vec<Defect> {
    let degrees = PI.recip() * 180.0;
    let defect = |(joint, slope): (usize, f64)| {
        let guess = if (slope / degrees - 1.0).abs() < 0.3 {
            "q looks like degrees and qd like rad/s"
        } else if (slope * degrees - 1.0).abs() < 0.3 {
            "q looks like rad and qd like degrees/s"
        } else {
            return None;
        };
        let problem = format!("q moves {slope:.3} times as far as the integral of qd: {guess}");
        Some(joint_defect(path, joint, problem, "give q in rad and qd in rad/s"))
    };
    velocity_mismatch(run).into_iter().filter_map(defect).collect()
}

/// Returns a defect for each joint whose position is far beyond its limits.
fn position_defects(path: &Path, run: &Run, robot: &Robot) -> Vec<Defect> {
    let joints = robot.description().joints.iter().enumerate();
    let defect = |(joint, description): (usize, &JointDescription)| {
        let [low, high] = description.position_limits?;
        let furthest = (0..run.len()).map(|k| run.q(k)[joint].abs()).fold(0.0, f64::max);
        (furthest > LIMIT_FACTOR * low.abs().max(high.abs())).then(|| {
            let problem = format!(
                "|q| reaches {furthest:.3}, but the joint's limits are {low} and {high} rad"
            );
            let remedy = "give q in rad, or correct the limits in the robot's description";
            joint_defect(path, joint, problem, remedy)
        })
    };
    joints.filter_map(defect).collect()
}

/// Returns a defect for each joint whose velocity is far beyond its limit.
fn velocity_defects(path: &Path, run: &Run, robot: &Robot) -> Vec<Defect> {
    let defect = |joint: usize| {
        let limit = robot.joints()[joint].velocity_limit?;
        let fastest = (0..run.len()).map(|k| run.qd(k)[joint].abs()).fold(0.0, f64::max);
        (fastest > LIMIT_FACTOR * limit).then(|| {
            let problem =
                format!("qd reaches {fastest:.3}, but the joint's limit is {limit} rad/s");
            let remedy = "give qd in rad/s, or correct the limit in the robot's description";
            joint_defect(path, joint, problem, remedy)
        })
    };
    (0..run.joints).filter_map(defect).collect()
}

fn joint_defect(path: &Path, joint: usize, problem: String, remedy: &str) -> Defect {
    Defect::new(path, None, problem, remedy).of_joint(Some(joint + 1))
}
