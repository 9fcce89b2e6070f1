//! Changes that mean nothing change little.

use reachtube_tracking::{MadeModel, TrackedRun};

use crate::common::{made, near, servo};

/// Returns a recording with these samples alone.
fn only(of: &TrackedRun, rows: impl Iterator<Item = usize> + Clone) -> TrackedRun {
    let n = of.joints.len();
    let positions = |all: &[f64]| -> Vec<f64> {
        rows.clone().flat_map(|k| all[k * n..(k + 1) * n].to_vec()).collect()
    };
    let first = of.times[rows.clone().next().unwrap()];
    TrackedRun {
        times: rows.clone().map(|k| of.times[k] - first).collect(),
        command: positions(&of.command),
        actual: positions(&of.actual),
        ..of.clone()
    }
}

/// Asserts the same verdict, and the same mean half-width up to a part.
#[track_caller]
fn is_like(changed: &MadeModel, whole: &MadeModel, part: f64) {
    assert!(changed.model.verified && whole.model.verified);
    assert_eq!(changed.is_useful(), whole.is_useful());
    near(changed.model.mean_half_width(), whole.model.mean_half_width(), part);
    near(changed.model.mean_without_model(), whole.model.mean_without_model(), part);
}

#[test]
fn fewer_samples_change_little() {
    let recordings = servo(6);
    let whole = made(&recordings);
    let changed = |change: &dyn Fn(&TrackedRun) -> TrackedRun| {
        made(&recordings.iter().map(change).collect::<Vec<_>>())
    };
    is_like(&changed(&|of| only(of, 1..600)), &whole, 0.1);
    is_like(&changed(&|of| only(of, 6..600)), &whole, 0.1);
    // Half of the samples touch smaller sets; the even ones choose a simpler family.
    is_like(&changed(&|of| only(of, (0..600).step_by(2))), &whole, 0.15);
    is_like(&changed(&|of| only(of, (1..600).step_by(2))), &whole, 0.15);
}

/// At either end of a gap, the nearer neighbour decides the speed.
#[test]
fn lost_samples_change_little() {
    let recordings = servo(6);
    let lost = |of: &TrackedRun| only(of, (0..600).filter(|k| !(300..330).contains(k)));
    let changed = made(&recordings.iter().map(lost).collect::<Vec<_>>());
    assert_eq!(changed.findings, []);
    is_like(&changed, &made(&recordings), 0.1);
}

/// A log that begins in the middle of a motion has its lag, and is not off its command.
#[test]
fn a_log_that_begins_in_a_motion_is_used_whole() {
    let late = |of: &TrackedRun| only(of, 200..600);
    let made = made(&servo(6).iter().map(late).collect::<Vec<_>>());
    assert_eq!(made.findings, []);
    assert!(made.model.recordings.iter().all(|of| (of.samples, of.set_aside) == (400, 0)));
}

#[test]
fn a_nanosecond_changes_little() {
    let recordings = servo(6);
    let whole = made(&recordings);
    let shifted = recordings.iter().map(|of| TrackedRun {
        times: of.times.iter().map(|time| time + 1e-9).collect(),
        ..of.clone()
    });
    let shifted = made(&shifted.collect::<Vec<_>>());
    is_like(&shifted, &whole, 0.1);
    assert_eq!(shifted.chosen, whole.chosen);
    // Rounding of times is all that changed.
    near(shifted.model.mean_half_width(), whole.model.mean_half_width(), 1e-6);
}

#[test]
fn the_order_of_recordings_does_not_matter() {
    let mut recordings = servo(6);
    let whole = made(&recordings);
    for order in [[5, 4, 3, 2, 1, 0], [2, 0, 5, 1, 4, 3]] {
        let all = servo(6);
        recordings = order.map(|of| all[of].clone()).to_vec();
        let other = made(&recordings);
        assert_eq!((other.chosen, &other.findings), (whole.chosen, &whole.findings));
        assert_eq!(other.model.left_out, whole.model.left_out);
        near(other.model.factor, whole.model.factor, 1e-9);
        for (found, expected) in other.model.joints.iter().zip(&whole.model.joints) {
            // Offsets and lags near 0 are the same to a part of what they are about.
            let apart =
                |a: f64, b: f64, unit: f64| assert!((a - b).abs() <= 1e-9 * unit, "{a} {b}");
            apart(found.offset, expected.offset, expected.radius);
            apart(found.speed, expected.speed, expected.speed.abs());
            apart(found.acceleration, expected.acceleration, 1e-3);
            apart(found.direction, expected.direction, expected.radius);
            near(found.radius, expected.radius, 1e-9);
            near(found.radius_per_speed, expected.radius_per_speed, 1e-9);
            assert_eq!(found.largest_error, expected.largest_error);
            assert_eq!(found.largest_speed, expected.largest_speed);
            assert_eq!(found.largest_acceleration, expected.largest_acceleration);
        }
    }
}
