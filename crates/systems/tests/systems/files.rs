//! Descriptions, recordings and model files.

use std::fs::write;
use std::path::Path;

use reachtube_files::SealedFile;
use reachtube_systems::{OutputSystem, SystemModel};

use crate::{run, system, wrong};

const DECAY: &str = "kind = 'discrete'\nstep = 0.5\nstates = ['x']\noutputs = ['x']\nA = [[0.5]]\n";

#[test]
fn wrong_descriptions_are_refused_with_what_is_wrong() {
    for (text, expected) in [
        ("kind = 'discrete'", "missing field `outputs`"),
        ("kind = 'fast'\noutputs = ['x']", "unknown variant `fast`"),
        ("kind = 'discrete'\noutputs = ['x']\nstates = ['x']", "needs its step"),
        ("kind = 'continuous'\nstep = 0.1\noutputs = ['x']\nstates = ['x']", "has no step"),
        ("kind = 'continuous'\noutputs = ['x']\nstates = ['x']", "A is missing"),
        (&DECAY.replace("[[0.5]]", "[[0.5, 1]]"), "A needs 1 rows of 1 entries"),
        (&DECAY.replace("0.5]", "nan]"), "A has an entry that is not finite"),
        (&DECAY.replace("outputs = ['x']", "outputs = ['y']"), "the output y is no state; give C"),
        (&DECAY.replace("states = ['x']", "states = ['x', 'x']"), "have the name x"),
        (&format!("{DECAY}inputs = ['u']\ndelay = {{ v = 1 }}"), "delay names v"),
        (&format!("{DECAY}inputs = ['u']\ndelay = {{ u = -1 }}"), "must be a time of 0 s or more"),
        (&format!("{DECAY}start = {{ at = [1, 2] }}"), "start needs 1 numbers"),
        (&format!("{DECAY}weights = [0]"), "weights needs 1 numbers"),
        (&format!("{DECAY}[sets]\nX0 = 'ball'"), "\"ball\" is not \"box\", \"none\""),
        (&format!("{DECAY}[sets]\nW = {{ fixed = true }}"), "W needs generators or a radius"),
        (&format!("{DECAY}[sets]\nW = {{ generators = [[1, 2]] }}"), "W needs 1 entries"),
        (&format!("{DECAY}[sets]\nU = 'box'"), "unknown field `U`"),
        (&format!("{DECAY}[sets]\nW = {{ radius = [-1] }}"), "W has a radius below 0"),
        ("kind = 'arx'\nstep = 1\noutputs = ['y']\nA = [[1]]", "leave them out"),
    ] {
        let found = wrong(text);
        assert!(found.contains(expected) && found.contains("system.toml"), "{text}: {found}");
    }
    // Errors of the syntax have line and column.
    assert!(wrong("kind = 'discrete'\noutputs = 3").contains("line 2, column"));
}

fn read(content: &str, system: &OutputSystem) -> Result<Vec<reachtube_systems::SystemRun>, String> {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path().join("a.csv"), content).unwrap();
    system.read(folder.path(), None).map_err(|error| error.to_string())
}

#[test]
fn columns_are_found_by_their_names() {
    let system = system(DECAY);
    let runs = read("time_ms,other,x [m]\n0,7,1\n500,7,0.5\n1000,8,0.25\n", &system).unwrap();
    assert_eq!((runs.len(), &runs[0].times[..]), (1, &[0.0, 0.5, 1.0][..]));
    assert_eq!(runs[0].outputs, [1.0, 0.5, 0.25]);
    // The output is the state, too.
    assert_eq!(runs[0].states, Some(vec![1.0]));
    // Without times, samples are counted; with runs, several are in one file.
    let runs = read("run,x\n3,1\n3,0.5\n1,8\n1,4\n1,2\n", &system).unwrap();
    assert_eq!(runs.iter().map(|run| run.len()).collect::<Vec<_>>(), [2, 3]);
    assert!(runs[1].name.ends_with("a.csv, run 1"));
    assert_eq!(runs[1].times, [0.0, 0.5, 1.0]);
    let timed = read("run,t,x\n1,5.0,1\n1,5.5,2\n2,0,1\n2,0.5,4\n", &system).unwrap();
    assert_eq!(timed[0].times, [0.0, 0.5]);
}

#[test]
fn wrong_recordings_are_refused_with_file_line_and_remedy() {
    let system = system(DECAY);
    for (content, expected) in [
        ("t,y\n0,1\n0.5,1\n", "there is no column \"x\"; the header has"),
        ("t,x\n0,1\n0.5,nan\n", "a.csv:3"),
        ("t,x\n0,1\n0.5,1\n0.5,2\n", "a.csv:4"),
        ("run,t,x\n1,0,1\n1,0.5,1\n1,0.2,1\n", "a.csv:4: the time is"),
        ("run,x\n1,0\n1,0\n2,0\n2,0\n1,0\n", "run 1 continues after other runs"),
        ("t,x\n0,1\n", "it has 1 sample, but 2 are needed"),
        ("t,x\n0,1\n0.4,1\n", "sample 1 is 0.4 s after the first, and the system has it after 0.5"),
        ("", "the file is empty"),
    ] {
        let found = read(content, &system).and_then(|runs| {
            let made = system.conform(&runs);
            made.map(|_| String::new()).map_err(|error| error.to_string())
        });
        let found = found.unwrap_err();
        assert!(found.contains(expected), "{content}: {found}");
    }
    let folder = tempfile::tempdir().unwrap();
    assert!(system.read(folder.path(), None).unwrap_err().to_string().contains("no CSV file"));
    let system = crate::system("kind = 'continuous'\nstates = ['x']\noutputs = ['x']\nA = [[-1]]");
    let uneven = run("uneven", 1.0, &[], &[1.0, 0.5, 0.2], 1);
    let uneven = reachtube_systems::SystemRun { times: vec![0.0, 1.0, 1.5], ..uneven };
    let error = system.conform(&[uneven]).unwrap_err().to_string();
    assert!(error.contains("0.5 to 1 s apart, and not even; resample"), "{error}");
}

#[test]
fn an_output_that_nothing_reaches_is_named() {
    let nothing = system(&format!(
        "{DECAY}start = {{ at = [1.0] }}\n[sets]\nX0 = 'none'\nW = {{ generators = [[0.0]] }}"
    ));
    let error = nothing.conform(&[run("one", 0.5, &[], &[1.0, 0.75], 1)]).unwrap_err().to_string();
    assert!(error.contains("one: at 0.5 s, x is 0.25"), "{error}");
}

#[test]
fn a_model_file_is_read_back_and_changes_are_noticed() {
    let system = system(&format!("{DECAY}[sets]\nV = 'box'"));
    let runs =
        [run("one", 0.5, &[], &[1.0, 0.4, 0.3, 0.1], 1), run("two", 0.5, &[], &[2.0, 1.1, 0.5], 1)];
    let model = system.conform(&runs).unwrap().model;
    let text = model.to_json();
    assert_eq!(SystemModel::parse(&text, Path::new("m.json")).unwrap(), model);
    let changed = text.replace("\"verified\": true", "\"verified\": false");
    assert_ne!(changed, text);
    let error = SystemModel::parse(&changed, Path::new("m.json")).unwrap_err().to_string();
    assert!(error.contains("changed after it was written"), "{error}");
    let other = SystemModel::parse("{\"format\": \"x\"}", Path::new("m.json")).unwrap_err();
    assert!(other.to_string().contains("reachtube-system-model"));
}

#[test]
fn an_input_that_never_acts_is_refused() {
    let late = system(&format!("{DECAY}inputs = ['u']\nB = [[1]]\ndelay = {{ u = 500 }}"));
    let error = late.conform(&[run("one", 0.5, &[0.0; 3], &[1.0, 0.5, 0.25], 1)]).unwrap_err();
    assert!(error.to_string().contains("the delay of u is 500 s, and no recording is longer"));
}

#[test]
fn a_system_without_sets_is_not_called_proved() {
    let none = system(&format!("{DECAY}[sets]\nX0 = 'none'\nW = 'none'"));
    let made = none.conform(&[run("one", 0.5, &[], &[1.0, 0.75, 0.25], 1)]).unwrap();
    assert!(!made.model.verified && made.model.without_model.is_none());
    let verdict = made.verdict();
    assert!(verdict.starts_with("NOT PROVED") && !verdict.contains("directed"), "{verdict}");
    assert!(SystemModel::parse(&made.model.to_json(), Path::new("m.json")).is_ok());
}
