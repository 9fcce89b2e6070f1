//! `--lock` on every command that takes a robot.

use crate::fixture::Lab;

/// A pendulum arm with a two-finger gripper, as in the URDFs of makers.
const URDF: &str = r#"<robot name="arm">
  <link name="base"/>
  <link name="arm"><inertial><origin xyz="0 0 -0.3"/><mass value="2"/>
    <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.01"/></inertial></link>
  <joint name="hinge" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" velocity="5" effort="50"/></joint>
  <link name="left"><inertial><mass value="0.1"/>
    <inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial></link>
  <joint name="finger1" type="prismatic"><parent link="arm"/><child link="left"/>
    <origin xyz="0 0 -0.6"/><axis xyz="1 0 0"/><limit lower="0" upper="0.04" velocity="1"/></joint>
  <link name="right"><inertial><mass value="0.1"/>
    <inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-4"/></inertial></link>
  <joint name="finger2" type="prismatic"><parent link="arm"/><child link="right"/>
    <origin xyz="0 0 -0.6"/><axis xyz="-1 0 0"/><limit lower="0" upper="0.04" velocity="1"/>
    <mimic joint="finger1"/></joint>
</robot>
"#;

fn lab() -> Lab {
    let lab = Lab::new();
    lab.write("arm.urdf", URDF);
    let mut text = String::from("t,q1,qd1,tau1\n");
    for k in 0..2000 {
        let t = 0.005 * f64::from(k);
        let (q, qd, qdd) = (0.8 * (2.0 * t).sin(), 1.6 * (2.0 * t).cos(), -3.2 * (2.0 * t).sin());
        let tau = 0.3 * qdd + 0.8 * qd + 7.0 * q.sin();
        text += &format!("{t:.3},{q:.9},{qd:.9},{tau:.9}\n");
    }
    lab.write("a.csv", text);
    lab
}

#[test]
fn every_command_refuses_the_branch_and_takes_the_lock() {
    let lab = lab();
    let commands = [
        "robot show arm.urdf",
        "abstract --robot arm.urdf",
        "excite --robot arm.urdf --out motion.csv",
        "prepare --robot arm.urdf --data a.csv --out runs",
        "conform --robot arm.urdf --data runs --torque motor --out model.json",
        "inspect --robot arm.urdf --data runs",
        "identify --robot arm.urdf --excitation a.csv --cut-off 15 --urdf new.urdf",
    ];
    for command in commands {
        if command.starts_with("robot") || command.starts_with("abstract") {
            lab.run(command).fails_with(&[
                "arm.urdf:1: <robot>: the robot branches, and the tip is ambiguous",
                "`left`, `right` carry",
                "for example --lock finger1=0;",
            ]);
        }
        let run = lab.run(&format!("{command} --lock finger1=0.03"));
        // The torques are no torques, so that the sets are too wide to be of use.
        let is_verdict = command.starts_with("conform") && [1, 3].contains(&run.code);
        assert!(run.code == 0 || is_verdict, "{run:#?}");
    }
    let nothing = lab.run("robot show arm.urdf --lock finger1").exits(2).stderr;
    assert!(nothing.contains("locks no joint; give JOINT=VALUE"), "{nothing}");
}

#[test]
fn files_keep_what_was_locked() {
    let lab = lab();
    let text = lab.run("robot show arm.urdf --lock finger1=0.03").exits(0).stdout;
    assert!(text.contains("locked: finger1 = 0.03 m, finger2 = 0.03 m\n"), "{text}");
    lab.run("abstract --robot arm.urdf --lock finger1=0.03 --out model1.json").exits(0);
    let model: serde_json::Value = serde_json::from_str(&lab.read("model1.json")).unwrap();
    let locked = model["robot"]["locked"].as_array().unwrap();
    assert_eq!(locked.len(), 2);
    assert_eq!((&locked[1]["name"], &locked[1]["position"]), (&"finger2".into(), &0.03.into()));
    // The written URDF has the hand's inertia in the arm, and its companion has the lock.
    let job = "identify --robot arm.urdf --lock finger1=0.03 --excitation a.csv --cut-off 15";
    lab.run(&format!("{job} --urdf new.urdf --out found.toml")).exits(0);
    assert!(lab.read("new.toml").contains("[lock]\nfinger1 = 0.03\n"), "{}", lab.read("new.toml"));
    let shown = |robot: &str| lab.run(&format!("robot show {robot} --json")).exits(0).json();
    let (new, found) = (shown("new.urdf"), shown("found.toml"));
    let (new, found) = (&new["mass_matrix"][0][0], &found["mass_matrix"][0][0]);
    assert!((new.as_f64().unwrap() - found.as_f64().unwrap()).abs() < 1e-9, "{new} {found}");
}
