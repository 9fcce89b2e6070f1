use reachtube_abstraction::{ModelKind, OperatingBox};
use reachtube_robot::Robot;

use crate::common::{largest, model, numbers, truth};

/// The bound holds at 20,000 states and is at most a few times the largest sampled error.
#[test]
fn truncation_errors_lie_within_their_bounds() {
    let robot = Robot::lwa4p();
    let mut seed = 5;
    for (kind, order, radii, boxes, times) in [
        (ModelKind::One, 1, [0.2, 0.3, 2.0], 64, 2.0),
        (ModelKind::Two, 4, [0.2, 0.3, 2.0], 8, 3.0),
        (ModelKind::Three, 3, [0.1, 0.3, 2.0], 8, 4.0),
    ] {
        let model = model(&robot, kind, order);
        let operating_box = OperatingBox::about(model.expansion_point(), &radii).unwrap();
        let remainder = model.bound_remainder(&operating_box, boxes).unwrap();
        let bounds: Vec<[f64; 2]> = remainder.bounds.iter().map(|b| b.unwrap()).collect();
        for _ in 0..20_000 {
            let [q, qd, u] = radii.map(|radius| numbers(&mut seed, 6, radius));
            let (rate, exact) = (model.rate(&model.state(&q, &qd), &u), truth(&robot, &q, &qd, &u));
            for i in 0..6 {
                let error = exact[i] - rate[6 + i];
                assert!(
                    bounds[i][0] <= error && error <= bounds[i][1],
                    "{kind:?}: joint {i}: {error} {:?}",
                    bounds[i]
                );
            }
        }
        for (bound, sampled) in bounds.iter().zip(&remainder.sampled_error) {
            assert!(largest(*bound) < times * sampled, "{kind:?}: {bound:?}, sampled {sampled}");
        }
    }
}

/// Over a box too wide for a proof that the mass matrix is invertible, the result is `None`.
#[test]
fn a_box_too_wide_has_no_bound() {
    let robot = Robot::lwa4p();
    let model = model(&robot, ModelKind::One, 1);
    let whole = OperatingBox::about(model.expansion_point(), &[3.1, 1.2, 10.0]).unwrap();
    assert!(model.bound_remainder(&whole, 4).unwrap().bounds.iter().all(Option::is_none));
    let refusal = |radii: &[f64]| {
        let outside = OperatingBox::about(model.expansion_point(), radii);
        outside.and_then(|b| model.bound_remainder(&b, 4)).unwrap_err().to_string()
    };
    assert!(
        refusal(&[0.1, 1.3, 1.0]).contains("beyond the limits [-1.2, 1.2]"),
        "{}",
        refusal(&[0.1, 1.3, 1.0])
    );
    assert!(refusal(&[4.0, 1.0, 1.0]).contains("joint1"));
    assert!(refusal(&[0.1, -1.0, 1.0]).contains("0 or more"));
    assert!(refusal(&[0.1, 1.0]).contains("give 3"));
}
