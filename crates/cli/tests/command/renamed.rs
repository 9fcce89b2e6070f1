//! Options that had another name.

use crate::fixture::Lab;

#[test]
fn old_options_fail_with_the_new_name() {
    let lab = Lab::new();
    for (command, old, new) in [
        ("abstract --robot lwa4p", "--at 0,0.5,0,0,0,0", "--at is now --expansion"),
        ("abstract --robot lwa4p", "--model 2", "--model is now --paper-model"),
        ("robot show lwa4p", "--at 0,0.5,0,0,0,0", "--at is now --expansion"),
        ("conform --robot arm.toml --data data", "--model 2", "--model is now --paper-model"),
        ("conform --robot arm.toml --data data", "--model=2", "--model is now --paper-model"),
        ("convert --robot lwa4p --out out", "--log run.mcap", "--log is now --data"),
        ("identify --robot arm.toml", "--link-torque", "--link-torque is now --torque link"),
        ("prepare --robot arm.toml --out out", "--logs a.csv", "--logs is now --data"),
    ] {
        lab.run(&format!("{command} {old}")).fails_with(&[new]);
        lab.run(&format!("{command} {old} --json")).fails_in_json("usage", &[new]);
    }
    // Other commands never had them.
    let run = lab.run("demo --model 2").exits(2);
    assert!(run.stderr.contains("unexpected argument '--model'"), "{}", run.stderr);
}

#[test]
fn a_choice_that_is_no_option_is_said_to_be_a_key() {
    let lab = Lab::new();
    let words = "--cut-off is no option, but cut-off is a key of the settings";
    lab.run("model --robot arm.toml --cut-off 3 --out out").fails_with(&[words]);
    // Other commands have no such choice, or have it as an option.
    lab.run("reach --largest-ratio 3").fails_with(&["unexpected argument '--largest-ratio'"]);
}

#[test]
fn old_keys_of_a_settings_file_fail_with_the_new_name() {
    let lab = Lab::new();
    let settings = "robot = \"arm.toml\"\ndata = \"data\"\ntorque = \"motor\"\n";
    lab.write("settings.toml", format!("{settings}model = 2\n"));
    lab.run("conform --settings settings.toml")
        .fails_with(&["settings.toml:4: model: the option is now paper-model"]);
    lab.write("settings.toml", settings);
    lab.run("conform --settings settings.toml --model 2")
        .fails_with(&["--model is now --paper-model"]);
    // The new key is an option of the command.
    lab.write("settings.toml", format!("{settings}paper-model = 4\n"));
    lab.run("conform --settings settings.toml")
        .fails_with(&["settings.toml:4: paper-model: invalid value '4'"]);
}

#[test]
fn a_remedy_in_a_file_of_an_earlier_version_has_the_new_name() {
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    let mut model: serde_json::Value = serde_json::from_str(&lab.read("model.json")).unwrap();
    model["warnings"] = serde_json::json!([{
        "kind": "unexplained",
        "joints": [1],
        "text": "The nominal motion explains little.",
        "remedy": {"setting": "model", "value": "3", "effect": "with order 2 follows it."},
    }]);
    lab.write("model.json", crate::fixture::sealed(model));
    let run = lab.check("--verbose").exits(0);
    assert!(run.stderr.contains("`--paper-model 3` with order 2 follows it."), "{}", run.stderr);
}
