//! Bad robots, models, abstractions and settings.

use super::{ABSTRACTION, CHECK, CONFORM, Case};
use crate::fixture::{Lab, robot_toml};

fn replace(lab: &Lab, file: &str, from: &str, to: &str) {
    let text = lab.read(file);
    assert!(text.contains(from), "{from} is not in {text}");
    lab.write(file, text.replacen(from, to, 1));
}

/// A URDF of one joint, whose type is `kind`.
fn urdf(kind: &str) -> String {
    format!(
        "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"><inertial><mass value=\"1\"/>\
         <inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>\
         <joint name=\"j\" type=\"{kind}\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>"
    )
}

const SHOW: &str = "robot show arm.urdf";

pub(super) const CASES: &[Case] = &[
    Case::refused(
        "no robot file",
        |_| (),
        "robot show none.toml",
        &["cannot read robot `none.toml`", "embedded name (lwa4p)"],
    ),
    Case::refused(
        "an unknown key of a robot",
        |lab| replace(lab, "arm.toml", "armature", "armatur"),
        CONFORM,
        &["arm.toml: TOML parse error at line", "unknown field `armatur`"],
    ),
    Case::refused(
        "a negative inertia",
        |lab| replace(lab, "arm.toml", "armature = 0.5", "armature = -0.5"),
        CONFORM,
        &["arm.toml:15: joint `axis2`: armature = -0.5 is negative"],
    ),
    Case::refused(
        "a robot without inertia",
        |lab| replace(lab, "arm.toml", "armature = 0.5", "armature = 0"),
        CONFORM,
        &["joint `axis2`", "correct its inertial parameters"],
    ),
    Case::refused(
        "one name for two joints",
        |lab| replace(lab, "arm.toml", "axis2", "axis1"),
        CONFORM,
        &["arm.toml:13: joint `axis1`: the name occurs twice"],
    ),
    Case::refused(
        "no joints",
        |lab| lab.write("arm.toml", "schema_version = 1\nname = \"a\"\njoint = []\n"),
        CONFORM,
        &["the robot has no joints"],
    ),
    Case::refused(
        "101 joints",
        |lab| {
            let joint = |i| {
                format!(
                    "[[joint]]\nname = \"j{i}\"\narmature = 1.0\n\
                     placement = {{ translation = [0.0, 0.0, 0.1] }}\n"
                )
            };
            let joints: String = (0..101).map(joint).collect();
            lab.write(
                "arm.toml",
                format!("schema_version = 1\nname = \"a\"\nparameters = \"base\"\n{joints}"),
            );
        },
        CONFORM,
        &["the robot has 101 joints, but at most 100 are supported"],
    ),
    Case::refused(
        "nested tables",
        |lab| lab.write("arm.toml", format!("a = {}", "[".repeat(100_000))),
        CONFORM,
        &["arm.toml: TOML parse error"],
    ),
    Case::refused(
        "a robot file without end",
        |_| (),
        "robot show /dev/zero",
        &["cannot read robot `/dev/zero`", "larger than 16 MiB"],
    ),
    Case::refused(
        "XML that is not well-formed",
        |lab| lab.write("arm.urdf", "<robot>"),
        SHOW,
        &["arm.urdf", "not well-formed XML"],
    ),
    Case::refused(
        "entities that grow",
        |lab| {
            lab.write(
                "arm.urdf",
                "<!DOCTYPE r [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;\">]>\
             <robot name=\"&b;\"/>",
            )
        },
        SHOW,
        &["arm.urdf", "not well-formed XML"],
    ),
    Case::refused(
        "nested elements",
        |lab| lab.write("arm.urdf", format!("<robot>{}", "<a>".repeat(100_000))),
        SHOW,
        &["arm.urdf", "not well-formed XML"],
    ),
    Case::refused(
        "no URDF",
        |lab| lab.write("arm.urdf", "<html/>"),
        SHOW,
        &["the root element is <html>", "give a URDF"],
    ),
    Case::refused(
        "a joint that floats",
        |lab| lab.write("arm.urdf", urdf("floating")),
        SHOW,
        &["arm.urdf", "floating"],
    ),
    Case::refused(
        "no model file",
        |_| (),
        "check --model none.json --data data --torque compensated",
        &["none.json: cannot read", "give a file that `model` or `conform` wrote"],
    ),
    Case::refused(
        "a model that is no JSON",
        |lab| lab.write("model.json", "t,q1\n"),
        CHECK,
        &["model.json: it is not JSON"],
    ),
    Case::refused(
        "nested JSON",
        |lab| lab.write("model.json", "[".repeat(100_000)),
        CHECK,
        &["model.json: it is not JSON", "recursion limit"],
    ),
    Case::refused(
        "a model of another version",
        |lab| replace(lab, "model.json", "\"version\": 4", "\"version\": 9"),
        CHECK,
        &["model.json: it has version 9", "run conform again"],
    ),
    Case::refused(
        "a changed model",
        |lab| replace(lab, "model.json", "\"verified\": true", "\"verified\": false"),
        CHECK,
        &["model.json: ", "verified does not agree with proof"],
    ),
    Case::refused(
        "an abstraction for a model",
        |lab| lab.write("model.json", lab.read("a.json")),
        CHECK,
        &["model.json: its format is not \"reachtube-model\""],
    ),
    Case::refused(
        "a model for an abstraction",
        |lab| lab.write("a.json", lab.read("model.json")),
        ABSTRACTION,
        &["a.json: its format is not \"reachtube-abstraction\""],
    ),
    Case::refused(
        "an abstraction of a huge order",
        |lab| replace(lab, "a.json", "\"order\": 1", "\"order\": 4000000000"),
        ABSTRACTION,
        &["a.json: "],
    ),
    Case::refused(
        "a settings file that is no TOML",
        |lab| lab.write("s.toml", "x = ["),
        "identify --robot arm.toml --settings s.toml",
        &["s.toml: TOML parse error at line 1"],
    ),
    Case::refused(
        "an unknown key of identify's settings",
        |lab| lab.write("s.toml", "[model]\nmotor = 1\n"),
        "identify --robot arm.toml --settings s.toml",
        &["s.toml: TOML parse error at line 2", "motor"],
    ),
    Case::refused(
        "a robot for an index",
        |lab| lab.write("data/runs.csv", robot_toml()),
        CONFORM,
        &["data/runs.csv:1: there is no column \"file\""],
    ),
];
