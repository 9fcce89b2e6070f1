//! What commands print with `--json` fits the schema that `man --schema results` prints.

use std::sync::LazyLock;

use reachtube::conform::Notion;
use serde_json::{Value, json};

use crate::fixture::Lab;
use crate::provenance::names_what_it_is_of;

/// Returns the JSON schema that `man --schema` prints.
pub(crate) fn schema(of: &str) -> Value {
    Lab::new().run(&format!("man --schema {of}")).exits(0).json()
}

/// Returns the validator of a JSON schema that `man --schema` prints.
pub(crate) fn validator(of: &str) -> jsonschema::Validator {
    let schema = schema(of);
    jsonschema::draft202012::meta::validate(&schema).unwrap();
    jsonschema::draft202012::new(&schema).unwrap()
}

/// Returns what does not fit a schema.
pub(crate) fn complaints(schema: &jsonschema::Validator, value: &Value) -> Vec<String> {
    schema.iter_errors(value).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

/// Returns the schema of one command's output.
fn schema_of_command(name: &str) -> jsonschema::Validator {
    static RESULTS: LazyLock<Value> = LazyLock::new(|| schema("results"));
    let mut schema = RESULTS.clone();
    jsonschema::draft202012::meta::validate(&schema).unwrap();
    schema["anyOf"] = json!([{ "$ref": format!("#/$defs/{name}") }]);
    jsonschema::draft202012::new(&schema).unwrap()
}

#[test]
fn the_schema_has_the_notions_of_the_command() {
    let names: Vec<&str> = Notion::NAMES.iter().map(|(name, _)| *name).collect();
    let notions = schema("model")["$defs"]["Notion"]["oneOf"].as_array().unwrap().clone();
    assert_eq!(notions.iter().map(|one| &one["const"]).collect::<Vec<_>>(), names);
}

#[test]
fn the_schema_has_a_definition_for_each_command_and_words_for_each_field() {
    let schema = schema("results");
    for command in ["check", "model", "identify", "verify", "reproduce", "error"] {
        let fields = schema["$defs"][command]["properties"].as_object().unwrap();
        for (name, field) in fields {
            let is_described = field.get("description").is_some() || field.get("$ref").is_some();
            assert!(is_described, "{command}: {name}");
        }
    }
}

/// Asserts that a value fits the schema of a command's output.
#[track_caller]
pub(crate) fn fits(name: &str, value: &Value) {
    let schema = schema_of_command(name);
    assert_eq!(complaints(&schema, value), Vec::<String>::new(), "{name}");
    // A schema that accepts everything would prove nothing.
    let mut more = value.clone();
    more["more"] = json!(1);
    assert!(!schema.is_valid(&more), "{name} accepts any key");
}

#[test]
fn results_fit_the_schema() {
    let lab = Lab::new();
    lab.conform("--suites A --out model.json").exits(0);
    let with = "--model model.json --data data --torque compensated";
    let run = |name: &str, command: &str| {
        fits(name, &lab.run(&format!("{command} --json")).exits(0).json());
    };
    run("inspect", "inspect --data data");
    run("check", &format!("check {with}"));
    run("check", &format!("check {with} --suites B"));
    // These recordings lie on the boundary of the sets to the last bit, which proves nothing.
    let check = lab.run(&format!("check {with} --suites B --notion exact --json")).exits(1).json();
    fits("check", &check);
    assert_eq!(check["points"]["outside"], 0);
    run("reach", &format!("reach {with} --out sets"));
    run("export", "export --model model.json --data data --to cora --out cora");
    run("export_robot", "export --robot arm.toml --to mjcf --out robot");
    lab.write(
        "capsules.toml",
        [1, 2].map(|link| {
            format!(
                "[[capsule]]\nlink = {link}\nfrom = [0, 0, 0]\nto = [0.4, 0, 0]\nradius = 0.05\n"
            )
        })
        .concat(),
    );
    let shield = "export --model model.json --data data --to sara-shield --out shield";
    run("export_shield", &format!("{shield} --capsules capsules.toml"));
    run("report", &format!("report {with} --out page"));
    run("excite", "excite --robot arm.toml --harmonics 2 --period 5 --out e.csv");
    run("robot_show", "robot show arm.toml");
    run("abstract", "abstract --robot arm.toml");
    let small = "--motions 1 --orders 1 --campaigns 1 --next 20";
    run("reproduce", &format!("reproduce table1 coverage {small}"));
}

#[test]
fn a_demo_fits_the_schema() {
    let lab = Lab::new();
    // A scenario that a user changed is kept.
    std::fs::create_dir(lab.path("demo")).unwrap();
    lab.write("demo/cell.toml", "# mine");
    let demo = lab.run("demo --out demo --json").exits(0).json();
    assert_eq!(lab.read("demo/cell.toml"), "# mine");
    assert!(lab.read("demo/brakes.toml").contains("torque"));
    fits("demo", &demo);
    let model = serde_json::from_str(&lab.read("demo/model.json")).unwrap();
    for verdict in [&demo["model"], &demo["check"]] {
        names_what_it_is_of(verdict, &model, None);
    }
    assert_eq!([&demo["model"]["useful"], &demo["check"]["conformant"]], [true, true]);
    // Its pages say that nothing was measured, and lead to each other.
    for (page, other) in [("page", "held-out"), ("held-out", "page")] {
        let html = lab.read(&format!("demo/{page}/report.html"));
        assert!(html.contains("<span class=\"badge\">simulated data</span>"), "{page}");
        assert!(html.contains(&format!("href=\"../{other}/report.html\"")), "{page}");
    }
    assert!(lab.read("demo/model.json").contains("\"simulated\": true"));
}

#[test]
fn a_campaign_fits_the_schema() {
    let lab = Lab::new();
    lab.write("robot.toml", "payload_mass = 0.5\n");
    let few = "--motions 1 --start-points 1 --runs 2 --longest 0.2 --rest 0 --one-joint 0 \
               --excitation 0 --validation 0 --parameters robot.toml";
    let campaign = format!("campaign --out out {few}");
    fits("campaign", &lab.run(&format!("{campaign} --json")).exits(0).json());
    assert!(lab.read("out/campaign.json").contains("\"payload_mass\": 0.5"));
    let again = lab.run(&campaign).exits(0).stdout;
    assert!(again.contains("2 of them by an earlier start"), "{again}");
    fits("inspect", &lab.run("inspect --data out --json").exits(0).json());
    let table = lab.run("reproduce table2 --data out --notions hull,exact --json").exits(0).json();
    fits("reproduce", &table);
    lab.write("robot.toml", "payload = 0.5\n");
    lab.run(&campaign).fails_with(&["robot.toml", "unknown field `payload`"]);
    lab.write("robot.toml", "cooling_time = -1.0\n");
    lab.run(&campaign).fails_with(&["cooling_time = -1 is outside"]);
}

#[test]
fn refusals_and_errors_fit_the_schema() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    lab.edit("data/A_2.csv", |lines| drop(lines.drain(10..12)));
    lab.edit("data/B_3.csv", |lines| lines.truncate(1));
    fits("inspect", &lab.run("inspect --data data --json").exits(2).json());
    for command in [
        "inspect --data none",
        "inspect --data data",
        "conform --robot none.toml --data data --torque motor",
        "check --model model.json --data data --torque motor",
        "check --model none.json --data data --torque motor",
        "excite --robot arm.toml --period 1e9 --out e.csv",
        "conforms",
        "conform",
        "abstract --robot arm.toml --order 0",
        "conform --robot arm.toml --data data --torque compensated --out arm.toml",
    ] {
        let run = lab.run(&format!("{command} --json")).exits(2);
        let last = run.stderr.lines().last().unwrap();
        fits("error", &serde_json::from_str(last).unwrap());
    }
}

#[test]
fn a_value_outside_fits_the_schema() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    lab.edit("data/B_2.csv", |lines| crate::fixture::set_cell(&mut lines[21], 1, "1.5"));
    fits("check", &lab.check("--json").exits(1).json());
}
