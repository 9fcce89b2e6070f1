//! The regressor against rnea and Pinocchio 4.1.0 (`shared/oracle`, `Y_rows`), and its `f64` values
//! against intervals.

use crate::close::assert_close;
use crate::identities::close;
use crate::random::robots_and_states;
use crate::shared::{numbers, oracle, oracle_robot};
use nalgebra::DMatrix;
use proptest::prelude::*;
use reachtube_robot::{Parameter, ParameterKind, Regressor, RegressorWorkspace, Robot, Workspace};
use reachtube_scalar::Interval;

/// Returns the regressor of the inertial parameters, n x 10 n.
pub(crate) fn inertial_regressor(
    robot: &Robot,
    q: &[f64],
    qd: &[f64],
    qdd: &[f64],
) -> DMatrix<f64> {
    let (n, (sin, cos)) = (q.len(), robot.sin_cos(q));
    let mut y = vec![0.0; 10 * n * n];
    robot.inertial_regressor(&sin, &cos, qd, qdd, &mut RegressorWorkspace::new(robot), &mut y);
    DMatrix::from_row_slice(n, 10 * n, &y)
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn regressors_agree_with_pinocchio() {
    for name in ["ur5", "dh6"] {
        let (robot, oracle) = (oracle_robot(name), oracle(&format!("oracle/{name}.json")));
        for state in oracle["states"].as_array().unwrap() {
            let [q, qd, qdd] = ["q", "qd", "qdd"].map(|key| numbers(&state[key]));
            let y = inertial_regressor(&robot, &q, &qd, &qdd);
            let rows: Vec<_> = state["Y_rows"].as_array().unwrap().iter().map(numbers).collect();
            // The oracle omits the columns of links before the joint, which are zero.
            let whole = rows
                .iter()
                .enumerate()
                .flat_map(|(i, row)| [vec![0.0; 10 * i], row.clone()].concat());
            assert_close(y.transpose().as_slice(), &whole.collect::<Vec<_>>(), name);
        }
    }
}

proptest! {
    /// Y θ is rnea's polynomial in independent sine and cosine, off the circle too.
    #[test]
    fn regressor_times_parameters_is_rnea(
        (robot, sin, qd, qdd) in robots_and_states(),
        cos in prop::collection::vec(-2.0..2.0f64, 8),
    ) {
        let n = qd.len();
        let (mut tau, mut y) = (vec![0.0; n], vec![f64::NAN; 10 * n * n]);
        robot.rnea(&sin, &cos, &qd, &qdd, &mut Workspace::new(&robot), &mut tau);
        let mut ws = RegressorWorkspace::new(&robot);
        robot.inertial_regressor(&sin, &cos, &qd, &qdd, &mut ws, &mut y);
        let theta = robot.inertial_parameters();
        let torque: Vec<f64> = y
            .chunks(10 * n)
            .zip(robot.joints().iter().zip(&qdd))
            .map(|(row, (j, qdd))| {
                row.iter().zip(&theta).map(|(y, p)| y * p).sum::<f64>() + j.armature * qdd
            })
            .collect();
        close(&torque, &tau)?;
    }

    #[test]
    fn intervals_enclose_the_regressor(
        (robot, q, qd, qdd) in robots_and_states(),
        radius in 0.0..0.01f64,
        pick in -1.0..1.0f64,
    ) {
        let n = q.len();
        let (sin, cos) = robot.sin_cos(&q);
        let wide = |x: &f64| Interval::centred(*x, radius);
        let inside = |x: &f64| x + 0.99 * pick * radius;
        let boxes = [&sin, &cos, &qd, &qdd].map(|x| x.iter().map(wide).collect::<Vec<_>>());
        let at = [&sin, &cos, &qd, &qdd].map(|x| x.iter().map(inside).collect::<Vec<_>>());
        let (mut outer, mut value) =
            (vec![Interval::ENTIRE; 10 * n * n], vec![f64::NAN; 10 * n * n]);
        let mut ws = RegressorWorkspace::new(&robot);
        robot.inertial_regressor(&boxes[0], &boxes[1], &boxes[2], &boxes[3], &mut ws, &mut outer);
        let mut ws = RegressorWorkspace::new(&robot);
        robot.inertial_regressor(&at[0], &at[1], &at[2], &at[3], &mut ws, &mut value);
        prop_assert!(outer.iter().zip(&value).all(|(o, v)| o.contains(*v)));
        prop_assert!(outer.iter().all(|o| o.width().is_finite()));
    }
}

/// The double pendulum's friction does not depend on the load, so its motor torque is linear in the
/// parameters.
#[test]
fn all_parameters_together_give_the_motor_torque() {
    use ParameterKind::{Coulomb, MotorInertia, Offset, Viscous1, Viscous2, Viscous3};
    let robot =
        Robot::load(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/double_pendulum.toml")).unwrap();
    let kinds = [
        &ParameterKind::INERTIAL[..],
        &[MotorInertia, Viscous1, Viscous2, Viscous3, Coulomb, Offset],
    ]
    .concat();
    let parameters = Parameter::of_joints(2, &kinds);
    let theta = nalgebra::DVector::from_vec(robot.parameter_values(&parameters));
    let (q, qd, qdd) = (vec![0.4, -1.1], vec![0.7, -2.0], vec![3.0, 1.0]);
    let y = Regressor::new(&robot, &parameters).stacked(&[[q.clone(), qd.clone(), qdd.clone()]]);
    let expected = robot.inverse_dynamics(&q, &qd, &qdd)
        + robot.viscous_torque(&qd)
        + robot.coulomb_torque(&q, &qd);
    assert_close((y * &theta).as_slice(), expected.as_slice(), "motor torque");

    let twice = robot.description().with_values(&parameters, (2.0 * &theta).as_slice()).unwrap();
    let twice = Robot::from_description(&twice).unwrap();
    assert_close(&twice.parameter_values(&parameters), (2.0 * &theta).as_slice(), "values");
    assert_close(
        twice.inverse_dynamics(&q, &qd, &qdd).as_slice(),
        (2.0 * robot.inverse_dynamics(&q, &qd, &qdd)).as_slice(),
        "rnea",
    );
}

#[test]
fn names_are_those_of_the_literature() {
    let names: Vec<_> = Parameter::of_joints(1, &ParameterKind::INERTIAL)
        .iter()
        .map(Parameter::to_string)
        .collect();
    assert_eq!(names.join(" "), "m1 mx1 my1 mz1 Ixx1 Ixy1 Iyy1 Ixz1 Iyz1 Izz1");
}
