//! Samples on standard input, beside what `check` says of the same recordings.

use std::io::{Read, Write};
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use crate::fixture::{Lab, Run, SAMPLES, STEP, set_cell};
use crate::output_schema::fits;

const MONITOR: &str = "monitor --model model.json";

/// A laboratory with a model of suite A.
fn lab() -> Lab {
    let lab = Lab::new();
    lab.conform("--suites A --out model.json").exits(0);
    lab
}

/// Runs the monitor on a text.
fn monitor(lab: &Lab, more: &str, input: &str) -> Run {
    fed(lab, &format!("{MONITOR} {more}"), input)
}

/// Runs a command on a text.
pub(crate) fn fed(lab: &Lab, command: &str, input: &str) -> Run {
    let mut command = lab.command(command);
    let mut child = piped(&mut command).spawn().unwrap();
    // A command that ends early does not read all of it.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    Run::of(child.wait_with_output().unwrap())
}

fn piped(command: &mut Command) -> &mut Command {
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped())
}

fn events(run: &Run) -> Vec<Value> {
    run.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn a_healthy_motion_stays_and_a_fault_is_reported_when_it_happens() {
    let lab = lab();
    let healthy = lab.read("data/A_2.csv");
    let run = monitor(&lab, "--horizon 0.1", &healthy)
        .exits(0)
        .notes("windows of 0.1000 s, a new one every 0.0300 s");
    assert!(run.stdout.starts_with("never left: 51 samples"), "{}", run.stdout);
    // From sample 30 on, joint 2 is elsewhere.
    lab.edit("data/A_2.csv", |lines| {
        for line in &mut lines[31..] {
            set_cell(line, 2, "0.5");
        }
    });
    let faulty = lab.read("data/A_2.csv");
    let run = monitor(&lab, "--horizon 0.1", &faulty).exits(1);
    let first = run.stdout.lines().next().unwrap();
    assert!(first.starts_with("0.3000 s: axis2 left its set: q2 is "), "{first}");
    assert!(run.stdout.contains("\nleft: "), "{}", run.stdout);
    let run = monitor(&lab, "--horizon 0.1 --gauge-every 0.1 --json", &faulty).exits(1);
    let events = events(&run);
    events.iter().for_each(|event| fits("monitor", event));
    let left = events.iter().find(|event| event["event"] == "left").unwrap();
    assert_eq!((&left["name"], &left["proved"]), (&json!("axis2"), &json!(true)));
    assert!(events.iter().filter(|event| event["event"] == "gauge").count() > 3);
    assert_eq!(events.last().unwrap()["ended"], "end of input");
}

#[test]
fn healthy_recordings_calibrate_alarms() {
    let lab = lab();
    let text = lab.read("data/A_2.csv");
    let run = monitor(&lab, "--horizon 0.1 --healthy data --json", &text).exits(0);
    assert!(run.stderr.contains("calibrated, not proved"), "{}", run.stderr);
    let events = events(&run);
    events.iter().for_each(|event| fits("monitor", event));
    let summary = events.last().unwrap();
    assert_eq!(summary["totals"]["alarms"], 0);
    assert!(summary["alarm_bound"].as_f64().unwrap() < 1.0, "{summary}");
    std::fs::create_dir(lab.path("one")).unwrap();
    lab.write("one/run.csv", &text);
    lab.write("one/runs.csv", "file,suite\nrun.csv,A\n");
    let run = monitor(&lab, "--horizon 0.1 --healthy one", &text).exits(2);
    assert!(run.stderr.contains("healthy motion needs at least 2 recordings"), "{}", run.stderr);
    assert_eq!(run.stderr.matches("samples every").count(), 1, "{}", run.stderr);
}

#[test]
fn a_replayed_recording_has_the_rows_of_a_check() {
    let lab = lab();
    std::fs::create_dir(lab.path("alone")).unwrap();
    let text = lab.read("data/B_3.csv");
    lab.write("alone/run.csv", &text);
    lab.write("alone/runs.csv", "file,suite\nrun.csv,alone\n");
    let check = lab.run("check --model model.json --data alone --torque compensated --json");
    let horizon = STEP * (SAMPLES - 1) as f64;
    let run = monitor(&lab, &format!("--horizon {horizon} --every {horizon} --json"), &text);
    let totals = events(&run).last().unwrap()["totals"].clone();
    assert_eq!(totals["outside"], check.json()["violations"]["count"]);
    assert_eq!(run.code, check.code);
}

#[test]
fn json_lines_are_samples_too_and_what_is_wrong_is_named_with_its_line() {
    let lab = lab();
    let sample =
        |t: f64, q: &str| format!("{{\"t\":{t},\"q\":[{q}],\"qd\":[0,0],\"tau\":[0,0]}}\n");
    let all: String = (0..40).map(|k| sample(0.01 * f64::from(k), "0.1,0.2")).collect();
    let run = monitor(&lab, "--step 0.01 --horizon 0.1 --json", &all);
    assert_eq!(events(&run).last().unwrap()["totals"]["samples"], 40);
    let header = "t,q1,q2,qd1,qd2,tau1,tau2\n";
    let row = |t: &str, q: &str| format!("{t},{q},0.2,0,0,0,0\n");
    let cases = [
        (header.to_string() + &row("0", "0") + &row("0.01", "nan"), "standard input:3: q1 is NaN"),
        (header.to_string() + &row("0", "0") + &row("0", "0"), "standard input:3: t is 0 s after"),
        (header.to_string() + &row("0", "0") + &row("1", "0"), "or allow longer gaps (--max-gap)"),
        (header.to_string() + &row("0", "x"), "standard input:2: \"x\" is not a number"),
        ("t,q1,qd1,tau1\n".into(), "standard input:1: the header has no column q2"),
        (sample(0.0, "0.1"), "standard input:1: 1 positions; the model has 2 joints"),
        ("{\"t\":0}\n".into(), "standard input:1: missing field `q`"),
    ];
    for (input, part) in cases {
        let run = monitor(&lab, "--step 0.01 --horizon 0.1", &input).exits(2);
        assert!(run.stderr.contains(part), "{part}: {}", run.stderr);
    }
    let run = monitor(&lab, "", header).exits(2);
    assert!(run.stderr.contains("no two samples"), "{}", run.stderr);
    let run = monitor(&lab, "--step 0.01", header).exits(2);
    assert!(run.stderr.contains("no sample was compared"), "{}", run.stderr);
    let run = monitor(&lab, "--step 0.01 --horizon 0.001", &all).exits(2);
    let needed = "horizon is 0.001; it must be between 0.01 and ";
    assert!(run.stderr.contains(needed), "{}", run.stderr);
    let run = monitor(&lab, "--step 0.01 --horizon 0.1 --every 0.2", &all).exits(2);
    assert!(run.stderr.contains("time between windows is 0.2"), "{}", run.stderr);
}

/// An interrupt ends with the summary, although no line comes.
#[test]
#[cfg(unix)]
fn an_interrupt_ends_with_the_summary() {
    let lab = lab();
    let mut command = lab.command(&format!("{MONITOR} --step 0.01 --horizon 0.1 --gauge-every 9"));
    let mut child = piped(&mut command).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let lines: Vec<String> = lab.read("data/A_2.csv").lines().take(20).map(String::from).collect();
    input.write_all((lines.join("\n") + "\n").as_bytes()).unwrap();
    input.flush().unwrap();
    // The first line of output shows that samples are judged.
    let mut output = child.stdout.take().unwrap();
    let mut first = [0];
    output.read_exact(&mut first).unwrap();
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    let mut rest = String::new();
    output.read_to_string(&mut rest).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(0), "{rest}");
    assert!(rest.contains("never left: "), "{rest}");
    drop(input);
}
