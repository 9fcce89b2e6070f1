//! The sets hold the samples by arithmetic of the tests' own, and a changed model is noticed.

use std::path::Path;

use reachtube_files::{Error, SealedFile};
use reachtube_tracking::{TrackedRun, TrackingModel};

use crate::common::{made, near, servo, set};

/// Returns the largest part of its set that a sample of each joint needs.
fn needed(model: &TrackingModel, recordings: &[TrackedRun]) -> Vec<f64> {
    let of_joint = |joint: usize| {
        let mut most = 0.0f64;
        for of in recordings {
            for k in 0..of.times.len() {
                let [nominal, half_width] = set(&model.joints[joint], of, k, joint);
                let actual = of.actual[k * of.joints.len() + joint];
                most = most.max((actual - nominal).abs() / half_width);
            }
        }
        most
    };
    (0..model.joints.len()).map(of_joint).collect()
}

#[test]
fn every_sample_is_inside_by_plain_arithmetic() {
    let recordings = servo(6);
    let model = made(&recordings).model;
    let own = needed(&model, &recordings);
    let check = model.check(&recordings).unwrap();
    assert!(check.conformant && check.outside == 0 && check.positions == 6 * 600 * 2);
    for (own, joint) in own.into_iter().zip(&check.joints) {
        assert!(own <= 1.0 + 1e-9, "{own}");
        near(joint.needed, own, 1e-9);
        // The sets are the smallest ones times the factor, so that a sample needs all of these.
        near(own, 1.0 / model.factor, 1e-5);
        assert_eq!((joint.outside, joint.too_fast), (0, None));
    }
}

#[test]
fn the_number_of_each_joint_and_motion_is_its_own() {
    let recordings = servo(6);
    let model = made(&recordings).model;
    let check = model.check(&recordings).unwrap();
    assert_eq!(check.motions.len(), 6);
    for (motion, of) in check.motions.iter().zip(&recordings) {
        let own = needed(&model, std::slice::from_ref(of));
        near(motion.needed, own[0].max(own[1]), 1e-9);
        assert_eq!(motion.name, of.name());
        // Where both joints touch their sets, either may be named.
        let joint = model.joints.iter().position(|joint| joint.name == motion.joint).unwrap();
        near(own[joint], motion.needed, 1e-9);
        // The sample at that time is the one that needs the most.
        let k = of.times.iter().position(|time| *time == motion.time).unwrap();
        let [nominal, half_width] = set(&model.joints[joint], of, k, joint);
        near((of.actual[2 * k + joint] - nominal).abs() / half_width, motion.needed, 1e-9);
    }
}

/// Returns a model as its text gives it, with the sets of one joint times `factor`.
fn scaled(model: &TrackingModel, joint: usize, factor: f64) -> TrackingModel {
    let mut parsed = TrackingModel::parse(&model.to_json(), Path::new("model.json")).unwrap();
    assert_eq!(&parsed, model);
    parsed.joints[joint].radius *= factor;
    parsed.joints[joint].radius_per_speed *= factor;
    parsed
}

#[test]
fn smaller_sets_do_not_hold_the_samples() {
    let recordings = servo(6);
    let model = made(&recordings).model;
    for joint in 0..2 {
        let other = 1 - joint;
        for (part, is_inside) in [(1.0 + 1e-5, true), (1.0 - 1e-5, false), (0.5, false)] {
            let check = scaled(&model, joint, part / model.factor).check(&recordings).unwrap();
            assert_eq!(check.conformant, is_inside, "{part}: {check:?}");
            assert_eq!(check.outside, check.joints[joint].outside);
            assert_eq!(check.joints[joint].outside == 0, is_inside);
            assert_eq!(check.joints[other].outside, 0);
            let outside = check.motions.iter().filter(|motion| motion.needed > 1.0);
            let outside: Vec<&String> = outside.map(|motion| &motion.joint).collect();
            assert!(outside.iter().all(|name| **name == model.joints[joint].name));
            assert_eq!(outside.is_empty(), is_inside);
        }
    }
}

#[test]
fn a_text_with_another_number_is_refused() {
    let text = made(&servo(3)).model.to_json();
    let origin = Path::new("arm/model.json");
    let edited = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut value = serde_json::from_str(&text).unwrap();
        change(&mut value);
        TrackingModel::parse(&value.to_string(), origin)
    };
    assert!(edited(&|_| ()).is_ok());
    let changes: [&dyn Fn(&mut serde_json::Value); 4] = [
        &|value| value["joints"][1]["radius"] = 0.1.into(),
        &|value| value["joints"][0]["largest_speed"] = 9.0.into(),
        &|value| value["factor"] = 1.0.into(),
        &|value| value["recordings"][2]["samples"] = 601.into(),
    ];
    for change in changes {
        let Err(error @ Error::Content { .. }) = edited(change) else {
            panic!("a changed model is accepted")
        };
        let said = error.to_string();
        assert!(said.starts_with("arm/model.json: ") && said.contains("was changed"), "{said}");
    }
}

#[test]
fn a_check_of_other_joints_is_refused() {
    let model = made(&servo(3)).model;
    let mut other = servo(1);
    other[0].joints[1] = "wrist".into();
    let said = model.check(&other).unwrap_err().to_string();
    assert!(said.contains("logs/motion_1.csv") && said.contains("wrist"), "{said}");
}
