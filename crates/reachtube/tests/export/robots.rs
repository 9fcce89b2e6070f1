//! MJCF and URDF: URDF is read back by our own reader, and its torques are the robot's.

use reachtube::Robot;
use reachtube::export::robot::{UrdfFiles, check_torques, mjcf, urdf};
use reachtube::robot::{Urdf, UrdfOptions};

use crate::cases::{Numbers, every_kind, shared};

fn pendulum() -> Robot {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robot/examples/double_pendulum.toml");
    Robot::load(path).unwrap()
}

/// Asserts that the URDF with its companion has the robot's torques.
fn assert_same_torques(robot: &Robot) {
    let UrdfFiles { urdf, companion } = urdf(robot).unwrap();
    let options = UrdfOptions::default();
    let read = Urdf::parse_with(&urdf, "robot.urdf", &companion, &options).unwrap().into_robot();
    let (n, mut numbers) = (robot.joint_count(), Numbers::new());
    for _ in 0..100 {
        let (q, qd, qdd) = (numbers.vector(n, 3.0), numbers.vector(n, 2.0), numbers.vector(n, 5.0));
        let tau = robot.inverse_dynamics(&q, &qd, &qdd);
        let error = (read.inverse_dynamics(&q, &qd, &qdd) - &tau).amax();
        assert!(error < 1e-11 * tau.amax().max(1.0), "{error}");
        let friction = (read.viscous_torque(&qd) - robot.viscous_torque(&qd)).amax();
        assert!(friction < 1e-14);
    }
}

#[test]
fn urdf_has_the_torques_of_the_robot() {
    [pendulum(), every_kind()].iter().for_each(assert_same_torques);
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn urdf_of_recorded_robots_has_their_torques() {
    for path in ["data/ur10e/ur10e.urdf", "oracle/dh6.urdf", "oracle/ur5.urdf"] {
        assert_same_torques(&Robot::load(shared(path).to_str().unwrap()).unwrap());
    }
}

#[test]
fn mjcf_nests_one_body_per_joint() {
    let text = mjcf(&every_kind()).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    let joints: Vec<_> = document.descendants().filter(|node| node.has_tag_name("joint")).collect();
    let values =
        |name: &str| joints.iter().map(|node| node.attribute(name).unwrap()).collect::<Vec<_>>();
    assert_eq!(values("type"), ["hinge", "slide", "hinge"]);
    assert_eq!(values("armature"), ["0.2", "0.4", "0.0"]);
    assert_eq!((values("damping")[0], values("frictionloss")[0]), ("1.5", "2.0"));
    let depth = joints[2].ancestors().filter(|node| node.has_tag_name("body")).count();
    assert_eq!(depth, 3);
}

#[test]
fn masses_that_no_simulator_takes_are_refused_by_name() {
    let error = mjcf(&Robot::lwa4p()).unwrap_err().to_string();
    assert!(error.contains("Schunk LWA 4P") && error.contains("model.physical"), "{error}");
    let mut description = every_kind().description().clone();
    description.parameters = reachtube::robot::ParameterSet::Base;
    description.joints[1].mass = -1.0;
    let robot = Robot::from_description(&description).unwrap();
    let error = urdf(&robot).unwrap_err().to_string();
    assert!(error.contains(&description.joints[1].name), "{error}");
}

#[test]
fn the_table_of_torques_is_that_of_the_robot() {
    let (robot, text) = (pendulum(), check_torques(&pendulum()));
    assert_eq!(text.lines().count(), 1001);
    let row: Vec<f64> =
        text.lines().nth(7).unwrap().split(',').map(|value| value.parse().unwrap()).collect();
    let tau = robot.inverse_dynamics(&row[..2], &row[2..4], &row[4..6]);
    assert_eq!(tau.as_slice(), &row[6..]);
}

#[test]
fn a_name_ends_no_comment() {
    let mut description = every_kind().description().clone();
    description.name = "arm\n--><mujoco \"\"\"".into();
    let robot = Robot::from_description(&description).unwrap();
    let text = mjcf(&robot).unwrap();
    let document = roxmltree::Document::parse(&text).unwrap();
    assert_eq!(document.root_element().attribute("model").unwrap().matches('_').count(), 4);
}
