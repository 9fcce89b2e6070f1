//! Smallest sets that are known without a program.

use reachtube_tracking::TrackedRun;

use crate::common::{made, near, rates};
use crate::servo::LAGS;

/// Samples of a recording.
const SAMPLES: usize = 400;

/// Returns a recording of a joint that stands at 0.5 rad and one that swings, with errors.
fn standing(number: usize, errors: impl Fn(usize) -> [f64; 2]) -> TrackedRun {
    let times: Vec<f64> = (0..SAMPLES).map(|k| 0.01 * k as f64).collect();
    let swing = |time: &f64| 0.4 * ((2.0 + 0.1 * number as f64) * time + 0.3).sin();
    let command: Vec<f64> = times.iter().flat_map(|time| [0.5, swing(time)]).collect();
    let errors = (0..SAMPLES).flat_map(errors);
    let actual = command.iter().zip(errors).map(|(position, error)| position + error).collect();
    TrackedRun {
        file: format!("logs/standing_{number}.csv").into(),
        joints: vec!["still".into(), "swings".into()],
        units: vec!["rad"; 2],
        times,
        command,
        actual,
        sha256: number.to_string(),
    }
}

fn all(errors: impl Fn(usize) -> [f64; 2]) -> Vec<TrackedRun> {
    (0..4).map(|number| standing(number, &errors)).collect()
}

/// The half-width of two errors is half of their distance, and the offset their middle.
#[test]
fn two_errors_in_turn_give_their_middle() {
    // The still joint changes its error once in 50 samples, so that it has no noise.
    let still = |k: usize| if (k / 50).is_multiple_of(2) { 1e-3 } else { -0.5e-3 };
    let swings = |k: usize| if k.is_multiple_of(2) { -2e-3 } else { 1e-3 };
    let made = made(&all(|k| [still(k), swings(k)]));
    assert_eq!((made.chosen, made.families[0].depends_on), (0, "an offset"));
    let model = &made.model;
    near(model.factor, 1.0, 1e-9);
    for (joint, [offset, radius]) in model.joints.iter().zip([[0.25e-3, 0.75e-3], [-5e-4, 1.5e-3]])
    {
        near(joint.offset, offset, 1e-9);
        near(joint.radius, radius, 1e-9);
        let others = [joint.speed, joint.acceleration, joint.direction, joint.radius_per_speed];
        assert_eq!(others, [0.0; 4]);
    }
    assert!(made.is_useful());
    near(model.mean_half_width(), 1.125e-3, 1e-9);
    near(model.mean_without_model(), 1.2 * 1.5e-3, 1e-9);
}

/// Errors e and -e in turn have second differences of 4 e, whose three robust standard deviations
/// are 3 · 1.4826 · 4 e / √6: the least half-width of a joint that stands.
#[test]
fn the_set_of_a_joint_that_stands_is_as_wide_as_its_noise() {
    let in_turn = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let model = made(&all(|k| [1e-4 * in_turn(k), 1e-3 * in_turn(k / 2)])).model;
    near(model.joints[0].radius, 3.0 * 1.4826 * 4e-4 / 6f64.sqrt(), 1e-9);
    assert!(model.joints[0].offset.abs() <= 1e-4);
    near(model.joints[1].radius, 1e-3, 1e-9);
}

/// A joint that is locked and logged as its command has no error. Its set holds it, in a check too.
#[test]
fn a_joint_without_an_error_is_inside() {
    let swings = |k: usize| if k.is_multiple_of(2) { -2e-3 } else { 1e-3 };
    let recordings = all(|k| [0.0, swings(k)]);
    let model = made(&recordings).model;
    assert!(model.verified && model.joints[0].radius < 1e-8, "{:?}", model.joints[0]);
    near(model.joints[1].radius, 1.5e-3, 1e-9);
    let check = model.check(&recordings).unwrap();
    assert!(check.conformant && check.motions.iter().all(|of| of.needed.is_finite()), "{check:?}");
    let mut moved = recordings[0].clone();
    moved.actual[2 * 7] += 1e-6;
    let check = model.check(&[moved]).unwrap();
    assert_eq!((check.outside, check.joints[0].outside), (1, 1));
}

/// Returns recordings of two joints that are late exactly, by the speed of the parabola through 3
/// commands.
fn late() -> Vec<TrackedRun> {
    let late = |number: usize| {
        let mut of = standing(number, |_| [0.0; 2]);
        for (k, time) in of.times.iter().enumerate() {
            of.command[2 * k] = 0.3 * (2.3 * time + 0.1 * number as f64).cos();
        }
        of.actual = of.command.clone();
        for k in 0..SAMPLES {
            for (joint, lag) in LAGS.into_iter().enumerate() {
                of.actual[2 * k + joint] -= lag * rates(&of, k, joint)[0];
            }
        }
        of
    };
    (0..4).map(late).collect()
}

/// Errors that a lag explains need no set. The family is the simplest with a lag.
#[test]
fn an_exact_lag_needs_no_radius() {
    let made = made(&late());
    assert_eq!(made.families[made.chosen].depends_on, "an offset and a lag");
    assert!(made.model.verified);
    for (joint, lag) in made.model.joints.iter().zip(LAGS) {
        assert!((joint.speed + lag).abs() < 1e-7, "{joint:?}");
        assert!(joint.offset.abs() < 1e-7, "{joint:?}");
        assert!(joint.half_width(joint.largest_speed) < 1e-5 * joint.largest_error, "{joint:?}");
    }
    assert!(made.is_useful());
}
