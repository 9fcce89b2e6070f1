use rayon::prelude::*;
use reachtube_abstraction::{ExpansionPoint, ModelKind, OperatingBox, PolynomialModel, Remainder};
use reachtube_robot::Robot;

use crate::common::{KINDS, light_wrist, model, number, truth};

/// Positions q_a of the light wrist, at which the condition of its mass matrix is some hundreds,
/// rad.
const AT: [f64; 7] = [0.3, -0.4, 0.2, -1.6, 0.5, 1.8, 0.7];

fn about(robot: &Robot, kind: ModelKind, order: u32, at: &[f64]) -> PolynomialModel {
    let point = ExpansionPoint::from_values(at, robot.joint_count()).unwrap();
    PolynomialModel::new(robot, kind, order, &point).unwrap()
}

/// Asserts that the truncation error lies within its bound at `samples` states of the box, half of
/// whose values are at the ends.
fn assert_holds(robot: &Robot, model: &PolynomialModel, remainder: &Remainder, samples: u64) {
    let (n, operating_box) = (robot.joint_count(), &remainder.operating_box);
    (0..samples).into_par_iter().for_each(|sample| {
        let mut seed = sample.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut point = |sides: &[[f64; 2]]| -> Vec<f64> {
            let value = |[low, high]: &[f64; 2]| {
                let part = (0.5 + number(&mut seed)).clamp(0.0, 1.0);
                low + part * (high - low)
            };
            sides.iter().map(value).collect()
        };
        let [q, qd, u] = [&operating_box.q, &operating_box.qd, &operating_box.u].map(|s| point(s));
        let (rate, exact) = (model.rate(&model.state(&q, &qd), &u), truth(robot, &q, &qd, &u));
        for i in 0..n {
            let ([low, high], error) = (remainder.bounds[i].unwrap(), exact[i] - rate[n + i]);
            // The sampled accelerations are rounded.
            let rounding = 1e-10 * (exact[i].abs() + 1.0);
            assert!(
                low - rounding <= error && error <= high + rounding,
                "{:?}: joint {i}: {error} outside [{low}, {high}]",
                model.kind()
            );
        }
    });
}

/// Returns the largest ratio of a bound to the largest error found.
fn largest_ratio(remainder: &Remainder) -> f64 {
    let ratio = |(bound, found): (&Option<[f64; 2]>, &f64)| {
        let [low, high] = bound.expect("a bound");
        low.abs().max(high.abs()) / found
    };
    remainder.bounds.iter().zip(&remainder.sampled_error).map(ratio).fold(0.0, f64::max)
}

fn bounded(model: &PolynomialModel, radii: &[f64], boxes: usize) -> Remainder {
    let operating_box = OperatingBox::about(model.expansion_point(), radii).unwrap();
    model.bound_remainder(&operating_box, boxes).unwrap()
}

#[test]
fn truncation_errors_lie_within_their_bounds() {
    let robot = Robot::lwa4p();
    for (kind, order, radii, boxes) in [
        (ModelKind::One, 1, [0.2, 0.3, 2.0], 16),
        (ModelKind::Two, 4, [0.2, 0.3, 2.0], 4),
        (ModelKind::Three, 3, [0.1, 0.3, 2.0], 4),
    ] {
        let model = model(&robot, kind, order);
        let remainder = bounded(&model, &radii, boxes);
        assert_holds(&robot, &model, &remainder, 20_000);
        assert!(largest_ratio(&remainder) < 1.3, "{kind:?}: {remainder:?}");
    }
}

/// Over 0.2 rad, the mass matrix changes by more than itself.
#[test]
fn an_arm_with_a_light_wrist_has_close_bounds() {
    let robot = light_wrist();
    for (kind, order) in [(ModelKind::One, 1), (ModelKind::Three, 1)] {
        let model = about(&robot, kind, order, &AT);
        let remainder = bounded(&model, &[0.2, 0.3, 2.0], model.default_max_boxes());
        assert_holds(&robot, &model, &remainder, 20_000);
        assert!(largest_ratio(&remainder) < 2.0, "{kind:?}: {remainder:?}");
    }
}

/// The expansion point has velocities and inputs, and the box is not centred on it.
#[test]
fn bounds_hold_about_points_in_motion() {
    let robot = Robot::lwa4p();
    let at: Vec<f64> = [[0.2; 6], [0.1; 6], [1.0; 6]].concat();
    for kind in KINDS {
        let model = about(&robot, kind, 2, &at);
        let operating_box = OperatingBox {
            q: vec![[0.15, 0.3]; 6],
            qd: vec![[-0.1, 0.4]; 6],
            u: vec![[0.5, 3.0]; 6],
        };
        let remainder = model.bound_remainder(&operating_box, 4).unwrap();
        assert_holds(&robot, &model, &remainder, 20_000);
        assert!(largest_ratio(&remainder) < 2.0, "{kind:?}: {remainder:?}");
    }
}

/// A million states per model. Run with `cargo test --release -- --ignored a_million`.
#[test]
#[ignore = "takes long, some minutes"]
fn bounds_hold_at_a_million_states() {
    for (robot, orders) in [(Robot::lwa4p(), [1, 3, 4]), (light_wrist(), [1, 2, 3])] {
        for (kind, order) in KINDS.into_iter().zip(orders) {
            let model = about(&robot, kind, order, &AT[..robot.joint_count()]);
            let remainder = bounded(&model, &[0.2, 0.3, 2.0], model.default_max_boxes());
            assert_holds(&robot, &model, &remainder, 1_000_000);
            assert!(largest_ratio(&remainder) < 2.0, "{kind:?}: {remainder:?}");
        }
    }
}

/// Over a box too wide for a proof that the mass matrix is invertible, the result is `None`. The
/// narrower box has bounds.
#[test]
fn a_box_too_wide_has_no_bound_and_a_narrower_one_has() {
    let robot = Robot::lwa4p();
    let model = model(&robot, ModelKind::One, 1);
    let whole = OperatingBox::about(model.expansion_point(), &[3.1, 1.2, 10.0]).unwrap();
    assert!(model.bound_remainder(&whole, 8).unwrap().bounds.iter().all(Option::is_none));
    let narrower = model.narrower_box(&whole, 8).unwrap().unwrap();
    assert!(model.bound_remainder(&narrower, 8).unwrap().bounds.iter().all(Option::is_some));
    assert!(narrower.qd == whole.qd && narrower.u == whole.u && narrower.q != whole.q);
    let fits = OperatingBox::about(model.expansion_point(), &[0.1, 1.2, 10.0]).unwrap();
    assert_eq!(model.narrower_box(&fits, 8).unwrap(), Some(fits));
}

#[test]
fn boxes_that_do_not_fit_are_refused() {
    let model = model(&Robot::lwa4p(), ModelKind::One, 1);
    let refusal = |radii: &[f64]| {
        let outside = OperatingBox::about(model.expansion_point(), radii);
        outside.and_then(|b| model.bound_remainder(&b, 4)).unwrap_err().to_string()
    };
    let beyond = refusal(&[0.1, 1.3, 1.0]);
    assert!(beyond.contains("beyond the limits [-1.2, 1.2]"), "{beyond}");
    assert!(refusal(&[4.0, 1.0, 1.0]).contains("joint1"));
    assert!(refusal(&[0.1, -1.0, 1.0]).contains("0 or more"));
    assert!(refusal(&[0.1, 1.0]).contains("give 3"));
}
