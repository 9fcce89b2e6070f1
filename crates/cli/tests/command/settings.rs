//! `conform --settings FILE`.

use crate::fixture::Lab;

const SETTINGS: &str = "\
robot = \"arm.toml\"
data = \"data\"
suites = [\"A\"]
torque = \"compensated\"
weights = [1, 0.5]
until = 0.25
";

#[test]
fn a_file_gives_what_the_options_give() {
    let lab = Lab::new();
    std::fs::create_dir(lab.path("below")).unwrap();
    // Paths are relative to the file's folder.
    let text = SETTINGS.replace("arm.toml", "../arm.toml").replace("\"data\"", "\"../data\"");
    lab.write("below/settings.toml", text);
    let typed = lab.conform("--suites A --weights 1,0.5 --until 0.25 --json").exits(0).json();
    let found = lab.run("conform --settings below/settings.toml --json").exits(0).json();
    for key in ["settings", "cost", "initial_set", "input_set", "robot"] {
        assert_eq!(found[key], typed[key], "{key}");
    }
}

#[test]
fn the_command_line_comes_first() {
    let lab = Lab::new();
    lab.write("settings.toml", SETTINGS.to_string() + "centre = \"zero\"\n");
    let run = lab.run("conform --settings settings.toml --suites B --centre free --json").exits(0);
    let found = run.json();
    assert_eq!(found["settings"]["centre"], "free");
    assert_eq!(found["data"]["suites"][0]["name"], "B");
    assert_eq!(found["settings"]["until"], 0.25);
}

/// Every option of the help is a key, apart from the file itself and the global options.
#[test]
fn every_option_is_a_key() {
    let lab = Lab::new();
    let help = lab.run("conform --help-all").exits(0).stdout;
    let own = help.split("Global options:").next().unwrap();
    let names = own.lines().filter_map(|line| line.trim_start().strip_prefix("--"));
    let names: Vec<&str> = names.map(|line| line.split(' ').next().unwrap()).collect();
    lab.write("settings.toml", "no-option = 1\n");
    let error = lab.run("conform --settings settings.toml").fails_with(&["settings.toml:1:"]);
    assert!(names.len() > 15, "{names:?}");
    for name in names.iter().filter(|name| **name != "settings") {
        assert!(error.stderr.contains(name), "{name} is not in {}", error.stderr);
    }
}

#[test]
fn wrong_files_are_refused_with_the_line() {
    let lab = Lab::new();
    for (from, to, parts) in [
        (
            "until = 0.25",
            "untill = 0.25",
            &["settings.toml:6: untill: there is no such option"][..],
        ),
        ("until = 0.25", "until = -1", &["settings.toml:6: until", "seconds above 0"]),
        ("until = 0.25", "until = true", &["settings.toml:6: until", "boolean does not fit"]),
        ("until = 0.25", "until = { a = 1 }", &["settings.toml:6: until", "table does not fit"]),
        ("until = 0.25", "until = ", &["settings.toml: TOML parse error at line 6"]),
        ("until = 0.25", "until = 0.25\nuntil = 1", &["line 7", "duplicate key"]),
        (
            "until = 0.25",
            "settings = \"a\"",
            &["settings.toml:6: settings: there is no such option"],
        ),
        ("until = 0.25", "json = true", &["settings.toml:6: json: there is no such option"]),
        ("\"compensated\"", "\"raw\"", &["settings.toml:4: torque", "compensated, motor, link"]),
        ("[\"A\"]", "[\"A,B\"]", &["settings.toml:3: suites", "holds a comma"]),
        ("[\"A\"]", "\"C\"", &["there is no suite \"C\""]),
        ("[1, 0.5]", "[1, [0.5]]", &["settings.toml:5: weights", "array does not fit"]),
        ("\"arm.toml\"", "\"none.toml\"", &["cannot read robot `none.toml`"]),
    ] {
        assert!(SETTINGS.contains(from));
        lab.write("settings.toml", SETTINGS.replacen(from, to, 1));
        lab.run("conform --settings settings.toml").fails_with(parts);
    }
    lab.run("conform --settings nowhere.toml")
        .fails_with(&["nowhere.toml: cannot read", "docs/reference.md"]);
    lab.write("settings.toml", "robot = \"arm.toml\"\n");
    let incomplete = lab.run("conform --settings settings.toml").exits(2).stderr;
    assert!(incomplete.contains("--data") && !incomplete.contains("\n  --robot"), "{incomplete}");
}
