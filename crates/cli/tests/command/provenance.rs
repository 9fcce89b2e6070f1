//! Every verdict names what it is of: the notion, the settings and the digests of the model and of
//! each recording. What was left out, or is not the model's, is named.

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::fixture::{Lab, Run, cell, set_cell, text_of};

/// Asserts that a verdict of a model has its notion, its settings and its digests; `model` is the
/// model file, and `folder` has the recordings as they are listed, if they are files.
#[track_caller]
pub(crate) fn names_what_it_is_of(verdict: &Value, model: &Value, folder: Option<&Lab>) {
    let settings = &verdict["settings"];
    assert!(settings["notion"].is_string(), "{verdict}");
    let driven_by = verdict.get("driven_by").unwrap_or(&verdict["drive"]["settings"]);
    assert_eq!(driven_by["torque"], model["drive"]["settings"]["torque"], "{verdict}");
    assert!(driven_by["torque"].is_string(), "{verdict}");
    assert!(verdict["tool"].as_str().unwrap().starts_with("reachtube "), "{verdict}");
    let sha256 = verdict.get("model_sha256").unwrap_or(&verdict["sha256"]);
    assert_eq!(sha256, &model["sha256"]);
    assert_eq!(verdict["data"]["sha256"].as_str().unwrap().len(), 64);
    let suites = verdict["data"]["suites"].as_array().unwrap();
    let runs: Vec<&Value> = suites.iter().flat_map(|s| s["runs"].as_array().unwrap()).collect();
    assert!(!runs.is_empty());
    for run in runs {
        let (file, listed) = (run["file"].as_str().unwrap(), run["sha256"].as_str().unwrap());
        match folder {
            Some(lab) => {
                let digest = Sha256::digest(lab.read(&format!("data/{file}")));
                let digest: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
                assert_eq!(listed, digest, "{file}");
            }
            None => assert_eq!(listed.len(), 64, "{file}"),
        }
    }
}

#[test]
fn every_verdict_names_what_it_is_of() {
    let lab = Lab::new();
    let model = lab.conform("--suites A --out model.json --json").exits(0).json();
    names_what_it_is_of(&model, &model, Some(&lab));
    let with = "--model model.json --data data --json";
    for (command, code) in [
        (format!("check {with} --suites A"), 0),
        (format!("check {with} --suites B --until 0.3"), 0),
        (format!("check {with} --notion exact"), 1),
        (format!("reach {with} --out sets --until 0.3"), 0),
    ] {
        let verdict = lab.run(&command).exits(code).json();
        names_what_it_is_of(&verdict, &model, Some(&lab));
        let notion = if command.contains("exact") { "exact" } else { "hull" };
        assert_eq!(verdict["settings"]["notion"], notion, "{command}");
        let until = if command.contains("until") { json!(0.3) } else { Value::Null };
        assert_eq!(verdict["settings"].get("until").unwrap_or(&Value::Null), &until, "{command}");
    }
}

/// A check up to a time claims nothing later, in any of its forms.
#[test]
fn a_check_up_to_a_time_says_so() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    // A recording that leaves the sets, but only later.
    lab.edit("data/B_2.csv", |lines| {
        let moved = format!("{:?}", cell(&lines[40], 1) + 0.5);
        set_cell(&mut lines[40], 1, &moved);
    });
    lab.check("").exits(1);
    let whole = lab.check("--json").exits(1).json();
    let until = "up to 0.3 s after the first";
    assert!(!whole["claim"].as_str().unwrap().contains(until));
    let check = lab.check("--until 0.3 --json").exits(0).json();
    let claim = check["claim"].as_str().unwrap();
    assert!(claim.contains(&format!("at each of its samples {until},")), "{claim}");
    assert_eq!(check["findings"][0]["numbers"]["until"], 0.3);
    assert!(check["findings"][0]["text"].as_str().unwrap().contains(until), "{check}");
    let text = lab.check("--until 0.3").exits(0).stdout;
    assert!(text.lines().next().unwrap().ends_with("suites, up to 0.3 s"), "{text}");
    assert!(lab.check("--until 0.3 --verbose").exits(0).stdout.contains(until));
    lab.run("report --model model.json --data data --until 0.3 --out page").exits(0);
    let page = text_of(&lab.read("page/report.html"));
    assert!(page.contains(until) && page.contains("SHA-256 of these recordings"), "{page}");
    // The first lines are about the check, and not about the horizon of the model.
    let lead = page.split("Outside the set").next().unwrap();
    assert!(lead.contains("the first 0.3 s of each recording"), "{lead}");
    assert!(!lead.contains("Widest set"), "{lead}");
    // A model that was found so says it too, and so does a check of it.
    let model = lab.conform("--until 0.3 --out short.json --json").exits(0).json();
    assert!(model["proof"]["claim"].as_str().unwrap().contains(until), "{model}");
    let check = lab.run("check --model short.json --data data").exits(0);
    assert!(check.stdout.contains("suites, up to 0.3 s"), "{}", check.stdout);
    assert!(!check.stderr.contains("later than"), "printed twice: {}", check.stderr);
}

/// Returns the finding about recordings that are not the model's.
fn other(run: &Run) -> Option<Value> {
    let findings = run.json()["findings"].as_array().unwrap().clone();
    findings.into_iter().find(|finding| finding["code"] == "other-recordings")
}

#[test]
fn recordings_that_are_not_the_model_s_are_named() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    assert_eq!(other(&lab.check("--json").exits(0)), None);
    assert_eq!(other(&lab.check("--suites A --json").exits(0)), None);
    assert_eq!(other(&lab.check("--until 0.2 --json").exits(0)), None);
    let [first, second] = ["data/A_1.csv", "data/A_2.csv"].map(|file| lab.read(file));
    // A recording that decides the sets is replaced by one that does not.
    lab.write("data/A_1.csv", &second);
    let run = lab.check("--json").exits(0);
    let found = other(&run).unwrap();
    assert_eq!(
        (&found["severity"], &found["numbers"]["replaced"]),
        (&json!("warning"), &json!(1.0))
    );
    let text = found["text"].as_str().unwrap();
    assert!(
        text.contains("other content in A_1.csv. In the model, A_1.csv decides the sets."),
        "{text}"
    );
    let printed = lab.check("").exits(0).stdout.replace("\n  ", " ");
    assert!(
        printed.contains("other content in A_1.csv. In the model, A_1.csv decides"),
        "{printed}"
    );
    assert!(lab.check("--verbose").exits(0).stdout.contains("decides the sets"));
    // It is cut.
    let lines: Vec<&str> = first.lines().take(21).collect();
    lab.write("data/A_1.csv", lines.join("\n") + "\n");
    let text = other(&lab.check("--json").exits(0)).unwrap()["text"].to_string();
    assert!(text.contains("A_1.csv (20 samples, 51 in the model's)"), "{text}");
    // It is dropped, or its whole suite.
    lab.edit("data/runs.csv", |lines| lines.retain(|line| !line.starts_with("A_1")));
    let found = other(&lab.check("--json").exits(0)).unwrap();
    assert_eq!(found["numbers"]["missing"], 1.0, "{found}");
    assert_eq!(found["numbers"]["deciding"], 1.0, "{found}");
    lab.edit("data/runs.csv", |lines| lines.retain(|line| !line.starts_with("A_")));
    let found = other(&lab.check("--json").exits(0)).unwrap();
    assert_eq!(found["numbers"]["missing"], 3.0, "{found}");
}

#[test]
fn recordings_that_were_all_cut_are_not_held_out() {
    let lab = Lab::new();
    lab.conform("--suites A --out model.json").exits(0);
    for run in 1..=3 {
        lab.edit(&format!("data/A_{run}.csv"), |lines| lines.truncate(31));
    }
    let run = lab.check("--suites A --json").exits(0);
    let found = other(&run).unwrap();
    assert_eq!(
        (&found["severity"], &found["numbers"]["replaced"]),
        (&json!("warning"), &json!(3.0))
    );
    assert_eq!(run.json()["trust"], Value::Null, "a bound for motions that were seen");
    // Others of the same names are other recordings: a note, and a bound.
    for run in 1..=3 {
        lab.edit(&format!("data/A_{run}.csv"), |lines| {
            let moved = format!("{:?}", cell(&lines[1], 1) + 1e-5);
            set_cell(&mut lines[1], 1, &moved);
        });
    }
    let run = lab.check("--suites A --json");
    assert_eq!(other(&run).unwrap()["severity"], "info");
    assert!(run.json()["trust"].is_object());
}
