//! Recordings in a wrong unit are named with the unit and the remedy.

use crate::lab::{Lab, geometry, lwa4p, simple_friction};
use crate::virtual_robot::{Random, Recorder, edit, excitation};
use reachtube_identify::prepare::LogEntry;
use reachtube_identify::{IdentifySettings, identify};
use reachtube_robot::Robot;
use std::f64::consts::PI;
use std::path::PathBuf;

const JOINTS: usize = 6;

/// Returns the arm of the recordings without limits, by which degrees would be refused.
fn arm() -> Robot {
    let mut description = simple_friction(&lwa4p()).description().clone();
    description.joints.iter_mut().for_each(|joint| joint.velocity_limit = None);
    Robot::from_description(&description).unwrap()
}

/// Returns the arm with all masses multiplied by `factor`.
fn scaled(robot: &Robot, factor: f64) -> Robot {
    let mut description = robot.description().clone();
    for joint in &mut description.joints {
        joint.mass *= factor;
        joint.inertia.iter_mut().for_each(|value| *value *= factor);
        joint.first_moment.iter_mut().flatten().for_each(|value| *value *= factor);
        joint.armature = joint.armature.map(|value| value * factor);
    }
    Robot::from_description(&description).unwrap()
}

/// Records an exciting motion of the arm, changed by `change`, and returns settings that identify
/// it from that recording.
fn recorded(physical: bool, change: impl Fn(&mut [f64])) -> (Lab, IdentifySettings) {
    let (lab, arm) = (Lab::new(), arm());
    let random = Random::new(5);
    let mut recorder = Recorder { robot: &arm, noise: 0.03, gains: vec![1.0; JOINTS], random };
    let path = lab.path().join("dynamic.csv");
    recorder.record(&path, 10.0, excitation(JOINTS, 1));
    edit(&path, |rows: &mut Vec<Vec<f64>>| rows.iter_mut().for_each(|row| change(row)));
    let mut settings = lab.settings();
    settings.excitation = vec![PathBuf::from("dynamic.csv").into()];
    settings.validate = vec![];
    settings.model.physical = Some(physical);
    settings.model.windows = vec![];
    (lab, settings)
}

/// Returns the warnings of an identification of the arm with the links of `described`, where the
/// recorded positions and velocities were multiplied by `motion`, and the torques by `torque`. The
/// links come from least squares, or are physical.
fn warnings(described: &Robot, physical: bool, [motion, torque]: [f64; 2]) -> Vec<String> {
    let (lab, settings) = recorded(physical, |row| {
        row[1..=2 * JOINTS].iter_mut().for_each(|value| *value *= motion);
        row[2 * JOINTS + 1..].iter_mut().for_each(|value| *value *= torque);
    });
    lab.identify(described, &settings).warnings
}

/// Asserts that the first warning has all `parts`.
fn assert_named(warnings: &[String], parts: &[&str]) {
    let first = warnings.first().expect("a warning");
    assert!(parts.iter().all(|part| first.contains(part)), "{parts:?}: {warnings:?}");
}

#[test]
fn torques_in_another_unit_are_named_by_the_masses_of_the_description() {
    let described = scaled(&arm(), 1.5);
    assert!(warnings(&described, false, [1.0, 1.0]).is_empty());
    let words = ["identified gravity torque of joint2", "where the description has"];
    let parts = [&words[..], &["in N mm", "by 0.001, for example with --gains"]].concat();
    assert_named(&warnings(&described, true, [1.0, 1e3]), &parts);
    let parts = [&words[..], &["in kN m", "by 1000, for example with --gains"]].concat();
    assert_named(&warnings(&described, false, [1.0, 1e-3]), &parts);
}

#[test]
fn torques_in_another_unit_are_named_by_the_size_of_the_arm() {
    let described = geometry(&arm());
    assert!(warnings(&described, false, [1.0, 1.0]).is_empty());
    let parts = ["gravity torque of joint2", "at the end of this arm of 0.97 m", "in N mm"];
    assert_named(&warnings(&described, true, [1.0, 1e3]), &parts);
    assert_named(&warnings(&described, false, [1.0, 1e-3]), &["arm of 0.97 m", "in kN m"]);
}

#[test]
fn masses_of_the_description_that_no_such_arm_has_are_named() {
    let found = warnings(&scaled(&arm(), 1e-3), false, [1.0, 1.0]);
    assert_named(&found, &["where the description has", "check the masses of the description"]);
}

#[test]
fn degrees_are_named() {
    for described in [arm(), geometry(&arm())] {
        let found = warnings(&described, true, [180.0 / PI, 1.0]);
        assert_named(&found, &["q and qd are probably in degrees", "convert the columns q and qd"]);
        assert!(!found.iter().any(|warning| warning.contains("torques are probably")), "{found:?}");
    }
}

/// The gravity torque of the description is added to such inputs, and in no unit is the sum a
/// torque: gains and signs that the joints would agree by are not named.
#[test]
fn compensated_inputs_in_another_unit_are_named_alone() {
    let units = [
        (1.0, None),
        (1e3, Some(["the torques are probably in N mm", "multiply the torques by 0.001"])),
        (1e-3, Some(["the torques are probably in kN m", "multiply the torques by 1000"])),
    ];
    for (factor, words) in units {
        let arm = arm();
        let (lab, mut settings) = recorded(true, |row| {
            let (motion, torque) = row[1..].split_at_mut(2 * JOINTS);
            let (q, qd) = motion.split_at(JOINTS);
            let input = arm.input_from_motor_torque(q, qd, torque);
            torque.iter_mut().zip(&input).for_each(|(tau, u)| *tau = factor * u);
        });
        let path = PathBuf::from("dynamic.csv");
        let (from, until, order, compensated) = (0.0, None, None, true);
        settings.excitation = vec![LogEntry::Stretch { path, from, until, order, compensated }];
        // No physical links come near inputs in kN m.
        let found = match identify(&arm, &settings, lab.path(), &|_, _| {}) {
            Ok(found) => found.warnings,
            Err(error) => vec![error.to_string()],
        };
        let lies = ["check its gain", "the sign of", "offset"];
        assert!(!found.iter().any(|w| lies.iter().any(|lie| w.contains(lie))), "{found:?}");
        match words {
            Some(words) => assert_named(&found, &words),
            None => assert!(found.is_empty(), "{found:?}"),
        }
    }
}
