//! MJCF and URDF: URDF is read back by our own reader, and its torques are the robot's.

use reachtube::Robot;
use reachtube::export::ExportFile;
use reachtube::export::robot::{mjcf_files, updated_urdf_files, urdf_files};
use reachtube::robot::{Urdf, UrdfOptions};

use crate::cases::{Numbers, every_kind, shared};

fn pendulum() -> Robot {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robot/examples/double_pendulum.toml");
    Robot::load(path).unwrap()
}

/// Returns the texts of the first two files: a URDF and its companion.
fn texts(files: &[ExportFile]) -> [&str; 2] {
    [&files[0].text, &files[1].text]
}

/// Asserts that the URDF with its companion has the robot's torques.
fn assert_same_torques(robot: &Robot) {
    let files = urdf_files(robot).unwrap();
    let ([urdf, companion], options) = (texts(&files), UrdfOptions::default());
    let read = Urdf::parse_with(urdf, "robot.urdf", companion, &options).unwrap().into_robot();
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
    let files = mjcf_files(&every_kind()).unwrap();
    let document = roxmltree::Document::parse(&files[0].text).unwrap();
    let joints: Vec<_> = document.descendants().filter(|node| node.has_tag_name("joint")).collect();
    let values =
        |name: &str| joints.iter().map(|node| node.attribute(name).unwrap()).collect::<Vec<_>>();
    assert_eq!(values("type"), ["hinge", "slide", "hinge"]);
    assert_eq!(values("armature"), ["0.2", "0.4", "0.0"]);
    assert_eq!((values("damping")[0], values("frictionloss")[0]), ("1.5", "2.0"));
    let motors = document.descendants().filter(|node| node.has_tag_name("motor"));
    let motors: Vec<_> = motors.map(|node| node.attribute("joint").unwrap()).collect();
    assert_eq!(motors, values("name"));
    let depth = joints[2].ancestors().filter(|node| node.has_tag_name("body")).count();
    assert_eq!(depth, 3);
}

#[test]
fn masses_that_no_simulator_takes_are_refused_by_name() {
    let error = mjcf_files(&Robot::lwa4p()).unwrap_err().to_string();
    assert!(error.contains("Schunk LWA 4P") && error.contains("model.physical"), "{error}");
    let mut description = every_kind().description().clone();
    description.parameters = reachtube::robot::ParameterSet::Base;
    description.joints[1].mass = -1.0;
    let robot = Robot::from_description(&description).unwrap();
    let error = urdf_files(&robot).unwrap_err().to_string();
    assert!(error.contains(&description.joints[1].name), "{error}");
}

#[test]
fn the_table_of_torques_is_that_of_the_robot() {
    let (robot, files) = (pendulum(), urdf_files(&pendulum()).unwrap());
    let text = &files[2].text;
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
    let files = mjcf_files(&robot).unwrap();
    let document = roxmltree::Document::parse(&files[0].text).unwrap();
    assert_eq!(document.root_element().attribute("model").unwrap().matches('_').count(), 4);
}

/// The pendulum with friction that bends down, recorded between -1 and 2 rad/s.
fn curved() -> Robot {
    let mut description = pendulum().description().clone();
    description.joints[0].friction.viscous = [3.0, 0.2, -0.5];
    description.joints[0].friction.fitted_velocities = Some([-1.0, 2.0]);
    Robot::from_description(&description).unwrap()
}

#[test]
fn cubic_friction_is_exact_in_one_file_and_the_best_line_in_the_other() {
    let files = mjcf_files(&curved()).unwrap();
    let damping = |name: &str| {
        let text = &files.iter().find(|file| file.name == name).unwrap().text;
        let document = roxmltree::Document::parse(text).unwrap();
        let joint = document.descendants().find(|node| node.has_tag_name("joint")).unwrap();
        joint.attribute("damping").unwrap().to_string()
    };
    assert_eq!(damping("robot.xml"), "3.0 0.0 -0.5");
    let line: f64 = damping("robot_linear.xml").parse().unwrap();
    // Least squares over many velocities, by sums.
    let (mut both, mut squares) = (0.0, 0.0);
    for k in 0..3000 {
        let v = -1.0 + (f64::from(k) + 0.5) * 1e-3;
        both += v * (3.0 * v + 0.2 * v * v - 0.5 * v * v * v);
        squares += v * v;
    }
    assert!((line - both / squares).abs() < 1e-5, "{line} {}", both / squares);
    let urdf = &urdf_files(&curved()).unwrap()[0].text;
    assert!(urdf.contains("best line over the velocities -1.000 to 2.000"), "{urdf}");
    // A line needs one file only.
    assert!(mjcf_files(&pendulum()).unwrap().iter().all(|file| file.name != "robot_linear.xml"));
}

#[test]
fn an_updated_urdf_keeps_all_other_text() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.urdf");
    let files = urdf_files(&every_kind()).unwrap();
    let [written, companion] = texts(&files);
    let mesh = "<visual><geometry><mesh filename=\"arm.stl\"/></geometry></visual>\n  </link>";
    let text = written.replacen("</link>", mesh, 1) + "<!-- mine -->\n";
    std::fs::write(&path, &text).unwrap();
    std::fs::write(path.with_extension("toml"), companion).unwrap();
    let robot = Urdf::load(&path, &UrdfOptions::default()).unwrap().into_robot();
    // The same robot changes nothing.
    assert_eq!(updated_urdf_files(&robot, &path, &[]).unwrap()[0].text, text);
    let mut description = robot.description().clone();
    description.joints[1].mass *= 1.5;
    description.joints[0].friction.viscous = [7.0, 0.0, 0.0];
    let heavier = Robot::from_description(&description).unwrap();
    let files = updated_urdf_files(&heavier, &path, &[]).unwrap();
    let [new, companion] = texts(&files);
    let kept = |line: &&str| {
        let own = ["<mass", "<inertia", "<origin", "<dynamics"];
        !own.iter().any(|tag| line.trim_start().starts_with(tag))
    };
    assert!(new.lines().filter(kept).eq(text.lines().filter(kept)));
    assert_ne!(new, text);
    let options = UrdfOptions::default();
    let read = Urdf::parse_with(new, "new", companion, &options).unwrap().into_robot();
    let state = [[0.3, -0.4, 0.1], [0.5, 0.2, -0.3], [1.0, -2.0, 0.5]];
    let torques = |robot: &Robot| robot.inverse_dynamics(&state[0], &state[1], &state[2]);
    assert!((torques(&read) - torques(&heavier)).amax() < 1e-12);
    // A URDF with links elsewhere is refused.
    let (before, after) = text.split_at(text.find("name=\"slide\"").unwrap());
    let moved = before.to_string() + &after.replacen("xyz=\"-", "xyz=\"-1", 1);
    assert_ne!(moved, text);
    std::fs::write(&path, moved).unwrap();
    let error = updated_urdf_files(&heavier, &path, &[]).unwrap_err().to_string();
    assert!(error.contains("arm.urdf") && error.contains("lie elsewhere"), "{error}");
}
