use reachtube_abstraction::{ExpansionPoint, ModelKind, PolynomialModel, linear_model};
use reachtube_robot::Robot;

use crate::common::{KINDS, largest, model, numbers, truth};

#[test]
fn at_order_one_the_three_models_are_one_linear_system() {
    let robot = Robot::lwa4p();
    let linear = linear_model(&robot, &ExpansionPoint::zero(6)).unwrap();
    for kind in KINDS {
        let system = model(&robot, kind, 1).linear_system().unwrap();
        let scale = linear.a().amax();
        assert!((system.a() - linear.a()).amax() < 1e-14 * scale, "{kind:?}");
        assert!((system.b() - linear.b()).amax() < 1e-14 * linear.b().amax(), "{kind:?}");
        assert!(system.drift().amax() < 1e-14, "{kind:?}");
    }
    let error = model(&robot, ModelKind::Two, 3).linear_system().unwrap_err().to_string();
    assert!(error.contains("not linear") && error.contains("use order 1"), "{error}");
}

#[test]
fn model_1_is_complete_at_order_3() {
    let robot = Robot::lwa4p();
    let (third, ninth) = (model(&robot, ModelKind::One, 3), model(&robot, ModelKind::One, 9));
    assert_eq!((third.degree(), ninth.degree()), (3, 3));
    assert!(
        third.acceleration().iter().zip(ninth.acceleration()).all(|(a, b)| a.terms() == b.terms())
    );
}

/// The order p_max is 12 for the LWA 4P: M_m(q_a) q̈ = u - c - τ_v holds to rounding at this order
/// and at no lower one.
#[test]
fn coriolis_terms_of_model_2_are_exact_from_order_12() {
    let robot = Robot::lwa4p();
    let mass = robot.mass_matrix(&[0.0; 6]);
    let mut seed = 3;
    for (order, exact) in [(11, false), (12, true), (14, true)] {
        let model = model(&robot, ModelKind::Two, order);
        assert_eq!(model.degree(), order.min(12));
        let mut worst: f64 = 0.0;
        for _ in 0..50 {
            let (q, qd, u) = (
                numbers(&mut seed, 6, 3.0),
                numbers(&mut seed, 6, 1.2),
                numbers(&mut seed, 6, 10.0),
            );
            let rate = model.rate(&model.state(&q, &qd), &u);
            let expected =
                mass.clone().cholesky().unwrap().solve(&nalgebra::DVector::from_fn(6, |i, _| {
                    u[i] - robot.motion_torque(&q, &qd, &vec![0.0; q.len()])[i]
                        - robot.viscous_torque(&qd)[i]
                }));
            let scale = largest(expected.iter().copied());
            worst = worst.max(largest((0..6).map(|i| rate[6 + i] - expected[i])) / scale);
        }
        assert_eq!(worst < 1e-12, exact, "order {order}: {worst}");
    }
}

/// Near the expansion point, the error of model 3 falls with the power p + 1 of the distance.
#[test]
fn model_3_is_a_taylor_polynomial_of_the_forward_dynamics() {
    let robot = Robot::lwa4p();
    let mut seed = 8;
    let point = ExpansionPoint::from_values(
        &[numbers(&mut seed, 6, 1.5), numbers(&mut seed, 6, 0.6), numbers(&mut seed, 6, 5.0)]
            .concat(),
        6,
    )
    .unwrap();
    let direction =
        [numbers(&mut seed, 6, 1.0), numbers(&mut seed, 6, 1.0), numbers(&mut seed, 6, 5.0)];
    for order in 1..=4u32 {
        let model = PolynomialModel::new(&robot, ModelKind::Three, order, &point).unwrap();
        let error = |t: f64| {
            let along = |at: &[f64], d: &[f64]| -> Vec<f64> {
                at.iter().zip(d).map(|(a, d)| a + t * d).collect()
            };
            let (q, qd, u) = (
                along(&point.q, &direction[0]),
                along(&point.qd, &direction[1]),
                along(&point.u, &direction[2]),
            );
            let (rate, expected) =
                (model.rate(&model.state(&q, &qd), &u), truth(&robot, &q, &qd, &u));
            largest((0..6).map(|i| rate[6 + i] - expected[i]))
        };
        let slope = (error(0.04) / error(0.02)).log2();
        assert!((slope - f64::from(order + 1)).abs() < 0.3, "order {order}: slope {slope}");
    }
}
