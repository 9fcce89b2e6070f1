//! Answers of a few lines, and colours on a terminal.

use crate::fixture::{Lab, cell, set_cell};

/// Asserts that an answer is at most 18 lines of 100 columns and begins with the verdict.
#[track_caller]
pub(crate) fn is_short(text: &str, verdict: &str) {
    assert!(text.starts_with(verdict), "{text}");
    assert!(text.lines().count() <= 18, "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
}

/// Moves a position of each recording of a suite out of the sets.
fn spoil(lab: &Lab, suite: &str) {
    for run in 1..=3 {
        lab.edit(&format!("data/{suite}_{run}.csv"), |lines| {
            let moved = format!("{:?}", cell(&lines[21], 1) + 0.5);
            set_cell(&mut lines[21], 1, &moved);
        });
    }
}

#[test]
fn an_answer_has_verdict_sets_and_what_to_do() {
    let lab = Lab::new();
    let text = lab.conform("--out model.json --report page").exits(0).stdout;
    is_short(
        &text,
        "conformant: 6 recordings in 2 suites; 408 of 408 rows proved, up to 0.500 s\n",
    );
    for part in [
        "  joint   q at 0.500 s [rad]   of motion   qd [rad/s]   ",
        "\n  axis1   ",
        "factor for a motion left out: at most ",
        "new motions: ",
        "\nwrote: model.json, page/report.html\nnext: ",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let text = lab.check("").exits(0).stdout;
    is_short(&text, "conformant: 6 recordings; 0 of 408 rows outside the reachable set");
    assert!(text.contains("new motions: no guarantee: the model was fitted to some"), "{text}");
    // The whole report is as long as before.
    let whole = lab.conform("--verbose").exits(0).stdout;
    assert!(whole.lines().count() > 15 && whole.contains("margin [rad, rad/s]"), "{whole}");
}

#[test]
fn failing_suites_come_first() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    spoil(&lab, "B");
    let text = lab.check("").exits(1).stdout;
    is_short(&text, "not conformant: 6 recordings; ");
    assert!(text.contains("The recordings differ from the model's own: "), "{text}");
    let mut rows = text.lines().skip_while(|line| !line.starts_with("  suite "));
    assert!(rows.next().unwrap().starts_with("  suite   rows   outside   "), "{text}");
    assert!(rows.next().unwrap().starts_with("  B "), "{text}");
    assert!(!text.contains("\n  A "), "{text}");
    for part in ["in 1 of 2 suites", "widest sets at 0.500 s: ± ", "covered, without a proof, if: "]
    {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    let whole = lab.check("--verbose").exits(1).stdout;
    assert!(whole.find("\n  B ").unwrap() < whole.find("\n  A ").unwrap(), "{whole}");
    // JSON keeps the order of the recordings.
    let json = lab.check("--json").exits(1).json();
    assert_eq!([&json["suites"][0]["suite"], &json["suites"][1]["suite"]], ["A", "B"]);
}

#[test]
fn answers_of_joints_and_warnings_are_short() {
    let lab = Lab::new();
    let wide = lab.conform("--noise 10,10 --out model.json").exits(3).stdout;
    is_short(&wide, "conformant, but vacuous: 6 recordings in 2 suites");
    assert!(wide.contains("\nvacuous for joints 1, 2: ") && wide.contains("\nwarning: "), "{wide}");
    is_short(&lab.check("").exits(3).stdout, "conformant, but vacuous: 6 recordings");
}

/// Asserts that the answers of the two commands of the demo are short, and good.
pub(crate) fn is_short_of_the_demo(text: &str) {
    let typed = |line: &str| line.starts_with("$ reachtube ");
    let [first, rest] = [text.lines().next().unwrap(), text.split_once('\n').unwrap().1];
    assert!(typed(first) && first.contains(" model ") && first.ends_with(" --out demo"), "{first}");
    let (model, rest) = rest.split_once("\n\n").unwrap();
    is_short(model, "conformant and useful up to ");
    let (second, check) = rest.split_once('\n').unwrap();
    assert!(typed(second) && second.contains(" check --model demo/model.json "), "{second}");
    is_short(check, "conformant: ");
    assert!(check.contains(" 0 of ") && check.contains("(0 of 4\n"), "{check}");
}

/// The tool `script` of util-linux runs a command on a terminal.
#[cfg(target_os = "linux")]
#[test]
fn only_a_terminal_has_colours() {
    let lab = Lab::new();
    assert!(!lab.conform("--out model.json").exits(0).stdout.contains('\u{1b}'));
    let on_terminal = |command: &str| {
        let line = format!("{} {command}", env!("CARGO_BIN_EXE_reachtube"));
        let mut script = std::process::Command::new("script");
        script.args(["-qec", &line, "/dev/null"]).current_dir(lab.path("."));
        script.env("TERM", "xterm-256color").env_remove("NO_COLOR").env_remove("CI");
        script
    };
    let check = "check --model model.json --data data";
    let Ok(output) = on_terminal(check).output() else {
        assert!(std::env::var_os("CI").is_none(), "there is no tool `script`");
        return;
    };
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("\u{1b}[32mconformant\u{1b}[0m: 6 recordings"), "{text:?}");
    let output = on_terminal("check --model none.json --data data").output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("\u{1b}[31merror\u{1b}[0m: none.json"), "{text:?}");
    let output = on_terminal(check).env("NO_COLOR", "1").output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("conformant: 6 recordings") && !text.contains("\u{1b}[3"), "{text:?}");
}
