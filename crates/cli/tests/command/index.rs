//! Defects of the index, and notes about unusual data sets.

use crate::fixture::Lab;

#[track_caller]
fn refused(change: impl FnOnce(&mut Vec<String>), parts: &[&str]) {
    let lab = Lab::new();
    lab.edit("data/runs.csv", change);
    lab.conform("").fails_with(parts);
    lab.run("inspect --data data --json").fails_in_json("recordings", parts);
}

#[test]
fn a_missing_folder_or_index() {
    let lab = Lab::new();
    let conform =
        |data: &str| lab.run(&format!("conform --robot arm.toml --data {data} --torque motor"));
    conform("nowhere").fails_with(&["nowhere/runs.csv: cannot read", "give the folder"]);
    conform("data/A_1.csv").fails_with(&["data/A_1.csv/runs.csv: cannot read", "give the folder"]);
}

#[test]
fn columns_that_are_not_there() {
    let header = |text: &'static str| move |lines: &mut Vec<String>| lines[0] = text.into();
    refused(header("path,suite,motion"), &["data/runs.csv:1: there is no column \"file\""]);
    refused(
        header("file;suite;motion"),
        &["data/runs.csv:1: there is no column \"suite\"", "file;suite;motion"],
    );
    refused(|lines| lines.truncate(1), &["data/runs.csv: no run is listed"]);
}

#[test]
fn lines_that_are_wrong() {
    refused(
        |lines| lines.push("A_1.csv,A,motion A".into()),
        &["data/runs.csv:8: \"A_1.csv\" is listed on line 2"],
    );
    refused(
        |lines| lines.push("./A_1.csv,A,motion A".into()),
        &["data/runs.csv:8:", "is listed on line 2"],
    );
    refused(
        |lines| lines.push("A_9.csv,A,motion A".into()),
        &["data/runs.csv:8: \"A_9.csv\" is not a file", "take the line out"],
    );
    refused(
        |lines| lines.insert(1, "\nA_9.csv".into()),
        &["data/runs.csv:3: the line has 1 fields, but the header has 3"],
    );
    refused(
        |lines| lines[2] = "A_2.csv,A,motion B".into(),
        &["data/runs.csv:3: suite A has the motion \"motion B\" here", "line 2"],
    );
}

#[test]
fn suites_that_are_not_there() {
    let lab = Lab::new();
    lab.conform("--suites A,C").fails_with(&["there is no suite \"C\"", "the data set has A, B"]);
    lab.conform("--suites A,C*").fails_with(&["there is no suite \"C*\"", "the data set has A, B"]);
    for (patterns, suites) in [("*", ["A", "B"]), ("B,?", ["B", "A"])] {
        let model = lab.conform(&format!("--suites {patterns} --json")).exits(0).json();
        let found: Vec<_> = model["data"]["suites"].as_array().unwrap().iter().collect();
        assert_eq!([&found[0]["name"], &found[1]["name"]], suites, "{patterns}");
    }
    lab.conform("--suites A,A").fails_with(&["named twice", "once"]);
    lab.edit("data/runs.csv", |lines| {
        lines[1..]
            .iter_mut()
            .for_each(|line| *line = line.replace(",A,", ",,").replace(",B,", ",,"))
    });
    lab.conform("").fails_with(&["no run has a suite", "by the column suite"]);
    lab.run("inspect --data data").exits(0);
}

#[test]
fn every_unused_file_is_noted() {
    let lab = Lab::new();
    std::fs::copy(lab.path("data/A_1.csv"), lab.path("data/A_4.csv")).unwrap();
    lab.conform("--suites A").exits(0).notes("A_4.csv is not in runs.csv and is not used").notes(
        "3 of the 6 runs in data/runs.csv are used: 3 belong to suites that were not selected",
    );
    lab.edit("data/runs.csv", |lines| lines.push("A_4.csv,A,motion A".into()));
    lab.conform("").exits(0).notes("A_4.csv is a copy of A_1.csv");
}

#[test]
fn a_changed_file_is_noted() {
    let lab = Lab::new();
    lab.edit("data/runs.csv", |lines| {
        lines[0] += ",sha256";
        lines[1..].iter_mut().for_each(|line| line.push_str(&format!(",{}", "0".repeat(64))));
    });
    for run in [lab.conform("-v").exits(0), lab.run("inspect --data data -v").exits(0)] {
        run.notes("B_3.csv: its SHA-256 is not the one in runs.csv (line 7)");
    }
}

#[test]
fn inconsistent_velocities_are_noted() {
    let lab = Lab::new();
    lab.edit("data/A_2.csv", |lines| {
        for line in &mut lines[1..] {
            let slower = format!("{:?}", crate::fixture::cell(line, 3) / 5.0);
            crate::fixture::set_cell(line, 3, &slower);
        }
    });
    // The set of that joint becomes as wide as its motion.
    lab.conform("").exits(3).notes("A_2.csv: joint 1: q moves 5.0");
}
