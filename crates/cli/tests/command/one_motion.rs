//! Logs that are one motion by their content, and models that were compared with the same motions.

use crate::fixture::{Lab, Run};
use crate::model::lab;

/// Writes a log of the rows `from` to `until` of `logs/a.csv`; its clock goes on unless it
/// `restarts`.
fn piece(lab: &Lab, to: &str, [from, until]: [usize; 2], restarts: bool) {
    let whole = lab.read("logs/a.csv");
    let rows: Vec<&str> = whole.lines().skip(1).collect();
    let time = |row: &str| row.split(',').next().unwrap().parse::<f64>().unwrap();
    let first = if restarts { time(rows[from]) } else { 0.0 };
    let mut text = format!("{}\n", whole.lines().next().unwrap());
    for row in &rows[from..until.min(rows.len())] {
        let rest = row.split_once(',').unwrap().1;
        text += &format!("{:.3},{rest}\n", time(row) - first);
    }
    lab.write(to, text);
}

fn model(lab: &Lab, options: &str) -> Run {
    lab.run(&format!("model --robot pendulum.toml --torque motor {options}"))
}

fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn pieces_of_one_log_bound_no_other_motion() {
    let lab = lab();
    for (folder, longer, restarts, note) in [
        ("rolled", 0, false, "5 recordings go on where another ends"),
        ("restarted", 0, true, "5 recordings go on where another ends"),
        ("overlapping", 200, true, "5 recordings share samples"),
    ] {
        std::fs::create_dir(lab.path(folder)).unwrap();
        for k in 0..5 {
            let rows = [730 * k, 730 * (k + 1) + longer];
            piece(&lab, &format!("{folder}/m{k}.csv"), rows, restarts);
        }
        let run = model(&lab, &format!("--data {folder} --out of-{folder}"));
        assert!(run.code != 2, "{run:#?}");
        let said = words(&format!("{} {}", run.stdout, run.stderr));
        assert!(said.contains("5 of several joints (1 motion)"), "{folder}: {said}");
        assert!(said.contains(note) && said.contains("m1.csv"), "{folder}: {said}");
        assert!(said.contains("new motions: no guarantee"), "{folder}: {said}");
    }
}

#[test]
fn a_log_of_the_model_is_recognised_without_some_of_its_samples() {
    let lab = lab();
    let made = model(&lab, "--data logs --out arm --horizon 0.5");
    assert!(made.code != 2, "{made:#?}");
    let check = |log: &str| {
        let run = lab.run(&format!("check --model arm/model.json --data {log}"));
        assert!(run.code != 2, "{run:#?}");
        run.stdout
    };
    let whole = lab.read("logs/a.csv");
    let without = |is_left_out: &dyn Fn(usize) -> bool| {
        let rows = whole.lines().enumerate().filter(|(k, _)| *k == 0 || !is_left_out(*k));
        rows.map(|(_, row)| format!("{row}\n")).collect::<String>()
    };
    lab.write("dropped.csv", without(&|k| k == 700));
    lab.write("thinned.csv", without(&|k| k % 2 == 0));
    piece(&lab, "trimmed.csv", [600, 1400], true);
    for log in ["logs/a.csv", "dropped.csv", "thinned.csv", "trimmed.csv"] {
        let text = words(&check(log));
        assert!(text.contains("was fitted to some of these"), "{log}: {text}");
    }
    let text = words(&check("logs/c.csv"));
    assert!(!text.contains("was fitted to some of these"), "{text}");
}

#[test]
fn models_that_are_written_over_each_other_are_counted() {
    let lab = lab();
    let new_motions = |options: &str| {
        let run = model(&lab, &format!("--data logs --held-out b,c {options}"));
        assert!(run.code != 2, "{run:#?}");
        let text = words(&run.stdout);
        let from = text.find("new motions: ").unwrap_or_else(|| panic!("{text}"));
        text[from..].chars().take(100).collect::<String>()
    };
    let first = new_motions("--out arm --horizon 0.2");
    assert!(first.contains(": at most 1 in 3 leaves"), "{first}");
    assert_eq!(new_motions("--out arm --horizon 0.2"), first, "it is the same model");
    let second = new_motions("--out arm --horizon 0.1");
    assert!(second.contains(": at most 2 in 3 leave"), "{second}");
    let third = new_motions("--out arm --horizon 0.3");
    assert!(third.contains("no guarantee: 2 motions held out are too few"), "{third}");
    // Another file, and other motions, begin again.
    let other = new_motions("--out other --horizon 0.3");
    assert!(other.contains("no guarantee") || other.contains("at most 1 in 3"), "{other}");
}
