use reachtube_abstraction::{ExpansionPoint, ModelField, ModelKind, PolynomialModel};
use reachtube_ode::{Ensemble, InitialValueProblem};
use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::{Lanewise, Powers};

pub(crate) const KINDS: [ModelKind; 3] = [ModelKind::One, ModelKind::Two, ModelKind::Three];

/// Returns a reproducible number in [-1, 1].
pub(crate) fn number(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

pub(crate) fn numbers(seed: &mut u64, count: usize, scale: f64) -> Vec<f64> {
    (0..count).map(|_| scale * number(seed)).collect()
}

/// Returns q̈ of (10), n, rad/s², by the articulated-body algorithm. The motor torque minus gravity
/// and Coulomb friction is u.
pub(crate) fn truth(robot: &Robot, q: &[f64], qd: &[f64], u: &[f64]) -> Vec<f64> {
    let n = robot.joint_count();
    let (sin, cos) = robot.sin_cos(q);
    let mut ws = Workspace::new(robot);
    let mut torque = vec![0.0; n];
    robot.gravity(&sin, &cos, &mut ws, &mut torque);
    for i in 0..n {
        torque[i] += u[i] - robot.joints()[i].friction.viscous.torque(&qd[i]);
    }
    let mut qdd = vec![0.0; n];
    robot.aba(&sin, &cos, qd, &torque, &mut ws, &mut qdd);
    qdd
}

pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    let largest = values.into_iter().map(f64::abs).max_by(f64::total_cmp).unwrap();
    assert!(!largest.is_nan());
    largest
}

pub(crate) fn model(robot: &Robot, kind: ModelKind, order: u32) -> PolynomialModel {
    PolynomialModel::new(robot, kind, order, &ExpansionPoint::zero(robot.joint_count())).unwrap()
}

/// Returns the states at the samples of all runs, one run after the other.
pub(crate) fn simulated<S: Lanewise + Powers>(
    model: &PolynomialModel,
    times: &[f64],
    runs: &[InitialValueProblem<'_>],
) -> Vec<f64> {
    let mut states = vec![0.0; runs.len() * times.len() * model.states()];
    let place = |run: usize, sample: usize| (run * times.len() + sample) * model.states();
    let mut field = ModelField::<S>::new(model);
    let outcomes =
        Ensemble::new(model.states()).integrate(&mut field, times, 4, runs, |run, sample, x| {
            states[place(run, sample)..][..x.len()].copy_from_slice(x);
        });
    assert!(outcomes.iter().all(|outcome| outcome.is_reached()));
    states
}

/// Returns an arm with the axes of a usual arm of seven joints. Its masses and lengths are made up.
pub(crate) fn seven_joints() -> Robot {
    Robot::from_toml(SEVEN_JOINTS, "seven joints").unwrap()
}

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
