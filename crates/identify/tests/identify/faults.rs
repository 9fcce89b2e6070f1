//! A fault of the columns is named by a warning of its own, before any warning about gains.

use crate::lab::{Lab, geometry, lwa4p, simple_friction};
use crate::virtual_robot::edit;

const JOINTS: usize = 6;

/// Index of a joint's torque in a row of a recording, counted from 1.
fn tau(joint: usize) -> usize {
    2 * JOINTS + joint
}

/// Returns the warnings for exciting motions whose rows `change` falsifies.
///
/// The torque has a noise of 0.03 N m.
fn warnings(change: impl Fn(&mut Vec<Vec<f64>>)) -> Vec<String> {
    let truth = simple_friction(&lwa4p());
    let lab = Lab::new();
    lab.excite(&truth, 0.03, &[1.0; JOINTS]);
    for seed in 1..=3 {
        edit(&lab.path().join(format!("dynamic_{seed}.csv")), &change);
    }
    let mut settings = lab.settings();
    settings.model.physical = Some(false);
    settings.model.windows = vec![];
    lab.identify(&geometry(&truth), &settings).warnings
}

/// Asserts that the first warning has all `parts`, and that no warning is about a gain.
fn assert_named(warnings: &[String], parts: &[&str]) {
    let first = warnings.first().expect("a warning");
    assert!(parts.iter().all(|part| first.contains(part)), "{parts:?}: {warnings:?}");
    assert!(!warnings.iter().any(|warning| warning.contains("contradicts that")), "{warnings:?}");
}

#[test]
fn swapped_joints_are_named() {
    let torques = warnings(|rows| rows.iter_mut().for_each(|row| row.swap(tau(2), tau(3))));
    assert_named(&torques, &["columns tau of joint2 and joint3", "swapped"]);
    let all = warnings(|rows| {
        for row in rows {
            (0..3).for_each(|part| row.swap(part * JOINTS + 2, part * JOINTS + 4));
        }
    });
    assert_named(&all, &["columns q, qd and tau of joint2 and joint4", "swapped"]);
}

#[test]
fn an_offset_of_a_position_is_named_with_its_size() {
    let found = warnings(|rows| rows.iter_mut().for_each(|row| row[3] += 0.1));
    assert_named(&found, &["position of joint3", "offset of 0.1", "correct the zero of q3"]);
}

#[test]
fn a_lag_of_the_torque_is_named_with_its_size() {
    // 25 samples of 4 ms.
    let late = |joints: std::ops::RangeInclusive<usize>| {
        warnings(move |rows| {
            for k in (25..rows.len()).rev() {
                joints.clone().for_each(|joint| rows[k][tau(joint)] = rows[k - 25][tau(joint)]);
            }
            rows.drain(..25);
            let start = rows[0][0];
            rows.iter_mut().for_each(|row| row[0] -= start);
        })
    };
    for (joints, name) in [(1..=JOINTS, "all joints"), (2..=2, "joint2")] {
        let warnings = late(joints);
        assert_named(&warnings, &[&format!("the torque of {name} probably lags the motion by ")]);
        let words: Vec<&str> = warnings[0].split(' ').collect();
        let unit = words.iter().position(|word| *word == "ms:").unwrap();
        let delay: f64 = words[unit - 1].parse().unwrap();
        assert!((delay - 100.0).abs() < 6.0, "{warnings:?}");
    }
}
