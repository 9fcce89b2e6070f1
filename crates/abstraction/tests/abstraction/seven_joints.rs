use reachtube_abstraction::ModelKind;
use reachtube_robot::Robot;

use crate::common::{largest, model, numbers, truth};

#[test]
fn a_robot_of_seven_joints_has_28_variables() {
    let robot = Robot::from_toml(SEVEN_JOINTS, "seven joints").unwrap();
    let mut seed = 77;
    let [two, three] = [(ModelKind::Two, 14), (ModelKind::Three, 3)]
        .map(|(kind, order)| model(&robot, kind, order));
    assert_eq!((two.layout().variables(), three.states()), (28, 28));
    let [q, qd, u] = [0.05, 0.05, 0.5].map(|scale| numbers(&mut seed, 7, scale));
    let (rate, expected) = (three.rate(&three.state(&q, &qd), &u), truth(&robot, &q, &qd, &u));
    let error = largest((0..7).map(|i| rate[7 + i] - expected[i]));
    assert!(error < 1e-3 * largest(expected.iter().copied()), "{error} of {expected:?}");
    let mass = robot.mass_matrix(&[0.0; 7]).cholesky().unwrap();
    let load = nalgebra::DVector::from_vec(u.clone()) - robot.coriolis_torque(&q, &qd);
    let (rate, expected) = (two.rate(&two.state(&q, &qd), &u), mass.solve(&load));
    assert!(
        largest((0..7).map(|i| rate[7 + i] - expected[i])) < 1e-12 * expected.amax(),
        "Coriolis terms are exact"
    );
}

/// An arm with the axes of a usual arm of seven joints; its masses and lengths are made up.
const SEVEN_JOINTS: &str = r#"
    schema_version = 1
    name = "seven joints"
    convention = "modified"
    [[joint]]
    name = "1"
    dh = { a = 0.0, alpha = 0.0, theta = 0.0, d = 0.3 }
    mass = 3.0
    com = [0.0, 0.02, -0.1]
    inertia = [0.03, 0.0, 0.0, 0.03, 0.0, 0.01]
    armature = 0.5
    [[joint]]
    name = "2"
    dh = { a = 0.0, alpha = -1.5707963267948966, theta = 0.0, d = 0.0 }
    mass = 3.0
    com = [0.0, -0.1, 0.02]
    inertia = [0.03, 0.0, 0.0, 0.01, 0.0, 0.03]
    armature = 0.5
    [[joint]]
    name = "3"
    dh = { a = 0.0, alpha = 1.5707963267948966, theta = 0.0, d = 0.3 }
    mass = 2.0
    com = [0.03, 0.02, -0.05]
    inertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.01]
    armature = 0.4
    [[joint]]
    name = "4"
    dh = { a = 0.08, alpha = 1.5707963267948966, theta = 0.0, d = 0.0 }
    mass = 2.0
    com = [-0.04, 0.08, 0.02]
    inertia = [0.02, 0.0, 0.0, 0.01, 0.0, 0.02]
    armature = 0.4
    [[joint]]
    name = "5"
    dh = { a = -0.08, alpha = -1.5707963267948966, theta = 0.0, d = 0.38 }
    mass = 1.5
    com = [0.0, 0.03, -0.1]
    inertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.004]
    armature = 0.2
    [[joint]]
    name = "6"
    dh = { a = 0.0, alpha = 1.5707963267948966, theta = 0.0, d = 0.0 }
    mass = 1.0
    com = [0.05, 0.0, 0.0]
    inertia = [0.002, 0.0, 0.0, 0.004, 0.0, 0.004]
    armature = 0.2
    [[joint]]
    name = "7"
    dh = { a = 0.088, alpha = 1.5707963267948966, theta = 0.0, d = 0.1 }
    mass = 0.7
    com = [0.01, 0.0, 0.06]
    inertia = [0.002, 0.0, 0.0, 0.002, 0.0, 0.001]
    armature = 0.2
"#;
