//! What a terminal shows: notes as asked for, no codes from files, completions and manual pages.

use crate::fixture::{Lab, robot_toml};

#[test]
fn quiet_and_verbose() {
    let lab = Lab::new();
    std::fs::copy(lab.path("data/A_1.csv"), lab.path("data/A_4.csv")).unwrap();
    lab.conform("--out model.json").exits(0).notes("is not in runs.csv");
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
    assert!(cut.stderr.lines().count() < 8, "{}", cut.stderr);
    cut.notes("(25 files: C_0.csv, C_1.csv, C_2.csv, ..)");
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
    for name in ["reachtube.1", "reachtube-conform.1", "reachtube-robot-show.1"] {
        assert!(pages.iter().any(|page| page == name), "{pages:?}");
    }
    assert!(lab.read("pages/reachtube-conform.1").contains("max\\-gap"));
}

/// The folder is laid out as /usr/share, and a second run may replace what the first one wrote.
#[test]
fn a_package_gets_all_scripts_and_pages_by_one_command() {
    let lab = Lab::new();
    for _ in 0..2 {
        lab.run("completions --out share").exits(0).notes("5 completion scripts and");
    }
    for (shell, place) in [
        ("bash", "bash-completion/completions/reachtube"),
        ("elvish", "elvish/lib/reachtube.elv"),
        ("fish", "fish/vendor_completions.d/reachtube.fish"),
        ("powershell", "powershell/reachtube.ps1"),
        ("zsh", "zsh/site-functions/_reachtube"),
    ] {
        let script = lab.run(&format!("completions {shell}")).exits(0).stdout;
        assert_eq!(lab.read(&format!("share/{place}")), script);
    }
    assert!(lab.read("share/zsh/site-functions/_reachtube").starts_with("#compdef reachtube\n"));
    lab.run("man --out pages").exits(0);
    let pages = lab.names("pages");
    assert_eq!(pages, lab.names("share/man/man1"));
    // One page for each section of the reference, and one for the whole.
    let reference = lab.run("man --markdown").exits(0).stdout;
    let sections = reference.lines().filter(|line| line.starts_with("## reachtube")).count();
    assert_eq!(pages.len(), sections + 1, "{pages:?}");
    lab.run("completions").exits(2);
    lab.run("completions bash --out share").exits(2);
}

/// A shell that loads the script offers the commands, and the options of a command.
#[test]
fn bash_completes_commands_and_options() {
    let lab = Lab::new();
    let has_bash = std::process::Command::new("bash").arg("--version").output().is_ok();
    if !has_bash {
        return;
    }
    lab.run("completions --out share").exits(0);
    let complete = |words: &str, last: usize| {
        let script = format!(
            "source share/bash-completion/completions/reachtube; COMP_WORDS=({words}); \
             COMP_CWORD={last}; _reachtube reachtube \"${{COMP_WORDS[{last}]}}\" \
             \"${{COMP_WORDS[{last}-1]}}\"; \
             echo \"${{COMPREPLY[@]}}\""
        );
        let mut bash = std::process::Command::new("bash");
        let output = bash.args(["-c", &script]).current_dir(lab.path(".")).output().unwrap();
        assert!(output.stderr.is_empty(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    assert_eq!(complete("reachtube con", 1), "conform convert\n");
    assert_eq!(complete("reachtube conform --calib", 2), "--calibrate\n");
    assert_eq!(complete("reachtube conform --notion ph", 3), "phase-plane\n");
}

/// The page is made from the definitions of the options, so that it cannot go stale.
#[test]
fn the_reference_in_docs_is_up_to_date() {
    let reference = Lab::new().run("man --markdown").exits(0).stdout;
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/cli.md");
    assert!(
        std::fs::read_to_string(path).unwrap() == reference,
        "docs/cli.md is stale: run `cargo run -p reachtube-cli -- man --markdown > docs/cli.md`"
    );
    let long =
        reference.lines().find(|line| line.chars().count() > 100 && !line.starts_with("    "));
    assert_eq!(long, None);
    for option in ["--calibrate <MOTION,..>", "--lock <JOINT=VALUE>", "Exit codes: 0 done, 1 a"] {
        assert!(reference.contains(option), "{option}");
    }
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
