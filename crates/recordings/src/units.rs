//! Whether a recording can be in rad, rad/s: what does not fit is a mistake of units far more often
//! than a fast robot.

use std::path::Path;

use reachtube_robot::Robot;

use crate::defect::Defect;
use crate::run::Run;

/// Motion of a joint below which q and q̇ are not compared, rad.
const LEAST_MOTION: f64 = 0.05;

/// A joint that is this many times faster, or further, than its limit is not in rad.
const BEYOND_LIMIT: f64 = 5.0;

/// For each joint that moves: the slope of q over ∫q̇ dt, where it is not near 1.
pub fn velocity_mismatch(run: &Run) -> Vec<(usize, f64)> {
    (0..run.joints)
        .filter_map(|joint| {
            let slope = position_per_integral(run, joint)?;
            (!(0.5..=2.0).contains(&slope)).then_some((joint, slope))
        })
        .collect()
}

/// The largest difference of q and ∫q̇ dt (trapezoidal) over a run, rad.
pub fn integral_gap(run: &Run, joint: usize) -> f64 {
    let (mut integral, mut largest) = (run.q(0)[joint], 0.0f64);
    for k in 1..run.len() {
        integral +=
            0.5 * (run.times[k] - run.times[k - 1]) * (run.qd(k)[joint] + run.qd(k - 1)[joint]);
        largest = largest.max((run.q(k)[joint] - integral).abs());
    }
    largest
}

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
    (largest > LEAST_MOTION && square > 0.0).then(|| cross / square)
}

/// Defects of a run whose units cannot be those of the robot.
pub fn check_limits(path: &Path, run: &Run, robot: &Robot) -> Vec<Defect> {
    let mut defects = Vec::new();
    for (joint, slope) in velocity_mismatch(run) {
        let degrees = std::f64::consts::PI.recip() * 180.0;
        let guess = if (slope / degrees - 1.0).abs() < 0.3 {
            "q looks like degrees and qd like rad/s"
        } else if (slope * degrees - 1.0).abs() < 0.3 {
            "q looks like rad and qd like degrees/s"
        } else {
            continue;
        };
        let problem = format!("q moves {slope:.3} times as far as qd integrates to: {guess}");
        defects.push(
            Defect::new(path, None, problem, "give q in rad and qd in rad/s")
                .of_joint(Some(joint + 1)),
        );
    }
    for (joint, description) in robot.description().joints.iter().enumerate() {
        let Some([low, high]) = description.position_limits else { continue };
        let furthest = (0..run.len()).map(|k| run.q(k)[joint].abs()).fold(0.0, f64::max);
        if furthest > BEYOND_LIMIT * low.abs().max(high.abs()) {
            let problem =
                format!("|q| reaches {furthest:.3}, the joint's limits are {low} and {high} rad");
            let remedy = "give q in rad, or correct the limits in the robot's description";
            defects.push(Defect::new(path, None, problem, remedy).of_joint(Some(joint + 1)));
        }
    }
    for joint in 0..run.joints {
        let fastest = (0..run.len()).map(|k| run.qd(k)[joint].abs()).fold(0.0, f64::max);
        let Some(limit) = robot.joints()[joint].velocity_limit else { continue };
        if fastest > BEYOND_LIMIT * limit {
            let problem = format!("qd reaches {fastest:.3}, the joint's limit is {limit} rad/s");
            defects.push(
                Defect::new(
                    path,
                    None,
                    problem,
                    "give qd in rad/s, or correct the limit in the robot's description",
                )
                .of_joint(Some(joint + 1)),
            );
        }
    }
    defects
}
