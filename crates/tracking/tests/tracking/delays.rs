//! Commands that arrive late as a whole.

use reachtube_tracking::{Plan, TrackedRun};

use crate::common::{made, near, servo};
use crate::servo::{Plan as Waves, Random};

/// The time by which both joints are late, s.
const LATE: f64 = 0.15;

/// A recording at 30 Hz of joints that do what they were commanded 0.15 s before.
pub(crate) fn late(number: u64) -> TrackedRun {
    let (waves, mut random) = (Waves::new(number), Random(number));
    let times: Vec<f64> = (0..180).map(|k| f64::from(k) / 30.0).collect();
    let command = times.iter().flat_map(|t| [0, 1].map(|joint| waves.position(joint, *t)));
    let command: Vec<f64> = command.collect();
    let actual = times.iter().flat_map(|t| [0, 1].map(|joint| waves.position(joint, t - LATE)));
    let actual = actual.map(|q| q + random.within(-1e-3, 1e-3)).collect();
    TrackedRun {
        file: format!("late_{number}.csv").into(),
        joints: vec!["shoulder".into(), "elbow".into()],
        units: vec!["rad"; 2],
        times,
        command,
        actual,
        sha256: number.to_string(),
    }
}

#[test]
fn a_delay_is_found_and_makes_the_sets_smaller() {
    let recordings: Vec<TrackedRun> = (1..=8).map(late).collect();
    let made = made(&recordings);
    let model = &made.model;
    assert!(model.verified && made.is_useful(), "{:?}", made.findings);
    for joint in &model.joints {
        near(model.delay - joint.speed, LATE, 0.03);
    }
    near(model.delay, LATE, 0.1);
    // The waves are straight between samples up to 4 mrad, and the noise is 1 mrad.
    assert!(model.mean_half_width() < 8e-3, "{}", model.mean_half_width());
    assert!(model.check(&recordings).unwrap().conformant);
    let late_by = model.deviations(1.0).late_by;
    near(late_by, LATE, 0.05);
    let others: Vec<TrackedRun> = (20..30).map(late).collect();
    let check = model.check(&others).unwrap();
    let inside = check.motions.iter().filter(|motion| motion.needed <= 1.0).count();
    assert!(inside >= 8, "{inside} of {}", check.motions.len());
    let TrackedRun { file, joints, units, times, command, actual, .. } = late(1);
    let tube = model.tube(&Plan { file, joints, units, times, command }).unwrap();
    let bounds = tube.lower.iter().zip(&tube.upper);
    assert!(bounds.zip(&actual).all(|((low, high), q)| (low..=high).contains(&q)));
}

#[test]
fn a_lag_that_explains_as_much_needs_no_delay() {
    assert_eq!(made(&servo(6)).model.delay, 0.0);
}
