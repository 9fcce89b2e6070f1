//! The embedded Schunk LWA 4P against an independent evaluation of the paper's Table III with the
//! regressor of the standard inertial parameters (`shared/lwa4p/oracle.json`).

use crate::close::assert_close;
use crate::shared::{numbers, oracle};
use reachtube_robot::{Robot, Workspace};

#[test]
#[ignore = "needs the recordings in ../shared"]
fn lwa4p_agrees_with_the_regressor_of_table_iii() {
    let oracle = oracle("lwa4p/oracle.json");
    let robot = Robot::lwa4p();
    for sample in oracle["samples"].as_array().unwrap() {
        let get = |key: &str| numbers(&sample[key]);
        let (q, qd, qdd) = (get("q"), get("qd"), get("qdd"));
        let m: Vec<f64> =
            sample["mass_matrix"].as_array().unwrap().iter().flat_map(numbers).collect();
        assert_close(robot.mass_matrix(&q).as_slice(), &m, "M");
        assert_close(
            robot.motion_torque(&q, &qd, &vec![0.0; q.len()]).as_slice(),
            &get("coriolis"),
            "c",
        );
        assert_close(robot.gravity_torque(&q).as_slice(), &get("gravity"), "g");
        assert_close(robot.inverse_dynamics(&q, &qd, &qdd).as_slice(), &get("tau_l"), "tau_l");
        let net = robot.gravity_torque(&q).add_scalar(3.0) - robot.viscous_torque(&qd);
        let expected = get("qdd_from_u");
        assert_close(
            robot.forward_acceleration(&q, &qd, net.as_slice()).as_slice(),
            &expected,
            "qdd by ltdl",
        );
        let ((sin, cos), mut qdd) = (robot.sin_cos(&q), [0.0; 6]);
        robot.aba(&sin, &cos, &qd, net.as_slice(), &mut Workspace::new(&robot), &mut qdd);
        assert_close(&qdd, &expected, "qdd by aba");
    }
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn lwa4p_has_the_mass_matrix_of_the_paper_at_zero() {
    let oracle = oracle("lwa4p/oracle.json");
    let expected: Vec<f64> = oracle["M0"].as_array().unwrap().iter().flat_map(numbers).collect();
    let m = Robot::lwa4p().mass_matrix(&[0.0; 6]);
    assert_close(m.as_slice(), &expected, "M(0)");
    for (i, e) in [1.7355, 3.9830, 2.3818, 1.7417, 0.6670, 0.6427].into_iter().enumerate() {
        assert!((m[(i, i)] - e).abs() < 5.1e-5, "{} is not {e}", m[(i, i)]);
    }
}
