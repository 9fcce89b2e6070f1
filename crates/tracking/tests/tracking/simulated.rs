//! Positions in the sets of a new command, drawn at random, are inside, and beyond them outside.

use reachtube_tracking::{TrackedRun, TrackingModel};

use crate::common::{made, rates, recording, servo, set};
use crate::servo::{Plan, Random, log};

/// Samples of each of the two joints.
const SAMPLES: usize = 5000;

/// Returns a command of a new plan at another rate, as fast as the recorded ones at most.
fn command(model: &TrackingModel) -> TrackedRun {
    let mut of = recording("simulated", &log(1));
    of.times = (0..SAMPLES).map(|k| 6.0 / SAMPLES as f64 * k as f64).collect();
    let plan = Plan::new(77);
    let position = |time: &f64| [0, 1].map(|joint| plan.position(joint, *time));
    of.command = of.times.iter().flat_map(position).collect();
    for (joint, known) in model.joints.iter().enumerate() {
        let speed = |k: usize| rates(&of, k, joint)[0].abs();
        let fastest = (0..SAMPLES).map(speed).fold(0.0, f64::max);
        let slower = 0.999 * known.largest_speed / fastest;
        of.command.iter_mut().skip(joint).step_by(2).for_each(|position| *position *= slower);
    }
    of
}

/// Returns the command with positions at this part of the half-widths, above or below at random.
fn simulated(model: &TrackingModel, command: &TrackedRun, part: f64) -> TrackedRun {
    let mut random = Random(5);
    let mut position = |k: usize, joint: usize| {
        let [nominal, half_width] = set(&model.joints[joint], command, k, joint);
        nominal + part * half_width * random.within(-1.0, 1.0).signum()
    };
    let actual = (0..SAMPLES).flat_map(|k| [position(k, 0), position(k, 1)]).collect();
    TrackedRun { actual, ..command.clone() }
}

#[test]
fn samples_in_the_sets_are_inside_and_others_are_not() {
    let model = made(&servo(6)).model;
    let command = command(&model);
    let check = |part: f64| model.check(&[simulated(&model, &command, part)]).unwrap();
    for (part, outside) in [(0.5, 0), (0.999999, 0), (1.000001, 2 * SAMPLES)] {
        let check = check(part);
        assert_eq!((check.positions, check.outside), (2 * SAMPLES, outside), "{part}");
        assert_eq!(check.conformant, outside == 0);
        assert!(check.joints.iter().all(|joint| joint.too_fast.is_none()), "{check:?}");
        assert!(check.joints.iter().all(|joint| (joint.needed - part).abs() < 1e-8), "{check:?}");
    }
}

#[test]
fn faster_commands_are_named() {
    let model = made(&servo(6)).model;
    let mut command = command(&model);
    command.command.iter_mut().step_by(2).for_each(|position| *position *= 1.01);
    let check = model.check(&[simulated(&model, &command, 0.5)]).unwrap();
    let known = model.joints[0].largest_speed;
    let fast = check.joints[0].too_fast.unwrap();
    assert!((fast / known - 0.999 * 1.01).abs() < 1e-9, "{fast} {known}");
    assert_eq!(check.joints[1].too_fast, None);
    let said = check.summary(&model).to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("The command of shoulder reaches"), "{said}");
}
