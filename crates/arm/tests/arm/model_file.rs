//! The contents of a model file decide the verdict on other recordings, and a changed file is
//! refused.

use crate::common::{Disturbed, Random, grid, setup, two_joints};
use std::path::Path;

use reachtube_arm::{ArmModel, OfArm};
use reachtube_conform::{
    Answer, Check, Error, FitSettings, Group, Keep, Model, Problem, Setup, Silent, Tube, check,
    conform,
};
use reachtube_recordings::{MemoryRuns, Run};
use reachtube_robot::Robot;

/// Runs of two suites, each under a name of its own; `suite` names the suite of each.
fn recorded(robot: &Robot, suite: impl Fn(&str, usize) -> Option<String>) -> MemoryRuns {
    let mut runs = MemoryRuns::default();
    for (name, seed) in [("A", 5), ("B", 6)] {
        let times = grid(0.01, 40);
        let arm = Disturbed { robot, times: &times, start: 0.01, input: 0.5 };
        let mut random = Random(seed);
        for index in 0..6 {
            let run = arm.record(&mut random);
            let run = Run::new(2, run.times, run.states, run.torques).unwrap();
            if let Some(suite) = suite(name, index) {
                runs.push(&format!("{name}{index}"), Some(&suite), None, run);
            }
        }
    }
    runs
}

fn read(setup: Setup, runs: MemoryRuns) -> Problem {
    Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap()
}

/// Fits a model to the first four runs of each suite and writes its file.
fn fitted(robot: &Robot, folder: &std::path::Path) -> std::path::PathBuf {
    let runs = recorded(robot, |name, index| (index < 4).then(|| name.into()));
    let problem = read(setup(robot, |_, _| ()), runs);
    let found = conform(&problem, &Silent, None).unwrap();
    let path = folder.join("model.json");
    std::fs::write(&path, Model::new(&problem, &found).to_json()).unwrap();
    path
}

fn check_of(path: &std::path::Path, runs: MemoryRuns) -> Check {
    let (model, setup) = reachtube_arm::open(path).unwrap();
    let problem = read(setup, runs);
    let tube = Tube::new(&problem, model.sets()).unwrap();
    check(&model, &problem, &tube).unwrap()
}

#[test]
fn a_run_is_judged_the_same_alone_and_in_a_group() {
    let (robot, folder) = (two_joints(), tempfile::tempdir().unwrap());
    let path = fitted(&robot, folder.path());
    for suite in ["A", "B"] {
        let whole =
            check_of(&path, recorded(&robot, |name, _| (name == suite).then(|| name.into())));
        assert!(!whole.verdict.conformant, "held-out runs leave sets this small");
        let alone = (0..6).map(|run| {
            let keep = |name: &str, index| (name == suite && index == run).then(|| name.into());
            check_of(&path, recorded(&robot, keep)).verdict
        });
        let alone: Vec<_> = alone.collect();
        assert!(alone[..4].iter().all(|verdict| verdict.conformant));
        let furthest = alone.iter().map(|verdict| verdict.largest_excess).fold(f64::MIN, f64::max);
        assert_eq!(furthest, whole.verdict.largest_excess);
    }
}

#[test]
fn suites_without_a_nominal_start_and_suites_that_start_elsewhere_are_named() {
    let (robot, folder) = (two_joints(), tempfile::tempdir().unwrap());
    let path = fitted(&robot, folder.path());
    let unknown = check_of(&path, recorded(&robot, |name, _| (name == "A").then(|| "C".into())));
    assert!(
        unknown.notes.iter().any(|note| note.starts_with("suite C: the model has no nominal")),
        "{:?}",
        unknown.notes
    );
    let mut elsewhere = MemoryRuns::default();
    let states = [0.9, 0.0, 0.0, 0.0].repeat(3);
    let run = Run::new(2, vec![0.0, 0.01, 0.02], states, vec![0.0; 6]).unwrap();
    elsewhere.push("far", Some("A"), None, run);
    let note = "suite A: none of its recordings starts near";
    let notes = check_of(&path, elsewhere).notes;
    assert!(notes.iter().any(|found| found.starts_with(note)), "{notes:?}");
    let usual = check_of(&path, recorded(&robot, |name, _| Some(name.into())));
    assert!(!usual.notes.iter().any(|found| found.starts_with("suite")), "{:?}", usual.notes);
}

#[test]
fn a_file_whose_content_was_changed_is_refused() {
    let (robot, folder) = (two_joints(), tempfile::tempdir().unwrap());
    let path = fitted(&robot, folder.path());
    let model = reachtube_arm::open(&path).unwrap().0;
    let changes: [fn(&mut Model); 5] = [
        |model| model.trust.violation_probability = 0.01,
        |model| model.data.suites[0].name = "C".into(),
        |model| model.data.suites[1].motion = Some("another".into()),
        |model| model.left_out[0].gauge = Some(1.0),
        |model| model.initial_set.radius[0] *= 0.5,
    ];
    for change in changes {
        let mut changed = model.clone();
        change(&mut changed);
        let text = changed.to_json().replace(&sealed(&changed), &model.sha256);
        std::fs::write(&path, text).unwrap();
        let Err(Error::ModelFile { problem, .. }) = reachtube_arm::open(&path) else {
            panic!("a changed file was accepted")
        };
        assert!(problem.contains("the file was changed"), "{problem}");
    }
}

/// Returns the digest that a file of `model` has.
fn sealed(model: &Model) -> String {
    let value: serde_json::Value = serde_json::from_str(&model.to_json()).unwrap();
    value["sha256"].as_str().unwrap().into()
}

#[test]
fn the_growth_that_is_named_encloses_the_recordings() {
    let (robot, folder) = (two_joints(), tempfile::tempdir().unwrap());
    let path = fitted(&robot, folder.path());
    let (model, setup) = reachtube_arm::open(&path).unwrap();
    let mut runs = MemoryRuns::default();
    let times = grid(0.01, 40);
    let arm = Disturbed { robot: &robot, times: &times, start: 1e-4, input: 2.0 };
    for (index, seed) in [1, 2, 3].into_iter().enumerate() {
        let run = arm.record(&mut Random(seed));
        let run = Run::new(2, run.times, run.states, run.torques).unwrap();
        runs.push(&format!("{index}"), Some("A"), None, run);
    }
    let problem = read(setup, runs);
    let checked = |sets| {
        let tube = Tube::new(&problem, sets).unwrap();
        check(&model, &problem, &tube).unwrap()
    };
    let growth = checked(model.sets()).growth.unwrap();
    let (x0, u) = (growth.initial_set.unwrap(), growth.input_set.unwrap());
    let both = growth.both_sets.unwrap();
    assert!(x0 > both && u > both && both > 1.0 && growth.noise_velocity > 0.0, "{growth:?}");
    let grow = |radii: &mut Vec<f64>, factor: f64| radii.iter_mut().for_each(|r| *r *= factor);
    for (part, encloses) in [(1.0 + 1e-9, true), (0.999, false)] {
        let mut wider_start = model.sets();
        grow(&mut wider_start.initial_set.radius, x0 * part);
        let mut wider_input = model.sets();
        grow(&mut wider_input.input_set.radius, u * part);
        let mut noisy = model.sets();
        let noise = [growth.noise_position, growth.noise_velocity].map(|r| r * part);
        noisy.noise_set = Some(reachtube_reach::Hyperrectangle {
            centre: vec![0.0; 4],
            radius: vec![noise[0], noise[0], noise[1], noise[1]],
        });
        let mut wider = model.sets();
        grow(&mut wider.initial_set.radius, both * part);
        grow(&mut wider.input_set.radius, both * part);
        for sets in [wider_start, wider_input, wider, noisy] {
            let again = checked(sets);
            assert_eq!(again.verdict.conformant, encloses);
            assert_eq!(again.growth.is_none(), encloses);
        }
    }
}

/// A fit has seen its recordings, whatever robot it began with, so that no bound may rest on them.
#[test]
fn a_model_that_is_read_again_has_seen_the_recordings_of_its_fit() {
    let robot = two_joints();
    let runs = recorded(&robot, |name, _| Some(name.into()));
    let problem = read(setup(&robot, |_, _| ()), runs);
    let settings = FitSettings { groups: vec![Group::Viscous], pull: Some(0.1) };
    let Answer { model, problem, .. } =
        Answer::new(problem, Some(&settings), None, &Silent).unwrap();
    let sha256 = &problem.recordings().suites[0].runs[0].sha256;
    let (model, setup) = reachtube_arm::parse(&model.to_json(), Path::new("model")).unwrap();
    assert!(model.seen.contains(sha256) && !sha256.is_empty());
    assert!(model.robot().identified_from.contains(sha256));
    assert!(setup.robot().description().identified_from.contains(sha256));
    // The robot in the file names what it was identified from, which a fit is not.
    assert_eq!(model.arm().robot.identified_from, robot.description().identified_from);
}
