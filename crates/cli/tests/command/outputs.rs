//! Output files are written whole or not at all, and standard output holds results only.

use std::process::Stdio;

use crate::fixture::{Lab, Run};

#[test]
fn a_place_that_cannot_be_written_is_found_before_the_work() {
    let lab = Lab::new();
    lab.conform("--out data").fails_with(&["data: cannot write: it is a folder"]);
    lab.conform("--out arm.toml/model.json")
        .fails_with(&["arm.toml: this is a file, but a folder is needed"]);
    lab.conform("--report arm.toml").fails_with(&["arm.toml: this is a file"]);
    lab.conform("--out model.json").exits(0);
    for command in ["reach", "report"] {
        lab.run(&format!(
            "{command} --model model.json --data data --torque compensated --out arm.toml"
        ))
        .fails_with(&["arm.toml: this is a file, but a folder is needed; give another name"]);
    }
    assert_eq!(lab.names("."), ["arm.toml", "data", "model.json"]);
    assert_eq!(lab.read("arm.toml"), crate::fixture::robot_toml());
}

#[test]
fn an_error_leaves_the_old_model() {
    let lab = Lab::new();
    lab.write("model.json", "old");
    lab.edit("data/A_2.csv", |lines| lines.truncate(1));
    lab.conform("--out model.json").exits(2);
    assert_eq!(lab.read("model.json"), "old");
}

/// Opens a device that is always full.
#[cfg(target_os = "linux")]
fn full() -> std::fs::File {
    std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let lab = Lab::new();
    let link = lab.path("full");
    std::os::unix::fs::symlink("/dev/full", &link).unwrap();
    lab.conform("--out full").fails_with(&[
        "full: cannot write",
        "No space left",
        "choose a place with room",
    ]);
    assert!(link.is_symlink());
    lab.conform("--out model.json").exits(0);
    let arguments = [
        "conform --robot arm.toml --data data --torque compensated --json",
        "check --model model.json --data data --torque compensated",
        "inspect --data data",
        "robot show arm.toml --json",
    ];
    for arguments in arguments {
        let run = Run::of(lab.command(arguments).stdout(full()).output().unwrap());
        let parts = &["standard output: cannot write", "make room"];
        if arguments.contains("--json") {
            run.fails_in_json("file", parts);
        } else {
            run.fails_with(parts);
        }
        let run = Run::of(lab.command(arguments).stderr(full()).output().unwrap()).exits(0);
        assert!(!run.stdout.is_empty());
    }
    let run = Run::of(
        lab.command("check --model none --data data --torque motor")
            .stderr(full())
            .output()
            .unwrap(),
    );
    run.exits(2);
}

#[test]
fn a_reader_that_closes_the_pipe_is_not_an_error() {
    let lab = Lab::new();
    for arguments in [
        "robot show lwa4p --json",
        "conform --robot arm.toml --data data --torque compensated --json",
    ] {
        let mut child =
            lab.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
    }
}

#[test]
fn results_and_errors_are_json() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    let with = "--model model.json --data data --torque compensated";
    for (arguments, key) in [
        ("inspect --data data", "groups"),
        ("robot show arm.toml", "mass_matrix"),
        ("conform --robot arm.toml --data data --torque compensated", "input_set"),
        (&format!("check {with}"), "violations"),
        (&format!("reach {with} --out reach"), "reach"),
        (&format!("report {with} --out report"), "report"),
    ] {
        let found = lab.run(&format!("--json {arguments}")).exits(0).json();
        assert!(!found[key].is_null(), "{arguments}");
        let mended = arguments.replace("data data", "data none").replace("arm.toml", "none.toml");
        lab.run(&format!("{mended} --json")).fails_in_json(
            if arguments.starts_with("robot") || arguments.starts_with("conform") {
                "robot"
            } else {
                "file"
            },
            &["none"],
        );
    }
}
