//! Conform and check: verdicts, witnesses, and exit codes.

use serde_json::Value;

use crate::fixture::{Lab, SAMPLES, START, TORQUE, cell, sealed, set_cell, text_of};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn the_sets_are_those_that_generated_the_recordings() {
    let lab = Lab::new();
    let model = lab.conform("--json").exits(0).json();
    assert_eq!(model["verified"], true);
    assert!(model["cost"].as_f64().unwrap() > 0.0);
    let (start, input) =
        (numbers(&model["initial_set"]["radius"]), numbers(&model["input_set"]["radius"]));
    // The recordings hold every digit, so the sets differ from the sets that generated them by
    // rounding only.
    let near = |found: &[f64], expected: &[f64]| {
        found
            .iter()
            .zip(expected)
            .for_each(|(x, y)| assert!((x - y).abs() < 1e-6, "{found:?} is not {expected:?}"));
    };
    near(&start, &[START, START, 0.0, 0.0]);
    near(&input, &[TORQUE; 2]);
    near(&numbers(&model["initial_set"]["centre"]), &[0.0; 4]);
    near(&numbers(&model["input_set"]["centre"]), &[0.0; 2]);
    assert_eq!(model["proof"]["rows"], 2 * 4 * SAMPLES);
}

#[test]
fn a_table_shows_the_sets() {
    let text = Lab::new().conform("").exits(0).stdout;
    assert!(text.starts_with("conformant: 6 recordings in 2 suites; 408 of 408 rows"), "{text}");
    for part in ["axis1", "axis2", "U [N m]"] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    assert!(!text.contains("-0.0000,") && !text.contains("-0.0000]"), "{text}");
}

/// What is printed encloses what is proved.
#[test]
fn printed_sets_are_rounded_outward() {
    let lab = Lab::new();
    let text = lab.conform("--verbose").exits(0).stdout;
    let model = lab.conform("--json").exits(0).json();
    let row = text.lines().find(|line| line.trim_start().starts_with("axis1")).unwrap();
    let cells: Vec<&str> =
        row.split("   ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    for (cell, set, state) in
        [(cells[1], "initial_set", 0), (cells[2], "initial_set", 2), (cells[3], "input_set", 0)]
    {
        let of = |part: &str| model[set][part][state].as_f64().unwrap();
        let (low, high) = (of("centre") - of("radius"), of("centre") + of("radius"));
        let (from, to) = match cell.trim_matches(['[', ']']).split_once(", ") {
            Some((from, to)) => (from.parse().unwrap(), to.parse().unwrap()),
            None => (cell.parse::<f64>().unwrap(), cell.parse().unwrap()),
        };
        assert!(from <= low && high <= to, "{cell} does not enclose [{low:e}, {high:e}]");
        assert!(to - from <= 1.1 * (high - low) + 1e-9, "{cell} is wider than [{low:e}, {high:e}]");
    }
}

/// One count of rows, in the command, the file and the page.
#[test]
fn rows_are_counted_once_and_alike() {
    for options in ["", "--nominal own", "--suites A", "--states positions", "--until 0.2"] {
        let lab = Lab::new();
        let model = lab.conform(&format!("{options} --json --out model.json")).exits(0).json();
        let suites = if options.contains("--suites") { options } else { "" };
        let check = lab.check(&format!("{suites} --json")).exits(0).json();
        let rows = model["proof"]["rows"].as_u64().unwrap();
        assert_eq!(check["rows"], rows, "{options}");
        let of_suites = |value: &Value| -> u64 {
            value.as_array().unwrap().iter().map(|suite| suite["rows"].as_u64().unwrap()).sum()
        };
        assert_eq!(of_suites(&check["suites"]), rows, "{options}");
        assert_eq!(of_suites(&model["proof"]["suites"]), rows, "{options}");
        let text = lab.conform(options).exits(0).stdout;
        assert!(text.contains(&format!("{rows} of {rows} rows")), "{options}: {text}");
        let text = lab.check(suites).exits(0).stdout;
        assert!(text.contains(&format!("0 of {rows} rows")), "{options}: {text}");
        let report = format!("report --model model.json --data data --torque compensated {suites}");
        lab.run(&report).exits(0);
        let page = text_of(&lab.read("report/report.html"));
        assert!(page.contains(&format!("{rows} rows")), "{options}");
    }
}

#[test]
fn the_page_says_that_sets_are_not_the_smallest() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    let mut model: serde_json::Value = serde_json::from_str(&lab.read("model.json")).unwrap();
    assert!(model["optimality_gap"].as_f64().unwrap() < 1e-6);
    model["optimality_gap"] = serde_json::json!(29.0);
    lab.write("model.json", sealed(model));
    lab.run("report --model model.json --data data --torque compensated --out page").exits(0);
    let page = lab.read("page/report.html");
    assert!(page.contains("are not the smallest") && page.contains("not minimal, gap 2.9e1"));
}

#[test]
fn one_value_outside_is_found_with_its_place() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    lab.check("").exits(0);
    lab.edit("data/B_2.csv", |lines| {
        let moved = format!("{:?}", cell(&lines[21], 1) + 0.5);
        set_cell(&mut lines[21], 1, &moved);
    });
    let check = lab.check("--json").exits(1).json();
    assert_eq!((&check["conformant"], &check["violations"]["count"]), (&false.into(), &1.into()));
    let worst = &check["violations"]["worst"];
    let expected = [("suite", "B"), ("run", "B_2.csv"), ("state", "q1"), ("side", "upper")];
    expected.iter().for_each(|(key, value)| assert_eq!(worst[key], *value, "{worst}"));
    assert_eq!(
        (&worst["sample"], &worst["time"], &worst["part"]),
        (&20.into(), &0.2.into(), &1.into())
    );
    // The run is in the middle of the set, whose radius there is at least the radius of X0.
    let excess = worst["excess"].as_f64().unwrap();
    assert!((0.4..=0.5 - START).contains(&excess), "{excess}");
    assert_eq!(check["suites"][0]["violations"]["count"], 0);
    let text = lab.check("").exits(1).stdout;
    assert!(text.starts_with("not conformant: 6 recordings; 1 of 408 rows"), "{text}");
    assert!(text.contains("B_2.csv, 0.200 s: q1 by 0.50 rad"), "{text}");
    let text = lab.check("--verbose").exits(1).stdout;
    assert!(text.contains("B_2.csv at 0.200 s: joint 1, q1 is 0.4"), "{text}");
}

#[test]
fn trust_is_stated_for_recordings_that_were_held_out_only() {
    let lab = Lab::new();
    lab.conform("--suites A --out model.json").exits(0);
    assert_eq!(lab.check("--suites A,B --json").json()["trust"], Value::Null);
    let held_out = lab.check("--suites B --json").json();
    assert_eq!(held_out["trust"]["motions"], 1);
}

#[test]
fn motions_that_are_held_out_calibrate_the_sets() {
    let lab = Lab::new();
    lab.edit("data/runs.csv", |lines| {
        lines.iter_mut().for_each(|line| *line = line.replace("motion ", "M"));
    });
    let text = lab.conform("--calibrate MB --out model.json --verbose").exits(0).stdout;
    for words in [
        "(calibrated, not the smallest)",
        "for 1 motion was scaled about the centres by",
        "leaves the reachable set with probability at most 0.500 (1 in 2)",
        "Basis: split conformal calibration",
    ] {
        assert!(text.contains(words), "{words} is not in\n{text}");
    }
    assert_eq!(lab.check("--json").exits(0).json()["trust"], Value::Null);
    let text = lab.conform("--calibrate ?B").exits(0).stdout;
    assert!(text.contains("new motions: at most 1 in 2 leaves the sets"), "{text}");
    lab.conform("--calibrate C*").fails_with(&["no motion \"C*\"", "MA, MB"]);
    lab.conform("--calibrate MC").fails_with(&["no motion \"MC\"", "MA, MB"]);
    lab.conform("--calibrate MA,MB").fails_with(&["all motions are held out", "name fewer"]);
}

#[test]
fn what_each_motion_decides_is_a_table() {
    let lab = Lab::new();
    let text = lab.conform("--verbose").exits(0).stdout;
    for words in ["without motion", "factor needed", "describe these motions"] {
        assert!(text.contains(words), "{words} is not in\n{text}");
    }
    let text = lab.conform("--suites A --verbose").exits(0).stdout;
    assert!(!text.contains("without motion"), "{text}");
}

#[test]
fn a_suite_of_one_run_needs_no_initial_set() {
    let lab = Lab::new();
    lab.edit("data/runs.csv", |lines| lines.truncate(2));
    let model = lab.conform("--json --out model.json").exits(0).json();
    assert!(numbers(&model["initial_set"]["radius"]).iter().all(|radius| *radius < 1e-6));
    lab.check("").exits(0);
}

#[test]
fn recordings_are_inspected() {
    let lab = Lab::new();
    let found = lab.run("inspect --data data --json").exits(0).json();
    assert_eq!((&found["joints"], &found["runs"]), (&2.into(), &6.into()));
    let group = &found["groups"][0];
    assert_eq!(
        (&group["name"], &group["motion"], &group["same_torque"]),
        (&"A".into(), &"motion A".into(), &true.into())
    );
    let spread = group["joints"][0]["start_spread"].as_f64().unwrap();
    assert!((spread - 2.0 * START).abs() < 1e-12);
    let text = lab.run("inspect --data data").exits(0).stdout;
    assert!(
        text.contains(
            "suite A (motion motion A): 3 runs of 51 samples every 0.01 s, 0.500 s, same torques \
             in every run"
        ),
        "{text}"
    );
}
