//! Lags, friction and radii of the servo are found.

use crate::common::{made, servo, texts};
use crate::servo::{FRICTION, LAGS};
use reachtube_tracking::Code;

#[test]
fn lags_and_friction_are_found() {
    let made = made(&servo(6));
    for (joint, lag) in made.model.joints.iter().zip(LAGS) {
        assert!((joint.speed + lag).abs() < 1e-4, "{joint:?}");
        assert!(joint.offset.abs() < 2e-5 && joint.acceleration.abs() < 2e-4, "{joint:?}");
    }
    let direction = [0, 1].map(|joint| made.model.joints[joint].direction);
    assert!((-1.25 * FRICTION..=-0.85 * FRICTION).contains(&direction[0]), "{direction:?}");
    assert!(direction[1].abs() < 0.05e-3, "{direction:?}");
}

#[test]
fn sets_are_as_wide_as_jitter_and_noise() {
    let made = made(&servo(6));
    let model = &made.model;
    assert!((1.0..1.4).contains(&model.factor), "{}", model.factor);
    for joint in &model.joints {
        // The jitter is 1 ms, the noise 0.05 mrad.
        let [growth, rest] = [joint.radius_per_speed, joint.radius].map(|of| of / model.factor);
        assert!((0.9e-3..1.05e-3).contains(&growth), "{joint:?}");
        assert!((0.04e-3..0.15e-3).contains(&rest), "{joint:?}");
        let full = joint.half_width(joint.largest_speed);
        assert!(full < 1.2 * joint.largest_error, "{joint:?}");
        assert_eq!(joint.without_model(), 1.2 * joint.largest_error);
    }
    assert!(model.verified && model.is_useful() && made.is_useful());
    assert!(made.families[made.chosen].grows, "{:?}", made.families);
}

#[test]
fn good_logs_have_no_findings() {
    let made = made(&servo(6));
    assert_eq!(made.findings, []);
    for code in [Code::NotFollowing, Code::ClockSlips, Code::FewMotions, Code::NotNarrower] {
        assert_eq!(texts(&made, code), Vec::<&str>::new());
    }
    let left_out = &made.model.left_out;
    assert_eq!((left_out.motions, left_out.calibrated), (6, None));
    assert!(left_out.inside.is_some_and(|inside| (4..=6).contains(&inside)), "{left_out:?}");
    assert!(made.model.recordings.iter().all(|of| (of.samples, of.set_aside) == (600, 0)));
}
