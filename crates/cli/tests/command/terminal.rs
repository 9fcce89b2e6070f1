//! What a terminal shows: notes as asked for, no codes from files, completions and manual pages.

use crate::fixture::{Lab, robot_toml};

#[test]
fn quiet_and_verbose() {
    let lab = Lab::new();
    std::fs::copy(lab.path("data/A_1.csv"), lab.path("data/A_4.csv")).unwrap();
    lab.conform("--out model.json").exits(0).notes("is not in runs.csv").notes("wrote model.json");
    for option in ["--quiet", "-q"] {
        let run = lab.conform(&format!("--out model.json {option}")).exits(0);
        assert!(run.stderr.is_empty() && !run.stdout.is_empty(), "{run:?}");
    }
    lab.run("--quiet inspect --data none").fails_with(&["none/runs.csv"]);
    for name in 0..25 {
        let folder = lab.path("data");
        std::fs::copy(folder.join("A_1.csv"), folder.join(format!("C_{name}.csv"))).unwrap();
        lab.edit("data/runs.csv", |lines| {
            lines[0] = "file,suite,motion,sha256".into();
            lines
                .iter_mut()
                .filter(|line| line.matches(',').count() == 2)
                .for_each(|line| *line += ",");
            lines.push(format!("C_{name}.csv,A,motion A,{name}"));
        });
    }
    let cut = lab.run("inspect --data data").exits(0);
    assert_eq!(cut.stderr.lines().count(), 21, "{}", cut.stderr);
    cut.notes("more notes; --verbose prints all");
    let all = lab.run("inspect --data data --verbose").exits(0).notes("reading recordings");
    assert!(
        all.stderr.lines().count() > 25 && !all.stderr.contains("more notes"),
        "{}",
        all.stderr
    );
    let both = lab.run("inspect --data data -q -v").exits(2).stderr;
    assert!(both.contains("cannot be used with"), "{both}");
}

/// Names in files can hold codes that clear the screen or pretend to be a line of the result.
#[test]
fn control_characters_are_not_printed_raw() {
    let lab = Lab::new();
    lab.write("arm.toml", robot_toml().replace("axis1", "\\u001b[2Jaxis\\nconformant"));
    lab.edit("data/runs.csv", |lines| {
        lines.iter_mut().for_each(|line| *line = line.replace(",A,", ",A\u{1b}[31m\u{9b}m,"));
    });
    lab.conform("--out model.json").exits(0);
    let commands = [
        "inspect --data data",
        "inspect --data data --json",
        "robot show arm.toml",
        "robot show arm.toml --json",
        "conform --robot arm.toml --data data --torque compensated",
        "conform --robot arm.toml --data data --torque compensated --json",
        "check --model model.json --data data --torque compensated",
        "reach --model model.json --data data --torque compensated --out sets",
        "conform --robot arm.toml --data data --torque compensated --suites C",
    ];
    for command in commands {
        let run = lab.run(command);
        let raw = |text: &str| text.chars().any(|c| c.is_control() && c != '\n');
        assert!(!raw(&run.stdout) && !raw(&run.stderr), "{command}: {run:?}");
        assert!(!run.stdout.lines().any(|line| line.starts_with("conformant |")), "{command}");
    }
    let shown = lab.run("robot show arm.toml").stdout;
    assert!(shown.contains("\\u{1b}[2Jaxis\\nconformant"), "{shown}");
}

#[test]
fn completions_and_manual_pages_name_every_command() {
    let lab = Lab::new();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = lab.run(&format!("completions {shell}")).exits(0).stdout;
        assert!(["conform", "max-gap", "reproduce"].iter().all(|word| script.contains(word)));
    }
    let page = lab.run("man").exits(0).stdout;
    assert!(page.contains(".TH reachtube 1") && page.contains("reachtube\\-conform"), "{page}");
    lab.run("man --out pages").exits(0).notes("pages to pages");
    let pages = lab.names("pages");
    for name in ["reachtube.1", "reachtube-conform.1", "reachtube-reproduce-table1.1"] {
        assert!(pages.iter().any(|page| page == name), "{pages:?}");
    }
    assert!(lab.read("pages/reachtube-conform.1").contains("max\\-gap"));
}

#[test]
fn another_torque_than_the_models_is_refused() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    for command in ["check", "reach", "report"] {
        let run = lab.run(&format!("{command} --model model.json --data data --torque motor"));
        run.fails_with(&["--torque motor", "found with --torque compensated", "run conform"]);
    }
    lab.run("check --model model.json --data data --torque link --json")
        .fails_in_json("setting", &["--torque link"]);
}
