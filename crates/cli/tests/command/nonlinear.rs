//! Nonlinear models: `conform`, `check`, `reach` and `report` on them.

use serde_json::{Value, json};

use crate::fixture::{Lab, Run, SAMPLES, cell, robot_toml, sealed};
use crate::output_schema::{complaints, validator};

/// The arm of the recordings, but with cubic viscous friction.
fn bent() -> Lab {
    let lab = Lab::new();
    let (straight, bent) = ("viscous = [2, 0.0, 0.0]", "viscous = [2, 0.5, -0.1]");
    assert!(robot_toml().contains(straight));
    lab.write("bent.toml", robot_toml().replace(straight, bent));
    lab
}

fn conform(lab: &Lab, more: &str) -> Run {
    lab.run(&format!("conform --robot bent.toml --order 3 --data data --torque compensated {more}"))
}

#[test]
fn a_nonlinear_model_goes_through_every_command() {
    let lab = bent();
    let run = conform(&lab, "--out model.json --report report --verbose")
        .exits(0)
        .notes("round 1: the linearised sets cost");
    for part in [
        "conformant: 6 recordings in 2 suites; 408 of 408 rows (suite, sample, state) lie in \
         the computed outer set, an enclosure",
        "for the linearised sets",
        "decide X0 and U",
    ] {
        assert!(run.stdout.contains(part), "{part:?} is not in\n{}", run.stdout);
    }
    let model: Value = serde_json::from_str(&lab.read("model.json")).unwrap();
    assert_eq!(complaints(&validator("model"), &model), Vec::<String>::new());
    assert_eq!(
        (&model["proof"]["enclosure"], &model["settings"]["method"]),
        (&json!("outer"), &json!("program"))
    );
    assert_eq!(model["drive"]["acceleration"].as_array().unwrap().len(), 2);
    let check = lab.check("--json").exits(0).json();
    assert_eq!((&check["rows"], &check["violations"]["count"]), (&408.into(), &0.into()));
    lab.run("reach --model model.json --data data --torque compensated --out reach").exits(0);
    let (samples, tube) = (lab.read("reach/A.csv"), lab.read("reach/A_tube.csv"));
    assert_eq!((samples.lines().count(), tube.lines().count()), (SAMPLES + 1, SAMPLES));
    for (k, row) in samples.lines().skip(1).enumerate() {
        for (run, i) in (1..=3).flat_map(|run| (0..4).map(move |i| (run, i))) {
            let text = lab.read(&format!("data/A_{run}.csv"));
            let recorded = cell(text.lines().nth(k + 1).unwrap(), i + 1);
            assert!(cell(row, 3 * i + 1) <= recorded && recorded <= cell(row, 3 * i + 3));
        }
    }
    let page = lab.read("report/report.html");
    for part in ["computed outer set", "outer enclosure"] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn a_model_of_an_abstraction_is_that_of_its_robot() {
    let lab = bent();
    let direct = conform(&lab, "--json").exits(0).json();
    lab.run("abstract --robot bent.toml --order 3 --out bent.json").exits(0);
    let run =
        lab.run("conform --abstraction bent.json --data data --torque compensated --json").exits(0);
    assert_eq!(direct, run.json());
}

#[test]
fn bisection_is_a_baseline_that_costs_more() {
    let lab = bent();
    let program = conform(&lab, "--json").exits(0).json();
    let run = conform(&lab, "--json --method bisection").exits(0).notes("radius 6 of 6");
    let bisection = run.json();
    assert_eq!(complaints(&validator("model"), &bisection), Vec::<String>::new());
    let cost = |model: &Value| model["cost"].as_f64().unwrap();
    assert!(
        cost(&bisection) > 0.999 * cost(&program),
        "{} for {}",
        cost(&bisection),
        cost(&program)
    );
    let sets = |model: &Value| model["search"]["reachable_sets"].as_u64().unwrap();
    assert!(sets(&bisection) > 20 && sets(&program) < 5);
    // Bisection works on the linear model too.
    let linear = lab.conform("--json --method bisection").exits(0).json();
    assert!(cost(&linear) > 0.999 * cost(&lab.conform("--json").exits(0).json()));
}

#[test]
fn progress_of_another_job_is_refused_and_a_finished_one_leaves_none() {
    let lab = bent();
    conform(&lab, "--resume progress.json").exits(0);
    assert!(!lab.path("progress.json").exists());
    let progress = json!({
        "format": "reachtube-progress", "version": 1, "tool": "", "job": "0", "progress": {}
    });
    lab.write("progress.json", progress.to_string());
    conform(&lab, "--resume progress.json").fails_with_last(&[
        "progress.json: it holds the progress of another job",
        "give the file of this job",
    ]);
    lab.write("progress.json", "{");
    conform(&lab, "--resume progress.json").fails_with_last(&["progress.json: not JSON"]);
    conform(&lab, "--resume nowhere/deep/progress.json").exits(0);
}

#[test]
fn a_changed_model_is_refused() {
    let lab = bent();
    let model = conform(&lab, "--json").exits(0).json();
    for (path, value, words) in [
        ("/drive/acceleration/0/0/1", json!(-2.5), "changed after it was written"),
        ("/drive/variables/0", json!("q1"), "its variables are not"),
        ("/settings/method", json!("guess"), "unknown variant `guess`"),
        (
            "/drive/settings/abstraction/order",
            json!(1),
            "but the model has 4 variables and order 1",
        ),
    ] {
        let mut changed = model.clone();
        *changed.pointer_mut(path).unwrap() = value;
        lab.write("model.json", changed.to_string());
        lab.check("").fails_with(&["model.json: ", words]);
    }
}

/// The friction torque peaks at 0.24 N m, so a joint driven by 3 N m diverges.
#[test]
fn a_model_that_runs_away_is_refused_and_a_lost_set_is_an_answer() {
    let lab = bent();
    lab.write(
        "weak.toml",
        robot_toml().replace("viscous = [2, 0.0, 0.0]", "viscous = [2, 0.0, -20.0]"),
    );
    let weak = "conform --robot weak.toml --order 3 --data data --torque compensated --json";
    lab.run(weak).fails_in_json("no-answer", &["suite", "the model runs away after", "--until"]);
    let mut model = conform(&lab, "--json").exits(0).json();
    for radius in model["input_set"]["radius"].as_array_mut().unwrap() {
        *radius = json!(30.0);
    }
    lab.write("model.json", sealed(model));
    for (options, words) in [
        ("", "suite A: the set ends at "),
        ("--verbose", "the reachable set could not be computed beyond"),
    ] {
        let check = lab.check(options).exits(1).stdout;
        assert!(check.contains(words) && check.contains("`--until "), "{check}");
    }
    lab.run("reach --model model.json --data data --torque compensated --out reach")
        .exits(1)
        .notes("the reachable set could not be computed beyond");
}
