//! A fault of the columns is named by a warning of its own, before any warning about gains.

use crate::lab::{Lab, geometry, lwa4p, simple_friction};
use crate::virtual_robot::edit;
use reachtube_identify::Identification;

const JOINTS: usize = 6;

/// Index of a joint's torque in a row of a recording, counted from 1.
fn tau(joint: usize) -> usize {
    2 * JOINTS + joint
}

/// Returns the warnings for exciting motions whose rows `change` falsifies.
///
/// The torque has a noise of 0.03 N m.
fn warnings(change: impl Fn(&mut Vec<Vec<f64>>)) -> Vec<String> {
    identified(0.03, 1..=3, change).warnings
}

/// Identifies the arm from exciting motions with noise \[N m\], of which `change` falsifies some.
fn identified(
    noise: f64,
    false_ones: std::ops::RangeInclusive<usize>,
    change: impl Fn(&mut Vec<Vec<f64>>),
) -> Identification {
    let truth = simple_friction(&lwa4p());
    let lab = Lab::new();
    lab.excite(&truth, noise, &[1.0; JOINTS]);
    for seed in false_ones {
        edit(&lab.path().join(format!("dynamic_{seed}.csv")), &change);
    }
    let mut settings = lab.settings();
    settings.model.physical = Some(false);
    settings.model.windows = vec![];
    lab.identify(&geometry(&truth), &settings)
}

/// Asserts that the first warning has all `parts`, and that no warning is about a gain.
fn assert_named(warnings: &[String], parts: &[&str]) {
    let first = warnings.first().expect("a warning");
    assert!(parts.iter().all(|part| first.contains(part)), "{parts:?}: {warnings:?}");
    assert!(
        !warnings.iter().any(|warning| warning.contains("contradicts the torque")),
        "{warnings:?}"
    );
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
    let found = identified(0.03, 1..=3, |rows| rows.iter_mut().for_each(|row| row[3] += 0.1));
    let parts = ["position of joint3", "offset of 0.", "correct the zero of q3"];
    assert_named(&found.warnings, &parts);
    let offset = found.offsets[2].offset.unwrap();
    assert!((offset - 0.1).abs() < 0.005, "{:?}", found.offsets);
}

/// The residuals hardly change by such an offset, so that only its own estimate shows it.
#[test]
fn an_offset_under_noise_is_named_with_its_standard_error() {
    let found = identified(0.3, 1..=3, |rows| rows.iter_mut().for_each(|row| row[3] += 0.1));
    assert_named(&found.warnings, &["position of joint3", "offset of 0.", "± 0.0", "zero of q3"]);
    let joint3 = &found.offsets[2];
    let off = joint3.offset.unwrap() - 0.1;
    assert!(off.abs() < 3.0 * joint3.standard_error.unwrap(), "{:?}", found.offsets);
    // No recording shows the zero of a vertical axis, nor the zero of a joint whose link has free
    // parameters.
    assert!(found.offsets[0].offset.is_none() && found.offsets[5].offset.is_none());
}

#[test]
fn an_offset_of_one_recording_is_named_with_the_recording() {
    let found = identified(0.1, 2..=2, |rows| rows.iter_mut().for_each(|row| row[3] += 0.1));
    let parts = ["position of joint3", "offset of 0.", "dynamic_2", "leave the recording out"];
    assert_named(&found.warnings, &parts);
}

#[test]
fn healthy_recordings_have_offsets_within_their_errors() {
    let found = identified(0.3, 1..=3, |_| ());
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    let mut known = 0;
    for joint in &found.offsets {
        let Some(offset) = joint.offset else { continue };
        known += 1;
        assert!(offset.abs() < 4.0 * joint.standard_error.unwrap(), "{:?}", found.offsets);
        assert!(joint.limit.unwrap() > offset.abs());
    }
    assert!(known >= 2, "{:?}", found.offsets);
    // The data show where an offset of 0.1 rad would be found.
    let limits: Vec<Option<f64>> = found.offsets.iter().map(|joint| joint.limit).collect();
    assert!(limits[2].unwrap() < 0.1 && limits[4].unwrap() > 0.1, "{limits:?}");
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
