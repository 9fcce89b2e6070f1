//! Descriptions of robots, accepted and refused.

use crate::fixture::{Lab, robot_toml};

#[track_caller]
fn refused(from: &str, to: &str, parts: &[&str]) {
    let lab = Lab::new();
    assert!(robot_toml().contains(from));
    lab.write("arm.toml", robot_toml().replacen(from, to, 1));
    lab.run("robot show arm.toml").fails_with(parts);
    lab.conform("").fails_with(parts);
}

#[test]
fn a_robot_is_shown() {
    let lab = Lab::new();
    let text = lab.run("robot show arm.toml --expansion 0.1,-0.2").exits(0).stdout;
    for part in
        ["two axes: 2 revolute joints", "axis1", "q_a = [0.1, -0.2] rad", "1.00000", "0.50000"]
    {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    lab.run("robot show arm.toml --expansion 1,2,3")
        .fails_with(&["--expansion lists 3", "give 2 positions in rad"]);
    lab.run("robot show lwa4p").exits(0);
}

#[test]
fn defects_are_found_with_line_and_joint() {
    refused(
        "armature = 0.5",
        "armature = -0.5",
        &["arm.toml:15: joint `axis2`: armature = -0.5 is negative", "at least 0"],
    );
    refused(
        "armature = 0.5",
        "armatur = 0.5",
        &["arm.toml: TOML parse error at line 15", "unknown field `armatur`"],
    );
    refused("schema_version = 1\n", "", &["missing field `schema_version`", "docs/robot.md"]);
    refused("axis2", "axis1", &["arm.toml:13: joint `axis1`: the name occurs twice"]);
}

#[test]
fn friction_that_drives_is_a_warning() {
    let lab = Lab::new();
    for robot in ["arm.toml", "lwa4p"] {
        assert_eq!(lab.run(&format!("robot show {robot}")).exits(0).stderr, "");
    }
    lab.write("arm.toml", robot_toml().replace("viscous = [1,", "viscous = [-1,"));
    let driven = lab.run("robot show arm.toml").exits(0).stderr;
    let text = "warning: joint `axis2`: friction drives it without load at 3 rad/s";
    assert!(driven.starts_with(text), "{driven}");
}

#[test]
fn positions_beyond_the_limits_are_refused_or_a_warning() {
    let lab = Lab::new();
    lab.run("robot show lwa4p --lock joint1=5").fails_with(&["joint1", "at 5 rad", "limits"]);
    for command in ["abstract --robot lwa4p", "robot show lwa4p"] {
        let run = lab.run(&format!("{command} --expansion 0,0,0,0,0,9")).exits(0);
        let text = "warning: joint `joint6`: --expansion has it at 9 rad, but its limits are";
        assert!(run.stderr.contains(text), "{}", run.stderr);
        assert_eq!(lab.run(&format!("{command} --expansion 0,1,0,0,0,3")).exits(0).stderr, "");
    }
}

#[test]
fn a_singular_model_is_refused() {
    refused(
        "armature = 0.5",
        "armature = 0.0",
        &["joint `axis2`", "positive", "correct its inertial parameters"],
    );
}

#[test]
fn a_robot_that_is_not_there() {
    let lab = Lab::new();
    lab.run("robot show missing").fails_with(&[
        "cannot read robot `missing`",
        "TOML or URDF file or an embedded name (lwa4p)",
    ]);
    lab.run("conform --robot data --data data --torque motor")
        .fails_with(&["cannot read robot `data`"]);
}
