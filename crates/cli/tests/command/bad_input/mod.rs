//! Kinds of bad input in one table: each with its exit code and the words of the answer.

mod files;
mod options;
mod recordings;

use crate::fixture::{Lab, Run};

/// A kind of bad input.
struct Case {
    /// The mistake.
    what: &'static str,
    /// Makes it wrong.
    spoil: fn(&Lab),
    /// The command, its words separated by spaces.
    command: &'static str,
    /// The exit code.
    code: i32,
    /// What the answer says.
    words: &'static [&'static str],
}

impl Case {
    /// Returns a case that is an error.
    const fn refused(
        what: &'static str,
        spoil: fn(&Lab),
        command: &'static str,
        words: &'static [&'static str],
    ) -> Self {
        Self { what, spoil, command, code: 2, words }
    }
}

const CONFORM: &str = "conform --robot arm.toml --data data --torque compensated";
const CHECK: &str = "check --model model.json --data data --torque compensated";
const INSPECT: &str = "inspect --data data";
const ABSTRACTION: &str = "conform --abstraction a.json --data data --torque compensated";

#[test]
fn every_kind_of_bad_input_has_its_words() {
    let cases = || [recordings::CASES, files::CASES, options::CASES].into_iter().flatten();
    assert!(cases().count() >= 60, "there are {} cases", cases().count());
    let lab = Lab::new();
    lab.conform("--out model.json").exits(0);
    lab.run("abstract --robot arm.toml --out a.json").exits(0);
    let (model, abstraction) = (lab.read("model.json"), lab.read("a.json"));
    let mut wrong = Vec::new();
    for case in cases() {
        let lab = Lab::new();
        lab.write("model.json", &model);
        lab.write("a.json", &abstraction);
        (case.spoil)(&lab);
        let before = lab.names(".");
        let run = lab.run(case.command);
        wrong.extend(complaint(case, &run));
        if lab.names(".") != before {
            wrong.push(format!("{}: {:?} was left behind", case.what, lab.names(".")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Returns what is wrong with an answer.
fn complaint(case: &Case, run: &Run) -> Option<String> {
    let answer = format!("{}{}", run.stdout, run.stderr);
    let missing = case.words.iter().find(|words| !answer.contains(*words));
    let is_panic = answer.contains("panicked");
    (run.code != case.code || missing.is_some() || is_panic).then(|| {
        let (what, code) = (case.what, case.code);
        format!("{what}: expected exit code {code} and {missing:?}, but found {run:#?}")
    })
}
