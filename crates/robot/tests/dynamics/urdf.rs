//! URDF in and out: real files of the shared folder against the oracles, and the words for files
//! that are no robot.

use crate::close::assert_close;
use crate::shared::{description, numbers, oracle};
use reachtube_robot::{Column, ColumnKind, Robot, Urdf, UrdfEnds};

const SHARED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/");

const ARM: &str = r#"<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/>
  <link name="mount"><inertial><mass value="9"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
  <joint name="mounting" type="fixed"><parent link="base"/><child link="mount"/><origin xyz="0 0 1" rpy="0 0.5 0"/></joint>
  <!-- kept as it is -->
  <link name="upper">
    <inertial>
      <origin xyz="0.1 0.2 0.3" rpy="0.1 0.2 0.3"/>
      <mass value="2.0" /><inertia ixx="0.3" ixy="0.01" ixz="0" iyy="0.4" iyz="-0.02" izz="0.5"/>
    </inertial>
  </link>
  <joint name="shoulder" type="revolute">
    <origin xyz="0.1 0 0.2" rpy="0 0 0.7"/><parent link="mount"/><child link="upper"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="10" velocity="3"/>
    <dynamics damping="0.5"/>
  </joint>
  <link name="bracket"><inertial><mass value="0.5"/><origin xyz="0 0.1 0"/><inertia ixx="0.01" iyy="0.02" izz="0.02"/></inertial></link>
  <joint name="bolts" type="fixed"><parent link="upper"/><child link="bracket"/><origin xyz="0.3 0 0" rpy="1 0 0"/></joint>
  <link name="lower"/>
  <joint name="elbow" type="continuous"><parent link="bracket"/><child link="lower"/><origin xyz="0 0 0.4"/></joint>
  <link name="tool"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial></link>
  <joint name="flange" type="fixed"><parent link="lower"/><child link="tool"/><origin xyz="0 0.2 0"/></joint>
  <transmission name="t"><joint name="elbow"/><actuator name="m"><mechanicalReduction>50</mechanicalReduction>
    <rotor_inertia value="1e-4"/></actuator></transmission>
</robot>
"#;

fn read(text: &str) -> Urdf {
    Urdf::parse(text, "arm.urdf", &UrdfEnds::default()).unwrap()
}

fn error_of(text: &str) -> String {
    Urdf::parse(text, "arm.urdf", &UrdfEnds::default()).unwrap_err().to_string()
}

/// The error after one part of the arm is replaced.
fn error_with(part: &str, by: &str) -> String {
    assert!(ARM.contains(part), "{part}");
    error_of(&ARM.replacen(part, by, 1))
}

fn shared_urdf(path: &str) -> Option<Urdf> {
    let path = format!("{SHARED}{path}");
    if !std::path::Path::new(&path).exists() {
        eprintln!("skipped: the folder `shared` beside the repository lacks {path}");
        return None;
    }
    Some(Urdf::load(path, &UrdfEnds::default()).unwrap())
}

#[test]
fn oracles_urdfs_agree_with_pinocchio() {
    for name in ["ur5", "dh6"] {
        let (Some(urdf), Some(oracle)) =
            (shared_urdf(&format!("oracle/{name}.urdf")), oracle(&format!("oracle/{name}.json")))
        else {
            return;
        };
        let robot = urdf.robot();
        let armatures: Vec<_> =
            description(&oracle).joints.iter().map(|j| j.armature.unwrap()).collect();
        for state in oracle["states"].as_array().unwrap() {
            let [q, qd, mut qdd] = ["q", "qd", "qdd"].map(|key| numbers(&state[key]));
            let tau = robot.inverse_dynamics(&q, &qd, &qdd);
            // The armature is not in the URDF.
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
fn real_files_are_read_with_limits_friction_and_gears() {
    let (Some(ur10e), Some(acrobot)) =
        (shared_urdf("data/ur10e/ur10e.urdf"), shared_urdf("data/double_pendulum/acrobot.urdf"))
    else {
        return;
    };
    let joints = ur10e.robot().joints();
    assert_eq!(joints.len(), 6);
    // Eleven digits of pi and two of 2 pi, as they stand in the file.
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
    // The second link's frame is upside down there: hanging, as in the embedded description, is q =
    // 0 for both.
    let described =
        Robot::load(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/double_pendulum.toml")).unwrap();
    let loaded = Robot::load(&format!("{SHARED}data/double_pendulum/acrobot.urdf")).unwrap();
    let (a, b) = (loaded.gravity_torque(&[0.3, 0.0]), described.gravity_torque(&[0.3, 0.0]));
    assert!((a - b).amax() < 1e-4);
}

/// Everything rigid, moved by hand: what is fixed to a link counts as part of it.
#[test]
fn fixed_links_are_lumped() {
    let urdf = read(ARM);
    let (robot, upper) = (urdf.robot(), &urdf.robot().description().joints[0]);
    assert_eq!(urdf.moved_links().collect::<Vec<_>>(), ["upper", "lower"]);
    assert_eq!(upper.mass, 2.5);
    // The bracket's centre of mass: its joint at (0.3, 0, 0), turned about x by 1, and 0.1 along y.
    let bracket = [0.3, 0.1 * 1f64.cos(), 0.1 * 1f64.sin()];
    let com = upper.com.unwrap();
    let expected: Vec<f64> =
        (0..3).map(|i| (2.0 * [0.1, 0.2, 0.3][i] + 0.5 * bracket[i]) / 2.5).collect();
    assert_close(&com, &expected, "com");
    let trace: f64 = [0, 3, 5].map(|k| upper.inertia[k]).iter().sum();
    let parallel: f64 =
        (0..3).map(|i| ([0.1, 0.2, 0.3][i] - bracket[i]).powi(2)).sum::<f64>() * (2.0 * 0.5 / 2.5);
    assert!((trace - (1.2 + 0.05 + 2.0 * parallel)).abs() < 1e-14);
    // The elbow: 0.4 along the bracket's turned z. The base's mount does not move.
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
    let ends = |base: &str, tip: &str| UrdfEnds { base: Some(base.into()), tip: Some(tip.into()) };
    let whole = read(ARM);
    let from_mount = Urdf::parse(ARM, "arm.urdf", &ends("mount", "tool")).unwrap();
    let (q, qd, qdd) = ([0.3, -0.4], [0.5, 0.6], [0.7, 0.8]);
    let torque = |u: &Urdf| u.robot().inverse_dynamics(&q, &qd, &qdd);
    assert_close(torque(&from_mount).as_slice(), torque(&whole).as_slice(), "torque");
    assert!(from_mount.robot().gravity_acceleration()[0].abs() > 1.0);
    let elsewhere = Urdf::parse(ARM, "arm.urdf", &ends("tool", "upper")).unwrap_err().to_string();
    assert!(elsewhere.contains("tip `upper` does not hang on base `tool`"), "{elsewhere}");
    let unknown = Urdf::parse(ARM, "arm.urdf", &ends("base", "hand")).unwrap_err().to_string();
    assert!(
        unknown.contains("no link `hand` for the tip; name one of `base`, `bracket`, `lower`"),
        "{unknown}"
    );
    let short = Urdf::parse(ARM, "arm.urdf", &ends("base", "mount")).unwrap_err().to_string();
    assert!(short.contains("no joint moves between base `base` and tip `mount`"), "{short}");
}

#[test]
fn what_is_not_identified_stays_byte_for_byte() {
    let urdf = read(ARM);
    assert_eq!(urdf.updated(urdf.robot()).unwrap(), ARM);
    let columns = [ColumnKind::Mass, ColumnKind::Viscous1, ColumnKind::Coulomb]
        .map(|kind| Column { joint: 0, kind });
    let changed = urdf.robot().description().with_values(&columns, &[2.6, 0.6, 0.25]).unwrap();
    let text = urdf.updated(&Robot::from_description(&changed).unwrap()).unwrap();
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let (old, new) = (lines(ARM), lines(&text));
    assert_eq!(old.len(), new.len());
    let differ: Vec<_> = (0..old.len()).filter(|i| old[*i] != new[*i]).map(|i| i + 1).collect();
    // The upper link's origin, mass and inertia; the shoulder's dynamics; the bracket, which is in
    // the whole now.
    assert_eq!(differ, [9, 10, 17, 19]);
    assert_eq!(new[16], "    <dynamics friction=\"0.25\" damping=\"0.6\"/>");
    let bracket = "<mass value=\"0\"/><origin xyz=\"0 0.1 0\"/><inertia ixy=\"0\" ixz=\"0\" iyz=\"0\" ixx=\"0\" iyy=\"0\" izz=\"0\"/>";
    assert!(new[18].contains(bracket), "{}", new[18]);
}

/// Reading, writing and reading again give the same robot, motors and friction through the
/// companion.
#[test]
fn round_trips() {
    let urdf = read(ARM);
    let kinds = [
        &ColumnKind::INERTIAL[..],
        &[ColumnKind::MotorInertia, ColumnKind::Viscous1, ColumnKind::Coulomb],
    ];
    let columns = Column::of_joints(2, &kinds.concat());
    let values: Vec<_> =
        urdf.robot().column_values(&columns).iter().map(|v| 1.1 * v + 1e-3).collect();
    let changed = Robot::from_description(
        &urdf.robot().description().with_values(&columns, &values).unwrap(),
    )
    .unwrap();
    let (text, companion) = (urdf.updated(&changed).unwrap(), urdf.companion(&changed));
    let back = Urdf::parse_with(&text, "arm.urdf", &companion, &UrdfEnds::default()).unwrap();
    assert_close(&back.robot().column_values(&columns), &values, "parameters");
    assert_eq!(back.robot().joints(), changed.joints());
    assert_eq!(back.updated(back.robot()).unwrap(), text);
    assert_eq!(
        Urdf::parse_with(&text, "", &companion, &UrdfEnds::default()).unwrap().robot(),
        back.robot()
    );
    let described = Robot::from_toml(&back.robot().description().to_toml(), "arm.toml").unwrap();
    assert_eq!(&described, back.robot());
    // A link without `<inertial>` gets one.
    assert!(text.contains("<link name=\"lower\">\n    <inertial>\n      <origin xyz="), "{text}");
    assert!(text.contains("<!-- kept as it is -->"));
}

#[test]
fn the_companion_names_motors_ends_and_its_mistakes() {
    let with = |toml: &str| Urdf::parse_with(ARM, "arm.urdf", toml, &UrdfEnds::default());
    let text = "tip = \"tool\"\ngravity = [0.0, 0.0, 0.0]\n[[joint]]\nname = \"elbow\"\narmature = 0.7\n\
                friction = { viscous = [1.0, 0.0, 0.5] }\n";
    let robot = with(text).unwrap().into_robot();
    assert_eq!((robot.joints()[1].armature, robot.joints()[1].friction.viscous.v3), (0.7, 0.5));
    assert_eq!(robot.gravity_torque(&[0.3, 0.4]).amax(), 0.0);
    let error = with(&text.replace("elbow", "knee")).unwrap_err().to_string();
    assert!(
        error
            .contains("joint `knee`: the chain has no such joint; name one of `shoulder`, `elbow`"),
        "{error}"
    );
    let error = with(&text.replace("armature", "armatur")).unwrap_err().to_string();
    assert!(error.contains("line 5") && error.contains("`armatur`"), "{error}");
    // A whole robot beside the URDF is not meant for it.
    assert_eq!(with("schema_version = 1\nname = \"other\"").unwrap().robot(), read(ARM).robot());
}

#[test]
fn joints_that_are_not_handled_are_refused_by_name() {
    let kind = "<joint name=\"elbow\" type=\"continuous\">";
    for (name, verb) in
        [("prismatic", "is prismatic"), ("floating", "is floating"), ("planar", "is planar")]
    {
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
    let finger = "<link name=\"finger\"/><joint name=\"slide\" type=\"revolute\"><parent link=\"upper\"/>\
                  <child link=\"finger\"/></joint>\n</robot>";
    let branched = ARM.replace("</robot>", finger);
    let error = error_of(&branched);
    assert!(
        error.contains("tip is not clear: `finger`, `lower` each are a link that moves"),
        "{error}"
    );
    let ends = UrdfEnds { base: None, tip: Some("tool".into()) };
    let error = Urdf::parse(&branched, "arm.urdf", &ends).unwrap_err().to_string();
    assert!(
        error.starts_with(
            "arm.urdf:27: joint `slide`: the chain branches: this revolute joint hangs"
        ),
        "{error}"
    );
}

#[test]
fn broken_files_are_answered_with_line_and_element() {
    let error = error_with("</robot>", "");
    assert!(error.starts_with("arm.urdf: no well-formed XML: "), "{error}");
    assert!(error_of("pendulum\n").contains("no well-formed XML"));
    assert!(
        error_of("<sdf/>").contains("arm.urdf:1: <sdf>: the root element is <sdf>; give a URDF")
    );
    let error = error_with("<child link=\"upper\"/>", "<child link=\"uper\"/>");
    assert!(error.starts_with("arm.urdf:13: joint `shoulder`: there is no link `uper`"), "{error}");
    let error = error_with("<parent link=\"mount\"/>", "");
    assert!(
        error.starts_with("arm.urdf:13: joint `shoulder`: <parent> is lacking; add it"),
        "{error}"
    );
    let error = error_with("<parent link=\"mount\"/>", "<parent link=\"tool\"/>");
    assert!(error.contains("hangs on itself; let the joints form a tree"), "{error}");
    let error = error_with("<mass value=\"2.0\" />", "<mass value=\"two\" />");
    assert!(
        error.starts_with("arm.urdf:10: link `upper`, <mass>: value = \"two\" is no number; write"),
        "{error}"
    );
    let error = error_with("<mass value=\"2.0\" />", "<mass />");
    assert!(error.contains("link `upper`, <mass>: the attribute `value` is lacking"), "{error}");
    let error = error_with("rpy=\"0 0 0.7\"", "rpy=\"0 0.7\"");
    assert!(
        error.starts_with("arm.urdf:14: joint `shoulder`, <origin>: rpy = \"0 0.7\" are not three"),
        "{error}"
    );
    let error = error_with("lower=\"-1\"", "lower=\"3\"");
    assert!(
        error.starts_with(
            "arm.urdf:16: joint `shoulder`, link `upper`: position_limits [3, 2] hold"
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
    assert!(error.contains("joint `x`: the attribute `type` is lacking"), "{error}");
    // Without any mass the robot is read, and refused as none that moves.
    let weightless = ARM
        .replace(
            "<mass value=\"1\"/><inertia ixx=\"0.01\" iyy=\"0.01\" izz=\"0.01\"/>",
            "<mass value=\"0\"/><inertia/>",
        )
        .replace("<rotor_inertia value=\"1e-4\"/>", "");
    let error = read(&weightless).robot().check_physical().unwrap_err().to_string();
    assert!(error.contains("joint `elbow` has the articulated inertia"), "{error}");
}

/// A file that lost a line, or everything after some byte, is read or answered; what is read can be
/// written.
#[test]
fn damaged_files_are_read_or_answered() {
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
        let Ok(urdf) = Urdf::parse(&text, "arm.urdf", &UrdfEnds::default()) else { continue };
        let masses = Column::of_joints(urdf.robot().joint_count(), &[ColumnKind::Mass]);
        let changed =
            urdf.robot().description().with_values(&masses, &vec![3.0; masses.len()]).unwrap();
        let Ok(changed) = Robot::from_description(&changed) else { continue };
        let back = Urdf::parse(&urdf.updated(&changed).unwrap(), "arm.urdf", &UrdfEnds::default())
            .unwrap();
        assert_close(&back.robot().column_values(&masses), &vec![3.0; masses.len()], "masses");
        read += 1;
    }
    assert!(read >= 5, "{read}");
}
