//! Locked joints and joints that mimic them: URDFs with grippers, and TOML robots.

use crate::close::assert_close;
use reachtube_robot::{JointKind, Lock, LockedJoint, Robot, Urdf, UrdfOptions};

const HAND: &str = include_str!("hand.urdf");

/// The knuckle of a two-finger gripper with an opposite finger that turns backward, half a radian
/// further, and a fingertip that mimics the opposite finger. It replaces the fingers of `HAND`.
const KNUCKLES: &str = r#"
  <link name="finger"><inertial><origin xyz="0 0 0.05"/><mass value="0.2"/>
    <inertia ixx="2e-4" ixy="0" ixz="0" iyy="2e-4" iyz="0" izz="1e-5"/></inertial></link>
  <joint name="knuckle" type="revolute"><parent link="hand"/><child link="finger"/>
    <origin xyz="0 0.03 0.05"/><axis xyz="2 0 0"/><limit lower="0" upper="0.8"/></joint>
  <link name="opposite"><inertial><origin xyz="0 0 0.05"/><mass value="0.2"/>
    <inertia ixx="2e-4" ixy="0" ixz="0" iyy="2e-4" iyz="0" izz="1e-5"/></inertial></link>
  <joint name="opposite_knuckle" type="revolute"><parent link="hand"/><child link="opposite"/>
    <origin xyz="0 -0.03 0.05"/><axis xyz="1 0 0"/><limit lower="-1" upper="1"/>
    <mimic joint="knuckle" multiplier="-1" offset="0.5"/></joint>
  <link name="tip"><inertial><origin xyz="0 0 0.01"/><mass value="0.05"/>
    <inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial></link>
  <joint name="tip_joint" type="continuous"><parent link="opposite"/><child link="tip"/>
    <origin xyz="0 0 0.1"/><axis xyz="1 0 0"/>
    <mimic joint="opposite_knuckle" multiplier="2"/></joint>
</robot>"#;

fn locked(text: &str, locks: &[&str]) -> Result<Urdf, String> {
    let locks = locks.iter().map(|lock| lock.parse().unwrap()).collect();
    Urdf::parse(text, "hand.urdf", &UrdfOptions { locks, ..Default::default() })
        .map_err(|error| error.to_string())
}

fn error(text: &str, locks: &[&str]) -> String {
    locked(text, locks).unwrap_err()
}

/// Returns `HAND` with `with` in place of the fingers.
fn with_fingers(with: &str) -> String {
    let fingers = HAND.find("  <link name=\"left\">").unwrap();
    format!("{}{with}", &HAND[..fingers])
}

/// Asserts that two robots move alike.
fn same_dynamics(found: &Robot, expected: &Robot) {
    let (q, qd, qdd) = ([0.4, 0.3], [0.5, -0.2], [1.0, 2.0]);
    assert_close(
        found.inverse_dynamics(&q, &qd, &qdd).as_slice(),
        expected.inverse_dynamics(&q, &qd, &qdd).as_slice(),
        "rnea",
    );
    assert_close(
        found.mass_matrix(&q).as_slice(),
        expected.mass_matrix(&q).as_slice(),
        "mass matrix",
    );
}

#[test]
fn a_hand_is_lumped_where_its_fingers_are_locked() {
    let urdf = locked(HAND, &["finger1=0.03"]).unwrap();
    let robot = urdf.robot();
    assert_eq!(robot.kinds(), [JointKind::Revolute, JointKind::Prismatic]);
    assert_eq!(robot.joints()[1].position_limits, [0.1, 0.5]);
    assert_eq!(robot.joints()[1].velocity_limit, Some(0.8));
    let at =
        |name: &str| LockedJoint { name: name.into(), kind: JointKind::Prismatic, position: 0.03 };
    assert_eq!(robot.description().locked, [at("finger1"), at("finger2")]);
    // The same hand with its fingers welded where they are locked.
    let welded = HAND
        .replace("name=\"finger1\" type=\"prismatic\"", "name=\"finger1\" type=\"fixed\"")
        .replace("name=\"finger2\" type=\"prismatic\"", "name=\"finger2\" type=\"fixed\"")
        .replace("<origin xyz=\"0 0 0.06\"/>", "<origin xyz=\"0 0.03 0.06\"/>")
        .replace("<origin xyz=\"0 0 0.06\" rpy", "<origin xyz=\"0 -0.03 0.06\" rpy")
        .replace("<mimic joint=\"finger1\"/>", "");
    same_dynamics(robot, locked(&welded, &[]).unwrap().robot());
    // The fingers' inertia about the hand depends on how far they are open.
    let closed = locked(HAND, &["finger1=0"]).unwrap();
    let inertia = |robot: &Robot| robot.description().joints[1].inertia[0];
    let opened = 2.0 * 0.1 * ((0.01f64 + 0.03).powi(2) - 0.01f64.powi(2));
    // The hand is turned by 45°: cos² is one half.
    let along_y = opened * 0.5;
    assert!((inertia(robot) - inertia(closed.robot()) - along_y).abs() < 1e-9);
    // A copy as TOML keeps what was locked.
    let copy = Robot::from_toml(&robot.description().to_toml(), "copy").unwrap();
    assert_eq!(&copy, robot);
}

#[test]
fn mimics_follow_with_multiplier_and_offset_through_other_mimics() {
    let text = with_fingers(KNUCKLES);
    let robot = locked(&text, &["knuckle=0.3"]).unwrap().into_robot();
    let positions: Vec<_> =
        robot.description().locked.iter().map(|l| (l.name.as_str(), l.position)).collect();
    let expected = [("knuckle", 0.3), ("opposite_knuckle", 0.2), ("tip_joint", 0.4)];
    assert_eq!(positions, expected);
    let weld = |text: &str, joint: &str, kind: &str, angle: f64| {
        let from = text.find(&format!("name=\"{joint}\" type=\"{kind}\"")).unwrap();
        let (before, rest) = text.split_at(from);
        let rest = rest.replacen(&format!("type=\"{kind}\""), "type=\"fixed\"", 1);
        let rest = rest.replacen("\"/><axis", &format!("\" rpy=\"{angle} 0 0\"/><axis"), 1);
        format!("{before}{rest}")
    };
    let welded = weld(&text, "knuckle", "revolute", 0.3);
    let welded = weld(&welded, "opposite_knuckle", "revolute", 0.2);
    let welded = weld(&welded, "tip_joint", "continuous", 0.4);
    same_dynamics(&robot, locked(&welded, &[]).unwrap().robot());
}

#[test]
fn a_branch_is_refused_with_the_locks_that_mend_it() {
    let ambiguous = error(HAND, &[]);
    assert!(
        ambiguous.contains(
            "the robot branches, and the tip is ambiguous: `left`, `right` carry no other moving \
             link; lock the joints of all branches but one, for example --lock finger1=0;"
        ),
        "{ambiguous}"
    );
    let knuckles = with_fingers(KNUCKLES);
    assert!(error(&knuckles, &[]).contains("for example --lock knuckle=0;"));
    // The tip is chosen, but the other finger still moves.
    let options = UrdfOptions { tip: Some("hand".into()), ..Default::default() };
    let branch = Urdf::parse(HAND, "hand.urdf", &options).unwrap_err().to_string();
    assert!(
        branch.starts_with("hand.urdf:24: joint `finger1`: the chain branches: this prismatic")
            && branch.ends_with("lock the joints of the branches: --lock finger1=0"),
        "{branch}"
    );
    let finger = UrdfOptions { tip: Some("left".into()), ..Default::default() };
    let follower = Urdf::parse(HAND, "hand.urdf", &finger).unwrap_err().to_string();
    assert!(
        follower.starts_with("hand.urdf:28: joint `finger2`: the chain branches")
            && follower.contains("it mimics `finger1` of the chain")
            && follower.contains("lock `finger1`"),
        "{follower}"
    );
    // The longer branch is kept, and a limit that is nearest to 0 is proposed.
    let camera = "<link name=\"camera\"/><joint name=\"pan\" type=\"revolute\">\
                  <parent link=\"upper\"/><child link=\"camera\"/>\
                  <limit lower=\"0.2\" upper=\"1\"/></joint>\n\
                  <link name=\"wrist\"/><joint name=\"turn\" type=\"continuous\">\
                  <parent link=\"hand\"/><child link=\"wrist\"/></joint>\n</robot>";
    let text = with_fingers(camera);
    assert!(error(&text, &[]).contains("`camera`, `wrist` carry"), "{}", error(&text, &[]));
    assert!(error(&text, &[]).contains("for example --lock pan=0.2;"), "{}", error(&text, &[]));
    assert_eq!(locked(&text, &["pan=0.2"]).unwrap().robot().joint_count(), 3);
}

#[test]
fn each_proposed_lock_mends_the_file() {
    for text in [HAND.to_string(), with_fingers(KNUCKLES)] {
        let error = error(&text, &[]);
        let options = error.split("--lock ").skip(1);
        let locks: Vec<_> = options.map(|o| o.split([' ', ';']).next().unwrap()).collect();
        assert_eq!(locked(&text, &locks).unwrap().robot().joint_count(), 2, "{error}");
    }
}

#[test]
fn locks_that_make_no_sense_are_refused() {
    let cases = [
        (
            "finger=0",
            "there is no joint `finger` to lock; lock one of `shoulder`, `lift`, `finger1`",
        ),
        ("finger2=0", "joint `finger2`: the joint mimics `finger1` and cannot be locked by itself"),
        ("flange=0", "joint `flange`: the joint is fixed and cannot be locked"),
        ("finger1=4", "it is locked at 4 m, but its limits are 0 and 0.04 m; give a position"),
    ];
    for (lock, part) in cases {
        assert!(error(HAND, &[lock]).contains(part), "{}", error(HAND, &[lock]));
    }
    assert!(error(HAND, &["finger1=0", "finger1=0"]).contains("locked twice"));
    assert!(error(HAND, &["shoulder=0", "lift=0.1", "finger1=0"]).contains("no moving link"));
    for text in ["finger1", "=3", "finger1=", "finger1=open", "finger1=nan"] {
        let error = text.parse::<Lock>().unwrap_err().to_string();
        assert!(error.contains("give JOINT=VALUE"), "{error}");
    }
}

#[test]
fn a_mimic_in_the_chain_is_refused_unless_its_leader_is_locked() {
    let mimic =
        "<axis xyz=\"0 0 1\"/>\n    <mimic joint=\"shoulder\" multiplier=\"0.1\" offset=\"0.2\"/>";
    let text = HAND.replace("<axis xyz=\"0 0 1\"/>", mimic);
    let refused = error(&text, &["finger1=0"]);
    assert!(
        refused.starts_with(
            "hand.urdf:16: joint `lift`, <mimic>: the joint mimics `shoulder`, which moves; "
        ) && refused.contains("lock `shoulder` with --lock"),
        "{refused}"
    );
    let without = error(&text, &["finger1=0", "shoulder=1"]);
    assert!(without.contains("no moving link"), "{without}");
}

/// Locks within the chain and below its base, and locks of a companion, which the command line
/// overrides.
#[test]
fn locks_hold_anywhere_in_the_tree() {
    let slide = locked(HAND, &["finger1=0.01", "shoulder=0.5"]).unwrap();
    assert_eq!(slide.robot().kinds(), [JointKind::Prismatic]);
    let expected = 9.81 * (1.2 + 0.7 + 0.2) * 0.5f64.cos();
    assert!((slide.robot().gravity_torque(&[0.3])[0] - expected).abs() < 1e-12);
    let base = UrdfOptions {
        base: Some("upper".into()),
        locks: vec!["finger1=0.01".parse().unwrap(), "shoulder=0.5".parse().unwrap()],
        ..UrdfOptions::default()
    };
    let from_upper = Urdf::parse(HAND, "hand.urdf", &base).unwrap();
    assert!((from_upper.robot().gravity_torque(&[0.3])[0] - expected).abs() < 1e-12);

    let companion = "lock = { finger1 = 0.01, shoulder = 0.1 }\n";
    let shoulder = UrdfOptions { locks: vec!["shoulder=0.5".parse().unwrap()], ..base.clone() };
    let read = Urdf::parse_with(HAND, "hand.urdf", companion, &shoulder).unwrap();
    assert_eq!(read.robot(), from_upper.robot());
    // What is written back loads without another lock.
    let text = read.updated(read.robot()).unwrap();
    let again = read.companion(read.robot());
    let back = Urdf::parse_with(&text, "hand.urdf", &again, &UrdfOptions::default()).unwrap();
    assert_eq!(back.robot(), read.robot());
}

#[test]
fn joints_of_a_toml_robot_are_locked() {
    let lwa4p = Robot::lwa4p();
    let locks = ["joint3=0.7", "joint6=-0.4"].map(|lock| lock.parse().unwrap());
    let locked = Robot::from_description(&lwa4p.description().with_locks(&locks).unwrap()).unwrap();
    assert_eq!(locked, Robot::load_locked("lwa4p", &locks).unwrap());
    // The torques of the free joints equal the torques of the whole robot while the locked joints
    // rest.
    let whole = |[a, b, c, d]: [f64; 4], third: f64, sixth: f64| [a, b, third, c, d, sixth];
    let free = |tau: &[f64]| [0, 1, 3, 4].map(|i| tau[i]);
    let (q, qd, qdd) = ([0.3, -0.5, 0.9, 1.2], [0.5, 0.6, -0.7, 0.3], [1.0, -2.0, 3.0, 0.5]);
    let expected =
        lwa4p.inverse_dynamics(&whole(q, 0.7, -0.4), &whole(qd, 0.0, 0.0), &whole(qdd, 0.0, 0.0));
    let found = locked.inverse_dynamics(&q, &qd, &qdd);
    assert_close(found.as_slice(), &free(expected.as_slice()), "rnea");
    let gravity = lwa4p.gravity_torque(&whole(q, 0.7, -0.4));
    assert_close(locked.gravity_torque(&q).as_slice(), &free(gravity.as_slice()), "gravity");
    let refused = |lock: &str| {
        lwa4p.description().with_locks(&[lock.parse().unwrap()]).unwrap_err().to_string()
    };
    assert!(refused("joint7=0").contains("joint `joint7`: the robot has no joint"));
    // A revolute joint has limits of half a turn if the description has none.
    assert!(refused("joint3=5").contains("it is locked at 5 rad, but its limits are -3.14"));
}
