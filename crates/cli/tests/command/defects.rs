//! Each defect of a recording is reported with file, line, joint and remedy.

use crate::fixture::{Lab, cell, set_cell};

/// Changes the lines of A_2.csv, and asserts that `conform` and `inspect` refuse it with each of
/// `parts`.
#[track_caller]
fn refused(change: impl FnOnce(&mut Vec<String>), parts: &[&str]) {
    let lab = Lab::new();
    lab.edit("data/A_2.csv", change);
    lab.conform("--out model.json").fails_with(parts);
    assert!(!lab.path("model.json").exists());
    lab.run("inspect --data data").fails_after_result(parts);
}

/// Changes the bytes of A_2.csv, and asserts that `conform` refuses it with each of `parts`.
#[track_caller]
fn refused_bytes(change: impl FnOnce(String) -> Vec<u8>, parts: &[&str]) {
    let lab = Lab::new();
    let bytes = change(lab.read("data/A_2.csv"));
    lab.write("data/A_2.csv", bytes);
    lab.conform("--json").fails_in_json("recordings", parts);
}

/// Asserts that another way to write the same recording gives the same model.
#[track_caller]
fn accepted(change: impl FnOnce(String) -> String) {
    let lab = Lab::new();
    let expected = lab.conform("--json").exits(0).json();
    let text = change(lab.read("data/A_2.csv"));
    lab.write("data/A_2.csv", text);
    let found = lab.conform("--json").exits(0).json();
    for key in ["cost", "initial_set", "input_set"] {
        assert_eq!(found[key], expected[key], "{key}");
    }
}

#[test]
fn not_a_number() {
    refused(
        |lines| set_cell(&mut lines[9], 3, "NaN"),
        &["data/A_2.csv:10: joint 1: qd1 is \"NaN\"", "cut the run"],
    );
    refused(
        |lines| set_cell(&mut lines[9], 2, "inf"),
        &["data/A_2.csv:10: joint 2: q2 is \"inf\""],
    );
    refused(
        |lines| set_cell(&mut lines[50], 6, "1.5V"),
        &["data/A_2.csv:51: joint 2: tau2 is \"1.5V\""],
    );
}

#[test]
fn lines_are_counted_with_blank_ones() {
    let blank_and_bad = |lines: &mut Vec<String>| {
        set_cell(&mut lines[9], 2, "x");
        lines.insert(9, "\r\n".into());
    };
    refused(blank_and_bad, &["data/A_2.csv:12: joint 2: q2 is \"x\""]);
}

#[test]
fn an_empty_value() {
    refused(|lines| set_cell(&mut lines[3], 5, ""), &["data/A_2.csv:4: joint 1: tau1 is empty"]);
}

#[test]
fn every_defect_is_listed_in_the_order_of_the_lines() {
    let lab = Lab::new();
    lab.edit("data/A_2.csv", |lines| {
        set_cell(&mut lines[30], 1, "x");
        set_cell(&mut lines[20], 4, "y");
        lines.remove(10);
    });
    lab.edit("data/B_3.csv", |lines| set_cell(&mut lines[1], 2, "z"));
    let run = lab.conform("").fails_with(&[]);
    let places: Vec<&str> =
        run.stderr.lines().map(|line| line.split(": ").nth(1).unwrap()).collect();
    assert_eq!(places, ["data/A_2.csv:11", "data/A_2.csv:20", "data/A_2.csv:30", "data/B_3.csv:2"]);
}

#[test]
fn a_line_cut_short() {
    let cut = |text: String| text.as_bytes()[..text.len() - 50].to_vec();
    refused_bytes(cut, &["data/A_2.csv:52:", "fields, but the header has 7", "cut short"]);
}

#[test]
fn a_header_that_differs() {
    refused(
        |lines| lines[0] = lines[0].replace("qd2", "dq2"),
        &["data/A_2.csv:1: column 5", "\"dq2\"", "expected \"qd2\""],
    );
    refused(
        |lines| lines[0] = lines[0].replace(",tau2", ""),
        &["data/A_2.csv:1: column 7", "missing", "\"tau2\""],
    );
    refused(
        |lines| drop(lines.remove(0)),
        &["data/A_2.csv:1: the first line holds numbers", "t,q1..qn,qd1..qdn,tau1..taun"],
    );
}

#[test]
fn other_separators_and_encodings() {
    let semicolons = |text: String| text.replace(',', ";").into_bytes();
    refused_bytes(semicolons, &["data/A_2.csv:1: the columns are separated by ';'", "by commas"]);
    let utf16 = |text: String| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    refused_bytes(
        |text| [vec![0xff, 0xfe], utf16(text)].concat(),
        &["data/A_2.csv:1: the file is UTF-16", "UTF-8"],
    );
    refused_bytes(utf16, &["data/A_2.csv:1: the file is not text"]);
    let latin1 =
        |text: String| text.replacen("0.010", "0.01\u{b0}", 1).chars().map(|c| c as u8).collect();
    refused_bytes(latin1, &["data/A_2.csv:3: t is", "not a finite number"]);
}

#[test]
fn nothing_recorded() {
    refused_bytes(|_| vec![], &["data/A_2.csv:1: the file is empty"]);
    refused(|lines| lines.truncate(1), &["data/A_2.csv: there is no sample", "leave the run out"]);
}

#[test]
fn a_time_twice_or_out_of_order() {
    refused(
        |lines| lines.insert(10, lines[9].clone()),
        &["data/A_2.csv:11: t = 0.080 s is the time of the line above"],
    );
    refused(|lines| lines.swap(10, 11), &["data/A_2.csv:12: t = 0.090 s is earlier", "sort"]);
}

#[test]
fn a_missing_sample() {
    let run = |lab: &Lab, more: &str| lab.conform(more);
    let lab = Lab::new();
    lab.edit("data/A_2.csv", |lines| drop(lines.remove(10)));
    run(&lab, "").fails_with(&[
        "data/A_2.csv:11: there is a gap of 0.02",
        "the limit is 0.019",
        "--max-gap",
    ]);
    run(&lab, "--max-gap 0.02").exits(0).notes("suite A: its runs differ in input or sample times");
}

#[test]
fn times_that_jitter_are_no_gaps() {
    let lab = Lab::new();
    for run in 1..=3 {
        lab.edit(&format!("data/A_{run}.csv"), |lines| {
            for (k, line) in lines.iter_mut().enumerate().skip(1) {
                let late = 0.004 * ((k * 7919 * run) as f64).sin();
                let time = format!("{:.6}", cell(line, 0) + late);
                set_cell(line, 0, &time);
            }
        });
    }
    lab.conform("--out model.json").exits(0).notes("suite A: its runs differ");
    lab.check("").exits(0);
}

#[test]
fn degrees() {
    let in_degrees = |lines: &mut Vec<String>, columns: &[usize]| {
        for line in &mut lines[1..] {
            for &column in columns {
                let value = format!("{:?}", cell(line, column).to_degrees());
                set_cell(line, column, &value);
            }
        }
    };
    let only_positions = |lines: &mut Vec<String>| in_degrees(lines, &[1, 2]);
    refused_by_conform(
        only_positions,
        &["A_2.csv: joint 1: q moves 57.", "degrees", "give q in rad"],
    );
    let only_velocities = |lines: &mut Vec<String>| in_degrees(lines, &[3, 4]);
    refused_by_conform(
        only_velocities,
        &["A_2.csv: joint 2: q moves 0.01", "degrees/s", "qd in rad/s"],
    );
    let both = |lines: &mut Vec<String>| in_degrees(lines, &[1, 2, 3, 4]);
    refused_by_conform(both, &["A_2.csv: joint 1: qd reaches", "the joint's limit is 3 rad/s"]);
}

#[test]
fn positions_far_beyond_the_limits() {
    let lab = Lab::new();
    let limited = crate::fixture::robot_toml()
        .replace("velocity_limit = 3.0", "position_limits = [-1.0, 1.0]");
    lab.write("arm.toml", limited);
    lab.conform("").exits(0);
    lab.edit("data/A_2.csv", |lines| set_cell(&mut lines[30], 2, "-11.5"));
    lab.conform("").fails_with(&[
        "data/A_2.csv: joint 2: |q| reaches 11.5",
        "limits are -1 and 1 rad",
        "give q in rad",
    ]);
}

/// Asserts that `conform` refuses a recording; `inspect` cannot check units, because it has no
/// robot.
#[track_caller]
fn refused_by_conform(change: impl FnOnce(&mut Vec<String>), parts: &[&str]) {
    let lab = Lab::new();
    lab.edit("data/A_2.csv", change);
    lab.conform("").fails_with(parts);
}

#[test]
fn a_recording_of_another_robot() {
    let lab = Lab::new();
    lab.run("conform --robot lwa4p --data data --torque motor").fails_with(&[
        "data/A_1.csv:1: the recording has 2 joints, but the robot has 6",
        "data/B_3.csv:1",
    ]);
}

#[test]
fn other_ways_to_write_the_same() {
    accepted(|text| text.replace('\n', "\r\n"));
    accepted(|text| format!("\u{feff}{text}"));
    accepted(|text| text.replace(',', " , "));
    accepted(|text| text.replace('\n', "\n\n"));
    accepted(|text| text.trim_end().to_string());
    accepted(|text| {
        text.replace(",tau2\n", ",tau2,note\n")
            .lines()
            .enumerate()
            .map(|(k, line)| extra(k, line))
            .collect()
    });
    accepted(|text| {
        let quoted = |line: &str| format!("\"{}\"\n", line.replace(',', "\",\""));
        text.lines().map(quoted).collect()
    });
}

fn extra(k: usize, line: &str) -> String {
    if k == 0 { format!("{line}\n") } else { format!("{line},anything\n") }
}

#[test]
fn times_since_1970_lose_nothing() {
    accepted(|text| {
        let shifted = |line: &str| match line.strip_prefix("0.") {
            Some(rest) => format!("1700000000.{rest}\n"),
            None => format!("{line}\n"),
        };
        text.lines().map(shifted).collect()
    });
}

#[test]
fn a_run_that_ends_early_is_used_and_noted() {
    let lab = Lab::new();
    lab.edit("data/A_2.csv", |lines| lines.truncate(31));
    lab.conform("--out model.json").exits(0).notes("suite A: its runs have 30 to 51 samples");
    lab.check("").exits(0);
    lab.edit("data/A_2.csv", |lines| lines.truncate(2));
    lab.conform("").exits(0).notes("suite A: its runs have 1 to 51 samples");
}
