//! `abstract`, its file, and `conform` on it.

use serde_json::{Value, json};

use crate::fixture::Lab;
use crate::output_schema::validator;

/// The degrees and the counts of terms are computed by hand: model 1 of the LWA 4P has six terms in
/// each of q̇, q̇², q̇³ and u per joint.
#[test]
fn models_are_made_and_described() {
    let lab = Lab::new();
    for (arguments, degree, terms) in [
        ("--paper-model 1 --order 1", 1, 72),
        ("--paper-model 1 --order 5", 3, 144),
        ("--paper-model 2 --order 1", 1, 72),
        ("--paper-model 3 --order 1", 1, 72),
    ] {
        let made = lab.run(&format!("abstract --robot lwa4p {arguments} --json")).exits(0).json();
        let sum: u64 = made["terms"].as_array().unwrap().iter().map(|t| t.as_u64().unwrap()).sum();
        assert_eq!((made["degree"].as_u64().unwrap(), sum), (degree, terms), "{arguments}");
    }
    let made = lab.run("abstract --robot lwa4p --paper-model 2 --order 4");
    let text = made.exits(0).stdout;
    for part in ["model 2 of order 4 of Schunk LWA 4P", "24 states", "joint6", "q = 0 rad"] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
}

/// The arm has the inertias 1 and 0.5 kg m² and the viscous friction 2 and 1 N m s/rad.
#[test]
fn polynomials_are_printed() {
    let printed = Lab::new().run("abstract --robot arm.toml --print").exits(0).stdout;
    assert_eq!(printed, "qdd1 = - 2 qd1 + 1 u1\nqdd2 = - 2 qd2 + 2 u2\n");
}

#[test]
fn files_fit_the_schema_and_conform_takes_them() {
    let (schema, lab) = (validator("abstraction"), Lab::new());
    let usual = lab.conform("--json").exits(0).json();
    for model in [1, 2, 3] {
        lab.run(&format!("abstract --robot arm.toml --paper-model {model} --out m{model}.json"))
            .exits(0);
        let file: Value = serde_json::from_str(&lab.read(&format!("m{model}.json"))).unwrap();
        let complaints: Vec<String> = schema.iter_errors(&file).map(|e| e.to_string()).collect();
        assert_eq!(complaints, Vec::<String>::new());
        let found = lab
            .run(&format!(
                "conform --abstraction m{model}.json --data data --torque compensated --json"
            ))
            .exits(0)
            .json();
        assert_eq!(found["drive"]["settings"]["abstraction"], json!({"model": model, "order": 1}));
        assert!(
            (found["cost"].as_f64().unwrap() / usual["cost"].as_f64().unwrap() - 1.0).abs() < 1e-9
        );
    }
    lab.run("conform --abstraction m2.json --data data --torque compensated --out model.json")
        .exits(0);
    lab.check("").exits(0);
}

#[test]
fn what_cannot_be_made_is_refused() {
    let lab = Lab::new();
    let refused = |arguments: &str, parts: &[&str]| {
        lab.run(arguments).fails_with(parts);
    };
    let unknown = lab.run("abstract --robot lwa4p --paper-model 4").exits(2).stderr;
    assert!(unknown.contains("invalid value '4'") && unknown.contains("1, 2, 3"), "{unknown}");
    refused("abstract --robot lwa4p --order 0", &["order 1 at least"]);
    refused("abstract --robot lwa4p --paper-model 3 --order 20", &["GB for its terms", "fits"]);
    refused("abstract --robot lwa4p --paper-model 2 --order 40", &["up to order 31"]);
    refused(
        "abstract --robot lwa4p --expansion 1,2",
        &["expansion point has 2 values", "6 positions"],
    );
    let neither = lab.run("conform --data data --torque compensated").exits(2).stderr;
    assert!(neither.contains("--robot"), "{neither}");
    refused(
        "conform --abstraction none.json --data data --torque compensated",
        &["none.json", "`abstract --out`"],
    );
}

#[test]
fn a_changed_file_is_refused() {
    let lab = Lab::new();
    lab.run("abstract --robot arm.toml --out m.json").exits(0);
    let whole: Value = serde_json::from_str(&lab.read("m.json")).unwrap();
    let changed = |path: &str, value: Value, parts: &[&str]| {
        let mut file = whole.clone();
        *file.pointer_mut(path).unwrap() = value;
        lab.write("m.json", file.to_string());
        lab.run("conform --abstraction m.json --data data --torque compensated").fails_with(parts);
    };
    changed("/format", json!("reachtube-model"), &["format is not \"reachtube-abstraction\""]);
    changed("/version", json!(7), &["version 7", "run abstract again"]);
    changed("/variables/0", json!("q1"), &["its variables are not qd1, qd2, u1, u2"]);
    changed("/acceleration/0/0/1", json!(-2.5), &["changed after it was written"]);
    changed(
        "/acceleration/1/0/0",
        json!([1, 0, 0]),
        &["acceleration of joint 2", "3 exponents", "4 variables"],
    );
    changed("/order", json!(0), &["exponents of sum 1", "order 0"]);
    changed("/robot/joint/0/armature", json!(2.0), &["changed after it was written"]);
}
