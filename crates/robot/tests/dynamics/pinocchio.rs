//! Dynamics against Pinocchio 4.1.0 (`shared/oracle/*.json`): the UR5 by placements, and the LWA
//! 4P's geometry by placements and by Denavit-Hartenberg parameters.

use crate::close::assert_close;
use crate::shared::{description, numbers, oracle};
use nalgebra::{Matrix3, Rotation3, Vector3};
use reachtube_robot::{Dh, Robot, RobotDescription, Workspace};
use serde_json::Value;

/// Describes the same robot in Denavit-Hartenberg frames. The oracle's link frame is the joint
/// frame after theta, so that x_dh = Rx(-alpha) (x - (a, 0, d)).
fn dh_description(oracle: &Value) -> RobotDescription {
    let mut description = description(oracle);
    for (joint, row) in description.joints.iter_mut().zip(oracle["dh_standard"].as_array().unwrap())
    {
        let get = |key: &str| row[key].as_f64().unwrap();
        let (a, alpha, theta, d) = (get("a"), get("alpha"), get("theta_offset"), get("d"));
        (joint.placement, joint.axis) = (None, None);
        joint.dh = Some(Dh { a, alpha, theta, d });
        let rotation = Rotation3::from_axis_angle(&Vector3::x_axis(), -alpha);
        joint.com =
            joint.com.map(|c| (rotation * (Vector3::from(c) - Vector3::new(a, 0.0, d))).into());
        let [xx, xy, xz, yy, yz, zz] = joint.inertia;
        let t = rotation * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * rotation.inverse();
        joint.inertia = [t[(0, 0)], t[(0, 1)], t[(0, 2)], t[(1, 1)], t[(1, 2)], t[(2, 2)]];
    }
    description
}

/// Compares all algorithms with the oracle.
fn assert_agreement(robot: &Robot, oracle: &Value) {
    let n = robot.joint_count();
    let mut ws = Workspace::new(robot);
    for state in oracle["states"].as_array().unwrap() {
        let get = |key: &str| numbers(&state[key]);
        let (q, qd, qdd, tau) = (get("q"), get("qd"), get("qdd"), get("tau"));
        let (sin, cos) = robot.sin_cos(&q);
        let mut out = vec![0.0; n];
        robot.rnea(&sin, &cos, &qd, &qdd, &mut ws, &mut out);
        assert_close(&out, &get("rnea"), "rnea");
        robot.aba(&sin, &cos, &qd, &tau, &mut ws, &mut out);
        assert_close(&out, &get("aba"), "aba");
        robot.forward_dynamics(&sin, &cos, &qd, &tau, &mut ws, &mut out);
        assert_close(&out, &get("aba"), "forward_dynamics");
        robot.coriolis(&sin, &cos, &qd, &mut ws, &mut out);
        assert_close(&out, &get("c"), "c");
        robot.gravity(&sin, &cos, &mut ws, &mut out);
        assert_close(&out, &get("g"), "g");
        let m = robot.mass_matrix(&q);
        let lower: Vec<_> =
            (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|k| m[k]).collect();
        assert_close(&lower, &get("M_lower"), "M");
        let scalar = |key: &str| state[key].as_f64().unwrap();
        assert!(
            (robot.kinetic_energy(&q, &qd) - scalar("ekin")).abs()
                <= 1e-10 * (1.0 + scalar("ekin"))
        );
        assert!(
            (robot.potential_energy(&q) - scalar("epot")).abs()
                <= 1e-10 * (1.0 + scalar("epot").abs())
        );
    }
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn ur5_by_placements_agrees_with_pinocchio() {
    let oracle = oracle("oracle/ur5.json");
    let robot = Robot::from_description(&description(&oracle)).unwrap();
    assert_agreement(&robot, &oracle);
    for state in oracle["states"].as_array().unwrap() {
        let tip = robot.link_placements(&numbers(&state["q"]))[5].translation;
        assert_close(tip.as_slice(), &numbers(&state["ee_p"]), "ee_p");
    }
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn dh6_by_placements_agrees_with_pinocchio() {
    let oracle = oracle("oracle/dh6.json");
    assert_agreement(&Robot::from_description(&description(&oracle)).unwrap(), &oracle);
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn dh6_by_denavit_hartenberg_agrees_with_pinocchio() {
    let oracle = oracle("oracle/dh6.json");
    assert_agreement(&Robot::from_description(&dh_description(&oracle)).unwrap(), &oracle);
}
