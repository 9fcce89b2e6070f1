//! Options, their help and their errors.

use crate::fixture::{Lab, SAMPLES};

/// Largest number of lines of a screen.
const SCREEN: usize = 45;

/// Returns every command, from the reference.
fn commands(lab: &Lab) -> Vec<String> {
    let reference = lab.run("man --markdown").exits(0).stdout;
    let names = reference.lines().filter_map(|line| line.strip_prefix("## reachtube "));
    let names: Vec<String> = names.map(String::from).collect();
    assert!(names.len() > 20, "{names:?}");
    names
}

#[test]
fn help_fits_a_screen_and_begins_with_an_example() {
    let lab = Lab::new();
    for command in commands(&lab).iter().map(String::as_str).chain([""]) {
        let help = lab.run(&format!("{command} --help")).exits(0).stdout;
        assert!(help.lines().count() <= SCREEN, "{command}: {help}");
        assert!(help.lines().all(|line| line.chars().count() <= 100), "{command}: {help}");
        let [usage, example, options] =
            ["Usage: reachtube", "\nExample", "ptions:\n"].map(|part| help.find(part).unwrap());
        assert!(usage < example && example < options, "{command}: {help}");
        let of_group = command.split(' ').next().unwrap();
        assert!(help[example..options].contains(&format!("reachtube {of_group}")), "{help}");
        assert_eq!(lab.run(&format!("{command} -h")).exits(0).stdout, help);
    }
}

#[test]
fn help_all_has_every_option_and_example() {
    let lab = Lab::new();
    let reference = lab.run("man --markdown").exits(0).stdout;
    let (commands, mut count) = (commands(&lab), [0; 2]);
    let sections: Vec<&str> = reference.split("\n## reachtube ").skip(1).collect();
    assert_eq!(sections.len(), commands.len());
    for section in sections {
        let command = section.lines().next().unwrap();
        let all = lab.run(&format!("{command} --help-all")).exits(0).stdout;
        // The reference prints options that several commands of a group share with the group.
        let below = format!("{command} ");
        let of_group = commands.iter().filter(|own| own.starts_with(&below));
        let of_group: String =
            of_group.map(|own| lab.run(&format!("{own} --help-all")).exits(0).stdout).collect();
        let options = section.lines().filter_map(|line| line.strip_prefix("- `--"));
        for option in options.map(|line| line.split(['`', ' ']).next().unwrap()) {
            let option = format!("--{option}");
            assert!(all.contains(&option) || of_group.contains(&option), "{command}: {option}");
            count[0] += 1;
        }
        let short = lab.run(&format!("{command} --help")).exits(0).stdout;
        for call in short.lines().filter(|line| line.starts_with("  reachtube ")) {
            assert!(all.lines().any(|line| line == call), "{command}: {call}: {all}");
            count[1] += 1;
        }
        assert!(all.lines().all(|line| line.chars().count() <= 100), "{command}: {all}");
    }
    assert!(count[0] > 100 && count[1] >= commands.len(), "{count:?} options and examples");
    let conform = lab.run("conform --help-all").exits(0).stdout;
    assert!(conform.contains("velocities in rad/s") && conform.contains("Sets:"), "{conform}");
}

#[test]
fn the_first_screen_begins_with_the_commands_for_logs() {
    let lab = Lab::new();
    let screen = lab.run("--help").exits(0).stdout;
    assert!(screen.contains("Exit codes: 0 conformant (or done), 1 not conformant, 2 error"));
    let listed = screen.lines().filter_map(|line| line.strip_prefix("  "));
    let words = listed.filter(|line| line.starts_with(|c: char| c.is_lowercase()));
    let names: Vec<&str> = words.map(|line| line.split(' ').next().unwrap()).collect();
    let expected = "reachtube reachtube model check inspect export report verify stop monitor \
                    identify prepare conform abstract reach excite convert demo campaign \
                    reproduce robot completions man";
    assert_eq!(names.join(" "), expected);
    // Without a command, the same screen is an error.
    let bare = lab.run("").exits(2);
    assert_eq!(bare.stderr, screen);
}

/// A clone of the repository has a commit, a source archive has none.
#[test]
fn the_version_shows_the_commit() {
    let version = Lab::new().run("--version").exits(0).stdout;
    let rest = version.strip_prefix(concat!("reachtube ", env!("CARGO_PKG_VERSION"))).unwrap();
    if std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../.git")).exists() {
        let commit = rest.strip_prefix(" (").and_then(|rest| rest.strip_suffix(")\n")).unwrap();
        assert!(commit.len() == 12 && commit.bytes().all(|b| b.is_ascii_hexdigit()), "{version}");
    } else {
        assert_eq!(rest, "\n");
    }
}

#[test]
fn a_wrong_command_line_is_an_error() {
    let lab = Lab::new();
    for arguments in
        ["", "foo", "conform", "robot show", "conform --robot arm.toml --data data --torque raw"]
    {
        let run = lab.run(arguments).exits(2);
        assert!(
            run.stdout.is_empty() && run.stderr.contains("Usage")
                || run.stderr.contains("possible values")
        );
    }
}

#[test]
fn options_that_need_another_are_refused_without_it() {
    let lab = Lab::new();
    for (arguments, needed) in [
        ("inspect --data data --lock axis1=0", "--robot"),
        ("prepare --robot arm.toml --data data --torque link --out windows", "--compensate"),
    ] {
        let run = lab.run(arguments).exits(2);
        assert!(run.stderr.contains("required") && run.stderr.contains(needed), "{run:#?}");
    }
}

#[test]
fn numbers_that_do_not_fit() {
    let lab = Lab::new();
    lab.conform("--weights 0,1").fails_with(&["weight 1 is 0", "between 1e-9 and 1e9"]);
    lab.conform("--weights 1,2,3").fails_with(&[
        "--weights: 3 values given",
        "unit, 2 numbers",
        "or 4",
    ]);
    lab.conform("--weights Unit")
        .fails_with(&["--weights: \"Unit\" is not a number", "unit, 2 numbers"]);
    lab.conform("--noise -1,0").fails_with(&["noise radius 1 is -1", "between 0 and 1e9"]);
    lab.conform("--noise NaN,0").fails_with(&["noise radius 1 is NaN"]);
    lab.conform("--expansion 1,2,3").fails_with(&[
        "3 values",
        "the robot has 2 joints",
        "4 values",
    ]);
    lab.conform("--expansion inf,0").fails_with(&["inf", "finite"]);
    for option in ["--until 0", "--until -1", "--until NaN", "--max-gap 0", "--max-gap x"] {
        let run = lab.conform(option).exits(2);
        assert!(
            run.stdout.is_empty() && run.stderr.contains("give a number of seconds above 0"),
            "{run:?}"
        );
    }
}

#[test]
fn until_uses_the_beginning() {
    let lab = Lab::new();
    let model = lab.conform("--until 0.1 --json --out model.json").exits(0).json();
    assert_eq!(model["data"]["suites"][0]["runs"][0]["samples"], 11);
    assert_eq!(model["settings"]["until"], 0.1);
    let check = lab.check("--json").exits(0).json();
    assert_eq!((&check["rows"], &check["settings"]["until"]), (&(2 * 11 * 4).into(), &0.1.into()));
    lab.run("reach --model model.json --data data --out sets")
        .exits(0)
        .notes("samples later than 0.1 s after the first are not used");
    let model = lab.conform("--until 1e-6 --json").exits(0).json();
    assert_eq!(model["data"]["suites"][0]["runs"][0]["samples"], 1);
}

#[test]
fn every_setting_gives_a_model_that_its_own_check_accepts() {
    let lab = Lab::new();
    for options in [
        "--disturbance constant",
        "--disturbance measurable",
        "--centre origin",
        "--centre zero",
        "--states positions",
        "--weights 1,0.1",
        "--noise fitted",
        "--noise 0.001,0.01",
        "--noise 10,10",
        "--nominal own",
        "--expansion 0.3,-0.5,0.2,0.1",
        "--suites B,A",
    ] {
        // A measurement noise of 10 rad hides every motion.
        let code = if options == "--noise 10,10" { 3 } else { 0 };
        let run = lab.conform(&format!("{options} --json --out model.json"));
        let model = run.exits(code).json();
        assert_eq!(model["verified"], true, "{options}");
        let vacuous = model["usefulness"]["vacuous"].as_array().map_or(0, Vec::len);
        assert_eq!(vacuous > 0, code == 3, "{options}");
        let check = lab.check("--json").exits(code).json();
        assert_eq!(
            (&check["conformant"], &check["violations"]["count"]),
            (&true.into(), &0.into()),
            "{options}"
        );
    }
}

#[test]
fn suites_of_different_rates_go_together() {
    let lab = Lab::new();
    for run in 1..=3 {
        lab.edit(&format!("data/B_{run}.csv"), |lines| {
            let mut number = 0;
            lines.retain(|_| {
                number += 1;
                number == 1 || number % 2 == 0
            });
        });
    }
    let inspected = lab.run("inspect --data data --json").exits(0).json();
    assert_eq!(
        (&inspected["groups"][0]["step"], &inspected["groups"][1]["step"]),
        (&0.01.into(), &0.02.into())
    );
    let model = lab.conform("--json --out model.json").exits(0).json();
    assert_eq!(model["proof"]["rows"], 4 * (SAMPLES + SAMPLES.div_ceil(2)));
    lab.check("").exits(0);
}

#[test]
fn a_choice_that_is_no_option_is_said_to_be_a_key() {
    let lab = Lab::new();
    let words = "--cut-off is no option, but cut-off is a key of the settings";
    lab.run("model --robot arm.toml --cut-off 3 --out out").fails_with(&[words]);
    // Other commands have no such choice, or have it as an option.
    let run = lab.run("reach --largest-ratio 3").exits(2);
    assert!(run.stderr.contains("unexpected argument '--largest-ratio'"), "{}", run.stderr);
}
