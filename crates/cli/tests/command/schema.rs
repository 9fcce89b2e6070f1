//! The model file against its schema, and tampered files.

use serde_json::{Value, json};

use crate::fixture::{Lab, sealed};
use crate::output_schema::{complaints, validator};

#[test]
fn models_fit_the_schema() {
    let (schema, lab) = (validator("model"), Lab::new());
    lab.edit("data/runs.csv", |lines| {
        lines.iter_mut().for_each(|line| *line = line.replace("motion ", "M"));
    });
    for options in [
        "",
        "--noise fitted --weights 1,0.5",
        "--noise 0.001,0.01 --until 0.2 --weights 1,0.5",
        "--states positions",
        "--calibrate MB",
        "--notion phase-plane",
        "--notion exact",
        "--fit inertia,viscous,warm-up --pull 0.02",
        "--nominal own --noise fitted --equations robot --fit viscous --pull 0.02",
    ] {
        let model = lab.conform(&format!("--json {options}")).exits(0).json();
        assert_eq!(complaints(&schema, &model), Vec::<String>::new(), "{options}");
        let codes: Vec<&Value> = model["findings"].as_array().unwrap().iter().collect();
        assert_eq!(codes[0]["code"], "conformant", "{options}");
        assert!(codes.iter().any(|finding| finding["code"] == "cost"), "{options}");
    }
    lab.edit("data/runs.csv", |lines| lines[0] = lines[0].replace("motion", "other"));
    let model = lab.conform("--json").exits(0).json();
    assert_eq!(complaints(&schema, &model), Vec::<String>::new());
}

#[test]
fn what_conform_prints_is_a_model_file_with_findings() {
    let lab = Lab::new();
    let run = lab.conform("--json --out new/folder/model.json").exits(0);
    let mut printed = run.notes("wrote new/folder/model.json").json();
    let stored: Value = serde_json::from_str(&lab.read("new/folder/model.json")).unwrap();
    lab.write("printed.json", printed.to_string());
    lab.run("check --model printed.json --data data --torque compensated").exits(0);
    assert!(stored.get("findings").is_none());
    printed.as_object_mut().unwrap().remove("findings");
    assert_eq!(printed, stored);
}

#[test]
fn the_embedded_robot_fits_the_schema() {
    let (schema, lab) = (validator("model"), Lab::new());
    let mut model = lab.conform("--json").exits(0).json();
    model["drive"]["robot"] =
        lab.run("robot show lwa4p --json").exits(0).json()["description"].clone();
    assert_eq!(complaints(&schema, &model), Vec::<String>::new());
}

#[test]
fn the_schema_refuses_what_the_program_refuses() {
    let (schema, lab) = (validator("model"), Lab::new());
    let model = lab.conform("--json").exits(0).json();
    let set = |path: &str, value: Value| {
        let mut changed = model.clone();
        *changed.pointer_mut(path).unwrap() = value;
        changed
    };
    let mut more = model.clone();
    more["more"] = json!(1);
    let mut less = model.clone();
    less.as_object_mut().unwrap().remove("cost");
    for (changed, words) in [
        (set("/format", json!("other")), "format is not"),
        (
            set("/version", json!(1)),
            "version 1 of the format, but this program reads version 4; run conform again",
        ),
        (set("/input_set/radius/0", json!(-0.1)), "input_set or noise_set"),
        (set("/drive/settings/torque", json!("raw")), "unknown variant `raw`"),
        (set("/cost", json!(null)), "it has no cost"),
        (more, "unknown field `more`"),
        (less, "it has no cost"),
    ] {
        assert!(!complaints(&schema, &changed).is_empty(), "{words}");
        lab.write("model.json", changed.to_string());
        lab.check("").fails_with(&["model.json: ", words]);
    }
}

#[test]
fn a_changed_part_is_refused() {
    let lab = Lab::new();
    let model = lab.conform("--json").exits(0).json();
    for (path, value, words) in [
        ("/a/2/2", json!(-3.0), "a, b or drift does not agree with its robot"),
        ("/b/3/1", json!(2.5), "a, b or drift does not agree with its robot"),
        (
            "/drive/robot/joint/0/armature",
            json!(1.5),
            "a, b or drift does not agree with its robot",
        ),
        ("/drive/robot/joint/0/armature", json!(-1.5), "armature = -1.5 is negative"),
        ("/a/2", json!([0.0]), "has not the size for 2 inputs"),
        ("/drive/settings/expansion_point/q", json!([0.0]), "expansion point"),
        ("/data/suites/0/runs/0/sha256", json!("0".repeat(64)), "data.sha256"),
        ("/verified", json!(false), "verified does not agree with proof"),
        ("/proof/violations/count", json!(1), "verified does not agree with proof"),
    ] {
        let mut changed = model.clone();
        *changed.pointer_mut(path).unwrap() = value;
        lab.write("model.json", changed.to_string());
        lab.check("").fails_with(&["model.json: ", words]);
    }
}

#[test]
fn a_smaller_set_is_no_longer_conformant() {
    let lab = Lab::new();
    let mut model = lab.conform("--json").exits(0).json();
    model["input_set"]["radius"] = json!([0.05, 0.1]);
    lab.write("model.json", sealed(model));
    let worst = lab.check("--json").exits(1).json()["violations"]["worst"].clone();
    assert_eq!(worst["part"], 1);
}

#[test]
fn other_files_are_refused() {
    let lab = Lab::new();
    lab.check("")
        .fails_with(&["model.json: cannot read", "give a file that `model` or `conform` wrote"]);
    for text in ["", "{", "[1]", "3", "t,q1,qd1,tau1\n", "\"reachtube-model\""] {
        lab.write("model.json", text);
        lab.check("").fails_with(&["model.json: ", "give a file that `conform --out` wrote"]);
    }
    lab.write("model.json", [0xff, 0xfe, 0x00]);
    lab.check("").fails_with(&["model.json: cannot read"]);
}
