//! `inspect` describes what it refuses.

use serde_json::Value;

use crate::fixture::{Lab, cell, set_cell};

fn with_gaps() -> Lab {
    let lab = Lab::new();
    for name in ["A_1", "A_3", "B_2"] {
        lab.edit(&format!("data/{name}.csv"), |lines| drop(lines.drain(10..12)));
    }
    lab.edit("data/B_2.csv", |lines| drop(lines.drain(20..23)));
    lab.edit("data/B_3.csv", |lines| set_cell(&mut lines[5], 2, "x"));
    lab
}

#[test]
fn each_kind_of_defect_is_one_line_with_the_option_that_accepts_it() {
    let lab = with_gaps();
    let run = lab.run("inspect --data data").fails_after_result(&[
        "data/A_1.csv:11: there is a gap of 0.03",
        "(kind gap: 4 defects in 3 recordings, this is the first; --max-gap 0.04 accepts all)",
        "data/B_3.csv:6: joint 2: q2 is \"x\"",
    ]);
    assert_eq!(run.stderr.lines().count(), 2, "{}", run.stderr);
    let accepted = lab.run("inspect --data data --max-gap 0.04").exits(2);
    assert_eq!(accepted.stderr.lines().count(), 1, "{}", accepted.stderr);
    assert!(accepted.stdout.contains("1 refused, and not counted below"), "{}", accepted.stdout);
}

#[test]
fn the_sound_recordings_are_summarised() {
    let lab = with_gaps();
    let run = lab.run("inspect --data data --json").exits(2);
    let found: Value = run.json();
    let [gap, value] = &found["refused"].as_array().unwrap()[..] else { panic!("{found}") };
    assert_eq!((&gap["kind"], &gap["count"]), (&"gap".into(), &4.into()));
    assert_eq!(gap["accepted_by"], "--max-gap 0.04");
    assert_eq!((&value["kind"], &value["first"]["line"]), (&"value".into(), &6.into()));
    assert_eq!((&found["runs"], &found["joints"]), (&6.into(), &2.into()));
    let runs = |group: usize| found["groups"][group]["runs"].as_u64().unwrap();
    assert_eq!((runs(0), runs(1)), (1, 1));
}

#[test]
fn nothing_readable_is_described_too() {
    let lab = Lab::new();
    for suite in ["A", "B"] {
        for run in 1..=3 {
            lab.write(&format!("data/{suite}_{run}.csv"), "t,q1\n");
        }
    }
    let run = lab.run("inspect --data data").fails_after_result(&[
        "data/A_1.csv:1: column 3 of the header is missing",
        "6 defects in 6 recordings",
    ]);
    assert!(run.stderr.lines().count() == 1);
}

#[test]
fn recordings_of_another_robot_are_refused() {
    let lab = Lab::new();
    lab.write("data/A_2.csv", "t,q1,qd1,tau1\n0,0,0,0\n");
    lab.run("inspect --data data")
        .fails_after_result(&["data/A_2.csv:1: the recording has 1 joints, but the first has 2"]);
}

#[test]
fn paths_out_of_the_folder_are_noted() {
    let lab = Lab::new();
    std::fs::rename(lab.path("data/A_2.csv"), lab.path("A_2.csv")).unwrap();
    std::fs::rename(lab.path("data/A_3.csv"), lab.path("A_3.csv")).unwrap();
    let absolute = lab.path("A_3.csv").display().to_string();
    lab.edit("data/runs.csv", |lines| {
        lines[2] = lines[2].replace("A_2.csv", "../A_2.csv");
        lines[3] = lines[3].replace("A_3.csv", &absolute);
    });
    for run in [lab.run("inspect --data data"), lab.conform("")] {
        run.exits(0).notes("data/runs.csv:3: the path \"../A_2.csv\" (and 1 more) leads out");
    }
}

/// Writes a log of the fixture's arm with other names, in degrees and milliseconds.
fn log_of_a_driver(lab: &Lab) {
    let mut text =
        String::from("time;axis2_pos;axis1_pos;axis2_vel;axis1_vel;axis1_effort;axis2_effort\n");
    for k in 0..300 {
        let t = 0.008 * f64::from(k);
        let (q, qd) = (60.0 * t.sin(), 60.0 * t.cos());
        text += &format!("{};{q};{};{qd};{};1;2\n", 8 * k, -q, -qd);
    }
    std::fs::create_dir(lab.path("logs")).unwrap();
    lab.write("logs/motion.csv", text);
}

#[test]
fn logs_are_described_as_they_were_understood() {
    let lab = Lab::new();
    log_of_a_driver(&lab);
    let run = lab.run("inspect --data logs --robot arm.toml").exits(0);
    for words in [
        "logs/motion.csv: 300 samples, 2.392 s, separated by semicolons",
        "time    time [ms]",
        "q       axis1_pos, axis2_pos [deg]",
        "qd      axis1_vel, axis2_vel [deg/s]",
        "tau     axis1_effort, axis2_effort",
    ] {
        assert!(run.stdout.contains(words), "{words}: {}", run.stdout);
    }
    run.notes("the times are in ms; they were changed to s");
    let found = lab.run("inspect --data logs/motion.csv --json").exits(0).json();
    crate::output_schema::fits("inspect_logs", &found);
    assert_eq!(found["logs"][0]["angle_units"], serde_json::json!(["deg", "deg"]));
    lab.run("inspect --data logs --columns q=p{}").fails_after_result(&["columns.q = \"p{}\""]);
    lab.run("inspect --data logs --columns time_unit=s")
        .notes("with times in s and angles in deg, the positions move 1.000e-3 times as far")
        .exits(2);
}

#[test]
fn times_in_milliseconds_are_refused_before_a_model_is_made() {
    let lab = Lab::new();
    lab.edit("data/A_2.csv", |lines| {
        let in_milliseconds = |line: &mut String| {
            let time = 1e3 * cell(line, 0);
            set_cell(line, 0, &time.to_string());
        };
        lines.iter_mut().skip(1).for_each(in_milliseconds);
    });
    let words = "data/A_2.csv: the times look like milliseconds, because the positions move 1.0e-3";
    lab.run("inspect --data data").fails_after_result(&[words, "give times in s"]);
    lab.conform("").fails_with_last(&[words]);
}

#[test]
fn suites_of_one_sample_are_noted() {
    let lab = Lab::new();
    for run in 1..=3 {
        lab.edit(&format!("data/B_{run}.csv"), |lines| lines.truncate(2));
    }
    lab.run("inspect --data data").exits(0).notes("suite B: the runs have one sample each");
}

#[test]
fn logs_are_prepared_as_recordings() {
    let lab = Lab::new();
    log_of_a_driver(&lab);
    lab.run("prepare --robot arm.toml --data logs --window 0.5 --out windows").exits(0);
    lab.run("prepare --robot arm.toml --data logs --window 0.001 --out short").fails_with_last(&[
        "a window of 0.001 s is shorter than the time between samples, 0.008 s",
    ]);
    let first = lab.read("windows/0001_motion.csv");
    assert!(first.starts_with("t,q1,q2,qd1,qd2,tau1,tau2\n"), "{first}");
}
