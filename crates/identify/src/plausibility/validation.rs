//! Warnings about the validation.

use crate::validate::simulation::WindowErrors;
use crate::validate::torque::{JointError, LogValidation};
use reachtube_robot::Robot;

/// Share of the torque that may stay unexplained without a warning.
const MAX_UNEXPLAINED: f64 = 0.3;

/// Ratio of the errors with and without physical links beyond which a joint is named. Below, chance
/// decides in a single recording.
const COSTLY: f64 = 1.1;

/// Share of the torque below which an error is not worth a warning.
const SMALL_ERROR: f64 = 1e-3;

/// Error of a simulated position that is not worth a warning \[rad\].
const NEGLIGIBLE: f64 = 0.05;

/// Returns a warning for each joint of which more than 30 % of the torque in the validation
/// recordings is not predicted.
pub(crate) fn poor_prediction(robot: &Robot, validation: &[LogValidation]) -> Vec<String> {
    let joints = validation.last().map_or(&[][..], |all| &all.joints);
    let warning = |(joint, error): (_, &JointError)| {
        error.relative.filter(|relative| *relative > MAX_UNEXPLAINED).map(|relative| {
            format!(
                "{joint}: {:.0} % of the torque in the validation recordings is not explained; \
                 friction that the model does not describe, or a motion far from the fitted ones, \
                 has this effect",
                100.0 * relative
            )
        })
    };
    robot.joints().iter().map(|joint| &joint.name).zip(joints).filter_map(warning).collect()
}

/// Returns a warning that names the joints whose torque in the validation recordings least squares
/// predicts better than physical links do.
pub(crate) fn costly_links(robot: &Robot, validation: &[LogValidation]) -> Option<String> {
    let joints = validation.last().map_or(&[][..], |all| &all.joints);
    let costly = |(joint, error): (&String, &JointError)| {
        let (physical, plain) = (error.relative?, error.relative_plain?);
        (physical > (COSTLY * plain).max(SMALL_ERROR))
            .then(|| format!("{joint} ({:.2} instead of {:.2} %)", 100.0 * physical, 100.0 * plain))
    };
    let names = robot.joints().iter().map(|joint| &joint.name);
    let costly: Vec<String> = names.zip(joints).filter_map(costly).collect();
    (!costly.is_empty()).then(|| {
        format!(
            "physical links predict the torque in the validation recordings worse than plain least \
             squares does: {}; if the robot only needs to predict torque, set model.physical = \
             false, or parameters = \"base\" in the description",
            costly.join(", ")
        )
    })
}

/// Returns a warning that names the validation recordings in which no joint moves.
pub(crate) fn still_recordings(validation: &[LogValidation]) -> Option<String> {
    let still = |log: &&LogValidation| log.joints.iter().all(|joint| joint.samples == 0);
    let names: Vec<&str> = validation
        .iter()
        .filter(still)
        .map(|log| log.log.as_str())
        .filter(|log| *log != "all")
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "no joint moves in the validation recordings {}: friction at rest has no unique value, \
             so that these recordings validate nothing; name motions with --validate, and poses \
             with --rest",
            names.join(", ")
        )
    })
}

/// Returns a warning for the shortest windows whose simulated motion ends further from the recorded
/// one than the joint moved.
pub(crate) fn useless_simulation(robot: &Robot, windows: &[WindowErrors]) -> Option<String> {
    let mut windows: Vec<&WindowErrors> = windows.iter().filter(|w| w.windows > 0).collect();
    windows.sort_by(|a, b| a.duration.total_cmp(&b.duration));
    windows.into_iter().find_map(|window| {
        let joints: Vec<String> = robot
            .joints()
            .iter()
            .enumerate()
            .filter(|(j, _)| window.q[*j] > window.motion[*j].max(NEGLIGIBLE))
            .map(|(j, joint)| {
                let (error, motion) = (window.q[j], window.motion[j]);
                let (name, unit) = (&joint.name, joint.kind.position_unit());
                format!("{name} by {error:.3} {unit}, of a motion of {motion:.3} {unit}")
            })
            .collect();
        let diverged = window.diverged == window.windows;
        (diverged || !joints.is_empty()).then(|| {
            let what = if diverged {
                "diverges in every window".into()
            } else {
                format!(
                    "misses the recorded position by more than a joint moves ({})",
                    joints.join(", ")
                )
            };
            format!(
                "motion simulated from the recorded torque over {} s {what}; errors of the torque \
                 accumulate to this, so do not use the robot to predict motion over this time",
                window.duration
            )
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(physical: f64, plain: f64) -> JointError {
        JointError {
            torque: 1.0,
            residual: physical,
            relative: Some(physical),
            relative_plain: Some(plain),
            relative_all: None,
            r2: None,
            samples: 10,
        }
    }

    #[test]
    fn joints_for_which_physical_links_cost_much_are_named() {
        let robot = Robot::lwa4p();
        let mut joints = vec![error(0.04, 0.04); 6];
        joints[1] = error(0.105, 0.094);
        joints[2] = error(0.0009, 0.0001);
        let validation = [LogValidation { log: "a".into(), joints: joints.clone() }];
        let warning = costly_links(&robot, &validation).unwrap();
        assert!(warning.contains("joint2 (10.50 instead of 9.40 %); if"), "{warning}");
        joints[1] = error(0.098, 0.094);
        assert_eq!(costly_links(&robot, &[LogValidation { log: "a".into(), joints }]), None);
    }
}
