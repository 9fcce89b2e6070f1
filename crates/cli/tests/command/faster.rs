//! Sets of slower motions, which faster ones leave.

use crate::fixture::{Lab, Run};
use crate::output_schema::fits;
use crate::wrong_inputs::{MODEL, lab, write_logs};

/// Runs `model` with some choices, up to 0.3 s.
fn model(lab: &Lab, choices: &str) -> Run {
    lab.write("given.toml", choices);
    lab.run(&format!("{MODEL} --horizon 0.3 --settings given.toml --json"))
}

#[test]
fn sets_get_an_allowance_for_faster_motions_that_leave_those_of_slower_ones() {
    let lab = lab();
    write_logs(&lab, 8, &|_, _, _| ());
    // The faster half of the motions has 0.96 % of its rows outside the sets of the slower half.
    let without = model(&lab, "largest-outside = 0.01\n").exits(0).json();
    fits("model", &without);
    assert_eq!(without["without_model"].get("faster_with_allowance"), None);
    let found = model(&lab, "largest-outside = 0.008\n").exits(0);
    let answer = found.json();
    fits("model", &answer);
    let part = |name: &str| answer["without_model"][name].clone();
    let [own, allowed] = [part("faster")[0].clone(), part("faster_with_allowance")];
    let [own, allowed] = [own, allowed].map(|part| part.as_f64().unwrap());
    assert!(own > 0.008 && allowed <= 0.008, "{own} {allowed}");
    // The least allowance is a small one.
    let ratio = |answer: &serde_json::Value| answer["joints"][0]["ratio"].as_f64().unwrap();
    let wider = ratio(&answer) / ratio(&without);
    assert!(wider > 1.0 && wider < 1.1, "{wider}");
    // What was found is what is read.
    lab.run("model --settings made/choices.toml --out again --quiet").exits(0);
    let of = |file: &str| serde_json::from_str::<serde_json::Value>(&lab.read(file)).unwrap();
    let [found, again] = [of("made/model.json"), of("again/model.json")];
    for key in ["initial_set", "input_set", "usefulness", "settings"] {
        assert!(!found[key].is_null() && again[key] == found[key], "{key}");
    }
    // Without an allowance the model is refused for its reason.
    let refused = model(&lab, "largest-outside = 0.008\nallowance = []\n").exits(3).json();
    assert_eq!(refused["useful"], false);
    let line = format!("{MODEL} --horizon 0.3 --settings given.toml");
    let said = lab.run(&line).exits(3).stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("of faster motions 1.0 % of the rows leave its sets"), "{said}");
}
