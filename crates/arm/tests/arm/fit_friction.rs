//! Friction that is subtracted along the nominal motion: Coulomb friction, and warm-up.

use crate::common::{conform_all, setup, two_joints};
use crate::fit::{PLAIN, Truth, fitted, problem, record};
use reachtube_arm::OfArm;
use reachtube_conform::fit::{Fitted, FittedParameter};
use reachtube_conform::{
    FitSettings, Group, Keep, Model, Problem, Setup, Silent, Tube, check, fit,
};
use reachtube_recordings::{MemoryRuns, ReadOptions, RunSource};
use reachtube_robot::Robot;

#[test]
fn friction_that_changes_with_the_runs_is_found_and_is_in_the_model_file() {
    let truth = Truth { elbow: 1.2, warm_up: -0.25, ..PLAIN };
    let problem = problem(truth, 3, |_, _| {});
    let without = fitted(&problem, &[Group::Viscous], Some(0.001));
    let Fitted { problem: better, record, .. } =
        fitted(&problem, &[Group::Viscous, Group::WarmUp], Some(0.001));
    assert!(record.cost < 0.4 * without.record.cost, "{record:?}");
    let elbow = record.parameters.iter().find(|p| p.part == 2 && p.group == Group::WarmUp);
    assert!((elbow.unwrap().fitted + 0.25).abs() < 0.05, "{record:?}");
    let found = conform_all(&better);
    assert!(found.verdict.conformant);
    // What the file says is what was found, and a check with it knows the order of the runs.
    let model = Model::new(&better, &found).with_fit(record);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.json");
    std::fs::write(&path, model.to_json()).unwrap();
    let (read, written) = reachtube_arm::open(&path).unwrap();
    assert_eq!(read, model);
    let runs = Box::new(self::record(&two_joints(), truth, 3));
    let same = Problem::read(written, runs, &[], Keep::Needed, &Silent).unwrap();
    let verdict = check(&read, &same, &Tube::new(&same, read.sets()).unwrap()).unwrap();
    assert!(verdict.verdict.conformant, "{:?}", verdict.verdict);
    // Without the correction the recordings leave the same sets.
    let none = setup(same.robot(), |_, settings| settings.clone_from(same.settings()));
    let other = same.with_setup(none);
    let verdict = check(&read, &other, &Tube::new(&other, read.sets()).unwrap()).unwrap();
    assert!(!verdict.verdict.conformant);
}

#[test]
fn warm_up_is_not_fitted_to_a_robot_that_is_always_as_warm() {
    let recorded = self::record(&two_joints(), PLAIN, 2);
    let mut runs = MemoryRuns::default();
    for (index, entry) in recorded.runs().iter().enumerate() {
        let run = recorded.read(index, &ReadOptions::default()).unwrap();
        runs.push(&entry.file, Some(&entry.file), entry.motion.as_deref(), run);
    }
    let setup = setup(&two_joints(), |_, _| ());
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::All, &Silent).unwrap();
    let settings = FitSettings { groups: vec![Group::WarmUp], pull: Some(0.02) };
    let refused = fit(&problem, &settings, &Silent).unwrap_err().to_string();
    assert!(refused.contains("every recording is the first of its suite"), "{refused}");
}

#[test]
fn friction_that_changes_with_recorded_temperatures_is_found() {
    let truth = Truth { heat: [-0.03, -0.01], ..PLAIN };
    let read = |setup: Setup, keep| {
        let runs = Box::new(self::record(&two_joints(), truth, 3));
        Problem::read(setup, runs, &[], keep, &Silent).unwrap()
    };
    let mut description = two_joints().description().clone();
    description.joints[0].friction.coulomb = [0.2, 0.0, -0.2, 0.0, -0.2, 0.0, 0.2, 0.0];
    let robot = Robot::from_description(&description).unwrap();
    let problem = read(setup(&robot, |_, _| ()), Keep::All);
    let before = conform_all(&problem);
    let Fitted { problem: better, record, .. } = fitted(&problem, &[Group::WarmUp], Some(0.001));
    assert!(record.cost < 0.4 * before.cost, "{} {}", before.cost, record.cost);
    let of = |joint: usize, unit: &str| {
        let is = |p: &&FittedParameter| p.part == joint && p.unit == unit;
        record.parameters.iter().find(is).unwrap().fitted
    };
    assert!((of(2, "N m/(rad/s)/K") + 0.03).abs() < 0.005, "{:?}", record.parameters);
    // The change of Coulomb friction is in parts of 0.2 N m.
    assert!((of(1, "1/K") + 0.05).abs() < 0.01, "{:?}", record.parameters);
    // The file keeps it, and a check with it knows the temperatures of the recordings.
    let found = conform_all(&better);
    assert!(found.verdict.conformant && found.any_run.is_some());
    let model = Model::new(&better, &found).with_fit(record);
    let (model, setup) = reachtube_arm::parse(&model.to_json(), "model.json".as_ref()).unwrap();
    let same = read(setup, Keep::Needed);
    let verdict = check(&model, &same, &Tube::new(&same, model.sets()).unwrap()).unwrap();
    assert!(verdict.verdict.conformant, "{:?}", verdict.verdict);
    // Without the temperatures every recording has the friction of the reference.
    let runs = Box::new(self::record(&two_joints(), Truth { heat: [0.0; 2], ..truth }, 1));
    let setup = same.setup().clone();
    let cold = Problem::read(setup, runs, &[], Keep::Needed, &Silent).unwrap();
    let notes = cold.recordings().notes.join("\n");
    assert!(notes.contains("5 of the 5 recordings have no columns temp1"), "{notes}");
}

#[test]
fn coulomb_friction_is_taken_off_along_the_nominal_motion() {
    let problem = problem(Truth { coulomb: 0.3, ..PLAIN }, 2, |_, _| {});
    let robot = {
        let mut description = two_joints().description().clone();
        description.joints[0].friction.coulomb = [0.2, 0.0, -0.2, 0.0, -0.2, 0.0, 0.2, 0.0];
        Robot::from_description(&description).unwrap()
    };
    let setup = setup(&robot, |_, settings| settings.clone_from(problem.settings()));
    let problem = problem.with_setup(setup);
    let Fitted { problem: better, record, .. } = fitted(&problem, &[Group::Coulomb], Some(1e-4));
    // The recorded input is free of 0.2 N m already, and 0.3 N m more are there.
    let [only] = &record.parameters[..] else { panic!("{record:?}") };
    assert!((only.fitted - 0.5).abs() < 0.02, "{only:?}");
    assert!(record.cost < 0.5 * record.identified_cost, "{record:?}");
    assert!(conform_all(&better).verdict.conformant);
}
