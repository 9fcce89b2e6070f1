use reachtube_abstraction::ModelKind;

use crate::common::{largest, model, numbers, seven_joints, truth};

#[test]
fn a_robot_of_seven_joints_has_28_variables() {
    let robot = seven_joints();
    let mut seed = 77;
    let [two, three] = [(ModelKind::Two, 14), (ModelKind::Three, 3)]
        .map(|(kind, order)| model(&robot, kind, order));
    assert_eq!((two.states(), three.states()), (28, 28));
    let [q, qd, u] = [0.05, 0.05, 0.5].map(|scale| numbers(&mut seed, 7, scale));
    let (rate, expected) = (three.rate(&three.state(&q, &qd), &u), truth(&robot, &q, &qd, &u));
    let error = largest((0..7).map(|i| rate[7 + i] - expected[i]));
    assert!(error < 1e-3 * largest(expected.iter().copied()), "{error} of {expected:?}");
    let mass = robot.mass_matrix(&[0.0; 7]).cholesky().unwrap();
    let load =
        nalgebra::DVector::from_vec(u.clone()) - robot.motion_torque(&q, &qd, &vec![0.0; q.len()]);
    let (rate, expected) = (two.rate(&two.state(&q, &qd), &u), mass.solve(&load));
    assert!(
        largest((0..7).map(|i| rate[7 + i] - expected[i])) < 1e-12 * expected.amax(),
        "Coriolis terms are exact"
    );
}
