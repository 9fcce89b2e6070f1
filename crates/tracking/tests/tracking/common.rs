//! Recordings of the servo, and the sets of a model in plain arithmetic.

use reachtube_tracking::{Code, JointTracking, MadeModel, TrackedRun, make};

use crate::servo::{Log, log};

/// A sample has a direction if it is faster than this part of the highest speed.
const SLOW: f64 = 0.02;

/// Returns a log as a recording of this name.
pub(crate) fn recording(name: &str, log: &Log) -> TrackedRun {
    TrackedRun {
        file: format!("logs/{name}.csv").into(),
        joints: vec!["shoulder".into(), "elbow".into()],
        units: vec!["rad"; 2],
        times: log.times.clone(),
        command: log.command.concat(),
        actual: log.actual.concat(),
        sha256: name.into(),
    }
}

/// Returns recordings of the servo with the plans 1 to `count`.
pub(crate) fn servo(count: u64) -> Vec<TrackedRun> {
    (1..=count).map(|number| recording(&format!("motion_{number}"), &log(number))).collect()
}

/// Returns recordings of the servo with the plans 1 to 5, and one more log.
pub(crate) fn with_log(name: &str, log: &Log) -> Vec<TrackedRun> {
    let mut all = servo(5);
    all.push(recording(name, log));
    all
}

pub(crate) fn made(recordings: &[TrackedRun]) -> MadeModel {
    make(recordings, None).unwrap()
}

/// Returns the texts of the findings of a code.
pub(crate) fn texts(made: &MadeModel, code: Code) -> Vec<&str> {
    let of_code = made.findings.iter().filter(|of| of.code.name() == code.name());
    of_code.map(|of| of.text.as_str()).collect()
}

/// Returns speed and acceleration of a joint's command at a sample by the weights of three samples,
/// without the code under test.
pub(crate) fn rates(of: &TrackedRun, k: usize, joint: usize) -> [f64; 2] {
    let (n, last) = (of.joints.len(), of.times.len() - 1);
    let r = |k: usize| of.command[k * n + joint];
    let middle = if k == 0 { 1 } else { k.min(last - 1) };
    let before = of.times[middle] - of.times[middle - 1];
    let after = of.times[middle + 1] - of.times[middle];
    let both = before + after;
    let acceleration = 2.0 * r(middle - 1) / (before * both) - 2.0 * r(middle) / (before * after)
        + 2.0 * r(middle + 1) / (after * both);
    let speed = if k == 0 {
        (r(1) - r(0)) / before
    } else if k == last {
        (r(last) - r(last - 1)) / after
    } else {
        -after / (before * both) * r(k - 1)
            + (after - before) / (before * after) * r(k)
            + before / (after * both) * r(k + 1)
    };
    [speed, acceleration]
}

/// Returns the nominal position of a joint at a sample, and the half-width of its set there.
pub(crate) fn set(known: &JointTracking, of: &TrackedRun, k: usize, joint: usize) -> [f64; 2] {
    let [speed, acceleration] = rates(of, k, joint);
    let direction = (speed / (SLOW * known.largest_speed)).clamp(-1.0, 1.0);
    let nominal = of.command[k * of.joints.len() + joint]
        + known.offset
        + known.speed * speed
        + known.acceleration * acceleration
        + if known.direction == 0.0 { 0.0 } else { known.direction * direction };
    [nominal, known.radius + known.radius_per_speed * speed.abs()]
}

/// Asserts that two numbers differ by no more than this part of the second one.
#[track_caller]
pub(crate) fn near(found: f64, expected: f64, part: f64) {
    let apart = (found - expected).abs();
    assert!(apart <= part * expected.abs(), "{found:e} is not {expected:e}");
}
