//! Reading and writing of URDF: real files of the shared folder against the oracles, and the errors
//! of invalid files.

use crate::close::assert_close;
use crate::shared::{description, numbers, oracle};
use reachtube_robot::{Parameter, ParameterKind, Robot, Urdf, UrdfOptions};

const SHARED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/");

/// An arm with fixed joints, a motor, friction and a link without inertia.
const ARM: &str = include_str!("arm.urdf");

fn read(text: &str) -> Urdf {
    Urdf::parse(text, "arm.urdf", &UrdfOptions::default()).unwrap()
}

fn error_of(text: &str) -> String {
    Urdf::parse(text, "arm.urdf", &UrdfOptions::default()).unwrap_err().to_string()
}

/// Returns the error after one part of the arm is replaced.
fn error_with(part: &str, by: &str) -> String {
    assert!(ARM.contains(part), "{part}");
    error_of(&ARM.replacen(part, by, 1))
}

fn shared_urdf(path: &str) -> Urdf {
    Urdf::load(format!("{SHARED}{path}"), &UrdfOptions::default()).unwrap()
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn urdfs_of_the_oracles_agree_with_pinocchio() {
    for name in ["ur5", "dh6"] {
        let (urdf, oracle) =
            (shared_urdf(&format!("oracle/{name}.urdf")), oracle(&format!("oracle/{name}.json")));
        let robot = urdf.robot();
        let armatures: Vec<_> =
            description(&oracle).joints.iter().map(|j| j.armature.unwrap()).collect();
        for state in oracle["states"].as_array().unwrap() {
            let [q, qd, mut qdd] = ["q", "qd", "qdd"].map(|key| numbers(&state[key]));
            let tau = robot.inverse_dynamics(&q, &qd, &qdd);
            // The URDF has no armature.
            qdd.iter_mut().zip(&armatures).for_each(|(qdd, a)| *qdd *= a);
            assert_close(
                (tau + nalgebra::DVector::from_vec(qdd)).as_slice(),
                &numbers(&state["rnea"]),
                name,
            );
            let tip = robot.link_placements(&q)[5].translation;
            assert_close(tip.as_slice(), &numbers(&state["ee_p"]), "ee_p");
        }
    }
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn real_files_are_read_with_limits_friction_and_gears() {
    let (ur10e, acrobot) =
        (shared_urdf("data/ur10e/ur10e.urdf"), shared_urdf("data/double_pendulum/acrobot.urdf"));
    let joints = ur10e.robot().joints();
    assert_eq!(joints.len(), 6);
    // The file has pi with eleven digits.
    assert!(
        core::f64::consts::PI < joints[2].position_limits[1]
            && joints[2].position_limits[1] < core::f64::consts::PI + 1e-11
    );
    assert_eq!(
        joints[0].velocity_limit.zip(joints[5].velocity_limit).map(|(slow, fast)| fast / slow),
        Some(2.0)
    );
    assert_eq!(joints[0].gear_ratio, Some(1.0));
    assert!(ur10e.robot().check_physical().is_ok());
    let joints = acrobot.robot().joints();
    assert_eq!(joints.iter().map(|j| j.name.as_str()).collect::<Vec<_>>(), ["Joint1", "Joint2"]);
    assert_eq!(
        (joints[0].friction.viscous.v1, joints[0].friction.coulomb.driving_forward.offset),
        (0.001, 0.16)
    );
    // The second link's frame is upside down in the URDF, but q = 0 is the hanging position in
    // both.
    let described =
        Robot::load(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/double_pendulum.toml")).unwrap();
    let loaded = Robot::load(&format!("{SHARED}data/double_pendulum/acrobot.urdf")).unwrap();
    let (a, b) = (loaded.gravity_torque(&[0.3, 0.0]), described.gravity_torque(&[0.3, 0.0]));
    assert!((a - b).amax() < 1e-4);
}

/// The expected values are computed by hand.
#[test]
fn fixed_links_are_lumped() {
    let urdf = read(ARM);
    let (robot, upper) = (urdf.robot(), &urdf.robot().description().joints[0]);
    assert_eq!(upper.mass, 2.5);
    // The bracket's joint is at (0.3, 0, 0), rotated about x by 1 rad; its centre of mass is 0.1 m
    // along y.
    let bracket = [0.3, 0.1 * 1f64.cos(), 0.1 * 1f64.sin()];
    let com = upper.com.unwrap();
    let expected: Vec<f64> =
        (0..3).map(|i| (2.0 * [0.1, 0.2, 0.3][i] + 0.5 * bracket[i]) / 2.5).collect();
    assert_close(&com, &expected, "com");
    let trace: f64 = [0, 3, 5].map(|k| upper.inertia[k]).iter().sum();
    let parallel: f64 =
        (0..3).map(|i| ([0.1, 0.2, 0.3][i] - bracket[i]).powi(2)).sum::<f64>() * (2.0 * 0.5 / 2.5);
    assert!((trace - (1.2 + 0.05 + 2.0 * parallel)).abs() < 1e-14);
    // The elbow is 0.4 m along the bracket's z. The mount on the base does not move.
    let at = &robot.link_placements(&[0.0, 0.0]);
    let elbow = at[0].rotation.transpose() * (at[1].translation - at[0].translation);
    assert_close(elbow.as_slice(), &[0.3, -0.4 * 1f64.sin(), 0.4 * 1f64.cos()], "elbow");
    assert_eq!(robot.joints()[1].armature, 0.25);
    assert_eq!(robot.joints()[0].position_limits, [-1.0, 2.0]);
    let potential = |q: &[f64]| robot.potential_energy(q);
    assert!((potential(&[0.0, 0.0]) - 9.81 * 3.5 * centre_height(robot)).abs() < 1e-12);
}

fn centre_height(robot: &Robot) -> f64 {
    let at = robot.link_placements(&[0.0, 0.0]);
    let heights = at.iter().zip(&robot.description().joints).map(|(at, joint)| {
        joint.mass * (at.rotation * nalgebra::Vector3::from(joint.com.unwrap()) + at.translation).z
    });
    heights.sum::<f64>() / 3.5
}

#[test]
fn a_base_may_be_named_and_keeps_the_direction_of_gravity() {
    let ends = |base: &str, tip: &str| UrdfOptions {
        base: Some(base.into()),
        tip: Some(tip.into()),
        ..UrdfOptions::default()
    };
    let whole = read(ARM);
    let from_mount = Urdf::parse(ARM, "arm.urdf", &ends("mount", "tool")).unwrap();
    let (q, qd, qdd) = ([0.3, -0.4], [0.5, 0.6], [0.7, 0.8]);
    let torque = |u: &Urdf| u.robot().inverse_dynamics(&q, &qd, &qdd);
    assert_close(torque(&from_mount).as_slice(), torque(&whole).as_slice(), "torque");
    assert!(from_mount.robot().gravity_acceleration()[0].abs() > 1.0);
    let elsewhere = Urdf::parse(ARM, "arm.urdf", &ends("tool", "upper")).unwrap_err().to_string();
    assert!(elsewhere.contains("base `tool` does not carry tip `upper`"), "{elsewhere}");
    let unknown = Urdf::parse(ARM, "arm.urdf", &ends("base", "hand")).unwrap_err().to_string();
    assert!(
        unknown.contains("no link `hand` for the tip; name one of `base`, `bracket`, `lower`"),
        "{unknown}"
    );
    let short = Urdf::parse(ARM, "arm.urdf", &ends("base", "mount")).unwrap_err().to_string();
    assert!(short.contains("no moving joint between base `base` and tip `mount`"), "{short}");
}

#[test]
fn text_that_does_not_change_is_kept_byte_for_byte() {
    let urdf = read(ARM);
    assert_eq!(urdf.updated(urdf.robot()).unwrap(), ARM);
    let parameters = [ParameterKind::Mass, ParameterKind::Viscous1, ParameterKind::Coulomb]
        .map(|kind| Parameter { joint: 0, kind });
    let changed = urdf.robot().description().with_values(&parameters, &[2.6, 0.6, 0.25]).unwrap();
    let text = urdf.updated(&Robot::from_description(&changed).unwrap()).unwrap();
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let (old, new) = (lines(ARM), lines(&text));
    assert_eq!(old.len(), new.len());
    let differ: Vec<_> = (0..old.len()).filter(|i| old[*i] != new[*i]).map(|i| i + 1).collect();
    // These are the upper link's origin, mass and inertia, the shoulder's dynamics, and the
    // bracket, whose mass is now part of the upper link.
    assert_eq!(differ, [9, 10, 17, 19]);
    assert_eq!(new[16], "    <dynamics friction=\"0.25\" damping=\"0.6\"/>");
    let bracket = "<mass value=\"0\"/><origin xyz=\"0 0.1 0\"/>\
                   <inertia ixy=\"0\" ixz=\"0\" iyz=\"0\" ixx=\"0\" iyy=\"0\" izz=\"0\"/>";
    assert!(new[18].contains(bracket), "{}", new[18]);
}

/// Reading, writing and reading again give the same robot; the companion has motors and friction.
#[test]
fn round_trips() {
    let urdf = read(ARM);
    let kinds = [
        &ParameterKind::INERTIAL[..],
        &[ParameterKind::MotorInertia, ParameterKind::Viscous1, ParameterKind::Coulomb],
    ];
    let parameters = Parameter::of_joints(2, &kinds.concat());
    let values: Vec<_> =
        urdf.robot().parameter_values(&parameters).iter().map(|v| 1.1 * v + 1e-3).collect();
    let changed = Robot::from_description(
        &urdf.robot().description().with_values(&parameters, &values).unwrap(),
    )
    .unwrap();
    let (text, companion) = (urdf.updated(&changed).unwrap(), urdf.companion(&changed));
    let back = Urdf::parse_with(&text, "arm.urdf", &companion, &UrdfOptions::default()).unwrap();
    assert_close(&back.robot().parameter_values(&parameters), &values, "parameters");
    assert_eq!(back.robot().joints(), changed.joints());
    assert_eq!(back.updated(back.robot()).unwrap(), text);
    assert_eq!(
        Urdf::parse_with(&text, "", &companion, &UrdfOptions::default()).unwrap().robot(),
        back.robot()
    );
    let described = Robot::from_toml(&back.robot().description().to_toml(), "arm.toml").unwrap();
    assert_eq!(&described, back.robot());
    // A link without `<inertial>` gets one.
    assert!(text.contains("<link name=\"lower\">\n    <inertial>\n      <origin xyz="), "{text}");
    assert!(text.contains("<!-- kept as it is -->"));
}

#[test]
fn the_companion_gives_motors_and_ends_and_its_errors_name_the_joint() {
    let with = |toml: &str| Urdf::parse_with(ARM, "arm.urdf", toml, &UrdfOptions::default());
    let text = "tip = \"tool\"\ngravity = [0.0, 0.0, 0.0]\n\
                [[joint]]\nname = \"elbow\"\narmature = 0.7\n\
                friction = { viscous = [1.0, 0.0, 0.5] }\n";
    let robot = with(text).unwrap().into_robot();
    assert_eq!((robot.joints()[1].armature, robot.joints()[1].friction.viscous.v3), (0.7, 0.5));
    assert_eq!(robot.gravity_torque(&[0.3, 0.4]).amax(), 0.0);
    let error = with(&text.replace("elbow", "knee")).unwrap_err().to_string();
    assert!(
        error.contains(
            "joint `knee`: the chain has no joint with this name; name one of `shoulder`, `elbow`"
        ),
        "{error}"
    );
    let error = with(&text.replace("armature", "armatur")).unwrap_err().to_string();
    assert!(error.contains("line 5") && error.contains("`armatur`"), "{error}");
    // A TOML file with a schema_version is a robot of its own, not a companion.
    assert_eq!(with("schema_version = 1\nname = \"other\"").unwrap().robot(), read(ARM).robot());
}

#[test]
fn unsupported_joints_are_refused_by_name() {
    let kind = "<joint name=\"elbow\" type=\"continuous\">";
    for (name, verb) in [("floating", "is floating"), ("planar", "is planar")] {
        let error = error_with(kind, &kind.replace("continuous", name));
        assert!(
            error.starts_with(&format!(
                "arm.urdf:22: joint `elbow`: the joint {verb}; only revolute"
            )),
            "{error}"
        );
    }
    let error = error_with(kind, &format!("{kind}<mimic joint=\"shoulder\" multiplier=\"2\"/>"));
    assert!(
        error.starts_with("arm.urdf:22: joint `elbow`, <mimic>: the joint mimics `shoulder`"),
        "{error}"
    );
    let finger = "<link name=\"finger\"/><joint name=\"slide\" type=\"revolute\">\
                  <parent link=\"upper\"/><child link=\"finger\"/></joint>\n</robot>";
    let branched = ARM.replace("</robot>", finger);
    let error = error_of(&branched);
    assert!(
        error.contains("tip is ambiguous: `finger`, `lower` carry no other moving link"),
        "{error}"
    );
    let ends = UrdfOptions { tip: Some("tool".into()), ..Default::default() };
    let error = Urdf::parse(&branched, "arm.urdf", &ends).unwrap_err().to_string();
    assert!(
        error.starts_with(
            "arm.urdf:27: joint `slide`: the chain branches: this revolute joint is carried"
        ),
        "{error}"
    );
}

#[test]
fn errors_of_invalid_files_name_line_and_element() {
    let error = error_with("</robot>", "");
    assert!(error.starts_with("arm.urdf: the text is not well-formed XML: "), "{error}");
    assert!(error_of("pendulum\n").contains("not well-formed XML"));
    assert!(
        error_of("<sdf/>").contains("arm.urdf:1: <sdf>: the root element is <sdf>; give a URDF")
    );
    let error = error_with("<child link=\"upper\"/>", "<child link=\"uper\"/>");
    assert!(error.starts_with("arm.urdf:13: joint `shoulder`: there is no link `uper`"), "{error}");
    let error = error_with("<parent link=\"mount\"/>", "");
    assert!(
        error.starts_with("arm.urdf:13: joint `shoulder`: <parent> is missing; add it"),
        "{error}"
    );
    let error = error_with("<parent link=\"mount\"/>", "<parent link=\"tool\"/>");
    assert!(error.contains("carries itself; change the parents"), "{error}");
    let error = error_with("<mass value=\"2.0\" />", "<mass value=\"two\" />");
    assert!(
        error.starts_with(
            "arm.urdf:10: link `upper`, <mass>: value = \"two\" is not a finite number; write"
        ),
        "{error}"
    );
    let error = error_with("<mass value=\"2.0\" />", "<mass />");
    assert!(error.contains("link `upper`, <mass>: the attribute `value` is missing"), "{error}");
    let error = error_with("rpy=\"0 0 0.7\"", "rpy=\"0 0.7\"");
    assert!(
        error.starts_with("arm.urdf:14: joint `shoulder`, <origin>: rpy = \"0 0.7\" is not three"),
        "{error}"
    );
    let error = error_with("lower=\"-1\"", "lower=\"3\"");
    assert!(
        error.starts_with(
            "arm.urdf:16: joint `shoulder`, link `upper`: position_limits [3, 2] rad: the"
        ),
        "{error}"
    );
    let error = error_with("<mass value=\"2.0\" />", "<mass value=\"-2.0\" />");
    assert!(
        error.starts_with("arm.urdf:8: joint `shoulder`, link `upper`: mass = -1.5 kg is negative"),
        "{error}"
    );
    let error =
        error_with("<link name=\"lower\"/>", "<link name=\"lower\"/><link name=\"lower\"/>");
    assert!(error.starts_with("arm.urdf:21: link `lower`: the name occurs twice"), "{error}");
    let error =
        error_with("<link name=\"base\"/>", "<joint name=\"x\"><child link=\"upper\"/></joint>");
    assert!(error.contains("joint `x`: the attribute `type` is missing"), "{error}");
    // A robot without mass is read, but it is not physical.
    let weightless = ARM
        .replace(
            "<mass value=\"1\"/><inertia ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\"/>",
            "<mass value=\"0\"/><inertia/>",
        )
        .replace("<rotor_inertia value=\"1e-4\"/>", "");
    let error = read(&weightless).robot().check_physical().unwrap_err().to_string();
    assert!(error.contains("joint `elbow` has the articulated inertia"), "{error}");
}

/// Files without one of the lines, or cut at a byte, are either read or refused with an error. What
/// is read can be written.
#[test]
fn damaged_files_are_read_or_refused() {
    let lines: Vec<_> = ARM.lines().collect();
    let without = |k: usize| {
        lines
            .iter()
            .enumerate()
            .filter(|(i, _)| *i != k)
            .map(|(_, l)| *l)
            .collect::<Vec<_>>()
            .join("\n")
    };
    let cut = (0..ARM.len()).step_by(7).map(|k| ARM[..k].to_string());
    let mut read = 0;
    for text in (0..lines.len()).map(without).chain(cut) {
        let Ok(urdf) = Urdf::parse(&text, "arm.urdf", &UrdfOptions::default()) else { continue };
        let masses = Parameter::of_joints(urdf.robot().joint_count(), &[ParameterKind::Mass]);
        let changed =
            urdf.robot().description().with_values(&masses, &vec![3.0; masses.len()]).unwrap();
        let Ok(changed) = Robot::from_description(&changed) else { continue };
        let back =
            Urdf::parse(&urdf.updated(&changed).unwrap(), "arm.urdf", &UrdfOptions::default())
                .unwrap();
        assert_close(&back.robot().parameter_values(&masses), &vec![3.0; masses.len()], "masses");
        read += 1;
    }
    assert!(read >= 5, "{read}");
}
