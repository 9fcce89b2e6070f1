//! No command overwrites a file of others without `--force`, and none writes more than was meant.

use crate::fixture::{Lab, robot_toml};

const MINE: &str = "mine\n";

/// A log of one joint for `prepare`, 2 s long.
fn log() -> String {
    let line = |k: u32| {
        let t = f64::from(k) * 0.01;
        format!("{t:.2},{:.6},{:.6},{:.6}\n", (3.0 * t).sin(), 3.0 * (3.0 * t).cos(), t.cos())
    };
    format!("t,q1,qd1,tau1\n{}", (0..201).map(line).collect::<String>())
}

fn lab() -> Lab {
    let lab = Lab::new();
    let toml = robot_toml();
    let (one, _) = toml.rsplit_once("[[joint]]").unwrap();
    lab.write("one.toml", one);
    lab.write("log.csv", log());
    lab
}

#[test]
fn files_of_others_are_overwritten_with_force_only() {
    let with = "--data data --torque compensated";
    let conform = format!("conform --robot arm.toml {with}");
    let reach = format!("reach --model model.json {with} --suites A");
    let excite = "excite --robot arm.toml --period 1 --harmonics 2";
    let prepare = "prepare --robot one.toml --data log.csv --cut-off 10";
    for (file, command) in [
        ("m.json", format!("{conform} --out m.json")),
        ("page/report.html", format!("{conform} --report page")),
        ("page/A_motion.svg", format!("{conform} --report page")),
        ("page/report.html", format!("report --model model.json {with} --out page")),
        ("sets/A.csv", format!("{reach} --out sets")),
        ("sets/A_tube.csv", format!("{reach} --out sets")),
        ("sets/A_motion.svg", format!("{reach} --out sets")),
        ("a.json", "abstract --robot arm.toml --out a.json".into()),
        ("e.csv", format!("{excite} --out e.csv")),
        ("windows/runs.csv", format!("{prepare} --out windows")),
        ("windows/0001_log.csv", format!("{prepare} --out windows")),
        ("pages/reachtube.1", "man --out pages".into()),
    ] {
        let lab = lab();
        lab.conform("--out model.json").exits(0);
        let folder = lab.path(file).parent().unwrap().to_path_buf();
        std::fs::create_dir_all(&folder).unwrap();
        lab.write(file, MINE);
        let before = std::fs::read_dir(&folder).unwrap().count();
        let run = lab.run(&command).exits(2);
        assert!(run.stderr.contains(&format!("{file}: a file of this name exists")), "{run:?}");
        assert_eq!((lab.read(file).as_str(), run.stdout.contains("wrote")), (MINE, false));
        // The refusal comes before any other file of the result.
        let more = if file == "page/A_motion.svg" { 0 } else { before };
        assert!(std::fs::read_dir(&folder).unwrap().count() >= more, "{command}");
        lab.run(&format!("{command} --force")).exits(0);
        assert_ne!(lab.read(file), MINE, "{command}");
    }
}

#[test]
fn own_files_are_replaced() {
    let lab = lab();
    for _ in 0..2 {
        lab.conform("--out model.json --report page").exits(0);
        lab.run("abstract --robot arm.toml --out a.json").exits(0);
        lab.run("man --out pages").exits(0);
    }
}

#[test]
fn a_demo_leaves_other_folders_alone() {
    let lab = Lab::new();
    std::fs::create_dir_all(lab.path("out/recordings")).unwrap();
    lab.write("out/recordings/README.md", MINE);
    lab.run("demo --out out").fails_with(&[
        "out/recordings",
        "no campaign has written",
        "empty folder",
    ]);
    assert_eq!(lab.read("out/recordings/README.md"), MINE);
    lab.write("out/model.json", MINE);
    lab.run("demo --out out").fails_with(&["out/model.json: a file of this name exists"]);
}

#[test]
fn a_campaign_leaves_other_folders_alone() {
    let lab = Lab::new();
    std::fs::create_dir_all(lab.path("out")).unwrap();
    lab.write("out/README.md", MINE);
    lab.run("campaign --out out").fails_with(&["out", "no campaign has written", "empty folder"]);
    assert_eq!(lab.read("out/README.md"), MINE);
}

#[test]
fn an_exciting_motion_has_a_limit() {
    let lab = Lab::new();
    let excite = |more: &str| lab.run(&format!("excite --robot arm.toml --out e.csv {more}"));
    excite("--period 1e9").fails_with(&[
        "--period 1000000000 s at --rate 100 Hz gives 100000000001 samples",
        "7700000 MB of CSV",
        "--most-samples",
    ]);
    excite("--period 10000").fails_with(&["1000001 samples", "77 MB"]);
    excite("--period 1e300 --rate 1e300").fails_with(&["inf samples"]);
    assert!(!lab.path("e.csv").exists());
    excite("--period 20 --most-samples 2000").fails_with(&["2001 samples", "at most 2000"]);
    excite("--period 20 --most-samples 2001").exits(0);
    assert_eq!(lab.read("e.csv").lines().count(), 2002);
    let many = excite("--harmonics 1001").exits(2);
    assert!(many.stderr.contains("1001 is not in 1..=1000"), "{many:?}");
}

#[test]
fn windows_longer_than_the_recordings_are_an_error() {
    let lab = lab();
    let prepare = "prepare --robot one.toml --data log.csv --cut-off 10 --out windows";
    lab.run(&format!("{prepare} --window 1000")).fails_with_last(&[
        "no recording is left",
        "the windows are 1000 s long",
        "lasts 1.500 s",
        "give a shorter --window",
    ]);
    assert!(!lab.path("windows").exists());
    let run = lab.run(&format!("{prepare} --window 1 --json")).exits(0).notes("wrote 1 recordings");
    crate::output_schema::fits("prepare", &run.json());
}
