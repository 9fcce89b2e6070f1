//! Conformance of models that are not linear, on recordings whose disturbances are known and on the
//! paper's own.

mod common;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;

use common::{Random, Recorded, grid, write_data_set};
use reachtube_abstraction::{Abstraction, ExpansionPoint, ModelField, ModelKind, PolynomialModel};
use reachtube_conform::Model;
use reachtube_conform::{
    Conformance, Dynamics, Enclosure, Method, Settings, UncertaintySets, Watch, check, conform,
    conform_dynamics,
};
use reachtube_ode::{DormandPrince, Run, Tolerance};
use reachtube_reach::{Disturbance, Hyperrectangle};
use reachtube_recordings::{DataSet, Torque};
use reachtube_robot::Robot;

/// Friction that bends and joints that move each other.
fn bent() -> Robot {
    let joint = |name: &str, mass: f64, viscous: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\ndh = {{ a = 0.3, alpha = 0.0, theta = 0.0, d = 0.0 }}\nmass = {mass}\ncom = [-0.15, 0.0, 0.0]\n\
             inertia = [0.01, 0.0, 0.0, 0.02, 0.0, 0.02]\narmature = 0.3\nfriction = {{ viscous = {viscous} }}\n"
        )
    };
    let text = format!(
        "schema_version = 1\nname = \"bent\"\n{}{}",
        joint("shoulder", 2.0, "[2.0, 0.2, -0.3]"),
        joint("elbow", 1.5, "[1.0, 0.0, 0.4]")
    );
    Robot::from_toml(&text, "bent").unwrap()
}

fn settings(kind: ModelKind, order: u32) -> Settings {
    Settings {
        abstraction: Abstraction { model: kind, order },
        ..Settings::new(Torque::Compensated, 2)
    }
}

fn model_of(robot: &Robot, settings: &Settings) -> PolynomialModel {
    let Abstraction { model, order } = settings.abstraction;
    PolynomialModel::new(robot, model, order, &settings.expansion_point).unwrap()
}

/// Runs of the model itself, from within ± `start` (rad, rad/s) under inputs that are off by ±
/// `input` (N m).
fn recorded(
    model: &PolynomialModel,
    times: &[f64],
    runs: usize,
    [start, input]: [f64; 2],
    seed: u64,
) -> Vec<Recorded> {
    let mut random = Random(seed);
    let record = |_| {
        let x0: Vec<f64> = (0..4).map(|i| 0.1 * i as f64 + start * random.signed()).collect();
        let torques: Vec<f64> =
            times.iter().flat_map(|t| [2.0 * (2.0 * t).sin(), 1.5 * (3.0 * t).cos()]).collect();
        let inputs: Vec<f64> =
            torques[..2 * (times.len() - 1)].iter().map(|u| u + input * random.signed()).collect();
        let mut states = Vec::new();
        let start = model.state(&x0[..2], &x0[2..]);
        let run = Run { start: &start, inputs: &inputs };
        let mut solver = DormandPrince::new(model.states(), Tolerance::default());
        let outcome =
            solver.simulate(&mut ModelField::new(model), times, run, |_, x| states.extend(&x[..4]));
        assert!(outcome.is_reached());
        Recorded { times: times.to_vec(), states, torques }
    };
    (0..runs).map(record).collect()
}

/// Two suites of the model.
fn two_suites(folder: &Path, model: &PolynomialModel) -> DataSet {
    let suites = [
        ("a", recorded(model, &grid(0.01, 90), 8, [0.02, 0.3], 5)),
        ("b", recorded(model, &grid(0.01, 60), 6, [0.02, 0.3], 6)),
    ];
    write_data_set(folder, &suites);
    DataSet::open(folder).unwrap()
}

fn radii(sets: &UncertaintySets) -> Vec<f64> {
    let all = |set: &Hyperrectangle| [set.center.clone(), set.radius.clone()].concat();
    [all(&sets.initial_set), all(&sets.input_set)].concat()
}

/// Centres and radii are the same to a part of the largest.
#[track_caller]
fn assert_close(a: &UncertaintySets, b: &UncertaintySets, tolerance: f64) {
    let largest = radii(b).iter().fold(0.0, |max: f64, x| max.max(x.abs()));
    for (x, y) in radii(a).iter().zip(radii(b)) {
        assert!((x - y).abs() <= tolerance * largest, "{a:?}\n{b:?}");
    }
}

/// The route of models that are not linear, on a linear one.
fn the_long_way(
    robot: &Robot,
    data: &DataSet,
    names: &[String],
    settings: &Settings,
) -> Conformance {
    let Abstraction { model, order } = settings.abstraction;
    let model =
        PolynomialModel::new(robot, model, order, &ExpansionPoint::zero(robot.joint_count()))
            .unwrap();
    let dynamics = Dynamics::Polynomial(Box::new(model));
    conform_dynamics(robot, data, names, settings, dynamics, &Watch::SILENT).unwrap()
}

#[test]
fn a_linear_model_has_the_sets_of_the_one_program() {
    let folder = tempfile::tempdir().unwrap();
    let robot = bent();
    let linear = settings(ModelKind::One, 1);
    let data = two_suites(folder.path(), &model_of(&robot, &linear));
    for disturbance in [Disturbance::Sample, Disturbance::Constant] {
        let settings = Settings { disturbance, ..linear.clone() };
        let short = conform(&robot, &data, &[], &settings, &Watch::SILENT).unwrap();
        let long = the_long_way(&robot, &data, &[], &settings);
        assert!(short.proof.verified && long.proof.verified);
        assert_eq!(
            (short.proof.enclosure, long.proof.enclosure),
            (Enclosure::Inner, Enclosure::Outer)
        );
        let cost = long.search.as_ref().unwrap().linearised_cost.unwrap();
        assert!((cost / short.cost - 1.0).abs() < 1e-6, "{cost} for {}", short.cost);
        assert_close(&long.sets, &short.sets, 1e-6);
        // The enclosure is wider than the hull, but not by much; a constant disturbance moves less
        // than any.
        assert!(long.cost > (1.0 - 1e-9) * short.cost);
        assert!(
            disturbance == Disturbance::Constant || long.cost < 1.01 * short.cost,
            "{}",
            long.cost
        );
    }
}

#[test]
fn the_schunk_recordings_have_the_costs_of_the_one_program() {
    let Some(folder) = common::shared("schunk_lwa4p") else { return };
    let data = DataSet::open(folder).unwrap();
    let names: Vec<String> = ["A", "B", "D", "E"].map(String::from).to_vec();
    let long = the_long_way(&Robot::lwa4p(), &data, &names, &Settings::new(Torque::Compensated, 6));
    let cost = long.search.as_ref().unwrap().linearised_cost.unwrap();
    // The optimum found by HiGHS, as in the test of the linear route.
    assert!((cost / 6_048.047_985_391_407 - 1.0).abs() < 1e-6, "{cost}");
    assert!(long.proof.verified && long.cost < 1.001 * cost, "{}", long.cost);
}

#[test]
fn sets_of_each_model_enclose_its_runs_and_are_not_wider_than_what_was_there() {
    for (kind, order) in [(ModelKind::One, 3), (ModelKind::Two, 4), (ModelKind::Three, 3)] {
        let folder = tempfile::tempdir().unwrap();
        let (robot, settings) = (bent(), settings(kind, order));
        let data = two_suites(folder.path(), &model_of(&robot, &settings));
        let found = conform(&robot, &data, &[], &settings, &Watch::SILENT).unwrap();
        let search = found.search.clone().unwrap();
        assert!(
            found.proof.verified && found.proof.proved == 2 * 4 * 150,
            "{kind:?}: {:?}",
            found.proof
        );
        assert!(search.rounds < 20 && search.runs_away.is_none(), "{search:?}");
        // Nominals start at the mean of the runs: sets that were there have at most twice the
        // radius of the starts.
        let there = Settings { method: Method::Program, ..settings.clone() };
        let widest = |set: &Hyperrectangle| set.radius.iter().fold(0.0, |max: f64, r| max.max(*r));
        assert!(
            widest(&found.sets.initial_set) < 0.1 && widest(&found.sets.input_set) < 0.6,
            "{:?}",
            found.sets
        );
        let model = Model::new(&robot, &data, &there, &found);
        let path = folder.path().join("model.json");
        std::fs::write(&path, model.to_json()).unwrap();
        let loaded = Model::load(&path).unwrap();
        assert_eq!(loaded, model);
        assert!(check(&loaded, &data, &[], &there, &|_, _| {}).unwrap().conformant);
    }
}

/// Sets that are smaller in any radius by a few parts in a hundred leave a run out: the rows that
/// decide are met by motions of the model itself.
#[test]
fn no_radius_can_be_made_smaller_alone() {
    let folder = tempfile::tempdir().unwrap();
    let (robot, settings) = (bent(), settings(ModelKind::One, 3));
    let data = two_suites(folder.path(), &model_of(&robot, &settings));
    let found = conform(&robot, &data, &[], &settings, &Watch::SILENT).unwrap();
    let model = Model::new(&robot, &data, &settings, &found);
    let largest = found.sets.input_set.radius.iter().fold(0.0, |max: f64, r| max.max(*r));
    for joint in (0..2).filter(|joint| found.sets.input_set.radius[*joint] > 0.1 * largest) {
        let mut smaller = model.clone();
        smaller.input_set.radius[joint] *= 0.95;
        let answer = check(&smaller, &data, &[], &settings, &|_, _| {}).unwrap();
        assert!(!answer.conformant && answer.violations.worst.is_some(), "joint {joint}");
    }
}

#[test]
fn bisection_costs_more_than_the_programs() {
    let folder = tempfile::tempdir().unwrap();
    let (robot, settings) = (bent(), settings(ModelKind::One, 3));
    let data = two_suites(folder.path(), &model_of(&robot, &settings));
    let program = conform(&robot, &data, &[], &settings, &Watch::SILENT).unwrap();
    let bisection = Settings { method: Method::Bisection, ..settings.clone() };
    let baseline = conform(&robot, &data, &[], &bisection, &Watch::SILENT).unwrap();
    assert!(program.proof.verified && baseline.proof.verified);
    assert!(baseline.cost > 0.999 * program.cost, "{} for {}", baseline.cost, program.cost);
    assert!(baseline.search.unwrap().reachable_sets > 10 * program.search.unwrap().reachable_sets);
}

/// An interrupted search goes on where it was, and comes to the same sets bit by bit.
#[test]
fn a_search_goes_on_where_it_was_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let robot = bent();
    let data = two_suites(folder.path(), &model_of(&robot, &settings(ModelKind::One, 3)));
    let path = folder.path().join("progress.json");
    for method in [Method::Program, Method::Bisection] {
        let settings = Settings { method, ..settings(ModelKind::One, 3) };
        let told = Mutex::new(Vec::new());
        let run = |stop_after: usize, resume: Option<&Path>| {
            told.lock().unwrap().clear();
            let finished = |words: &str| {
                let mut told = told.lock().unwrap_or_else(|stopped| stopped.into_inner());
                told.push(words.to_string());
                assert!(told.len() < stop_after, "interrupted");
            };
            conform(
                &robot,
                &data,
                &[],
                &settings,
                &Watch { finished: &finished, resume, ..Watch::SILENT },
            )
        };
        let whole = run(usize::MAX, None).unwrap();
        let all = told.lock().unwrap().clone();
        assert!(catch_unwind(AssertUnwindSafe(|| run(3, Some(&path)))).is_err());
        told.clear_poison();
        assert!(path.exists());
        let other = Settings { disturbance: Disturbance::Constant, ..settings.clone() };
        let watch = Watch { resume: Some(&path), ..Watch::SILENT };
        let refused = conform(&robot, &data, &[], &other, &watch).unwrap_err().to_string();
        assert!(
            refused.contains("progress.json: it holds the progress of another job"),
            "{refused}"
        );
        let resumed = run(usize::MAX, Some(&path)).unwrap();
        assert_eq!(resumed.sets, whole.sets);
        assert_eq!(*told.lock().unwrap(), all[3..]);
        assert!(!path.exists());
    }
}

#[test]
fn a_model_that_runs_away_is_refused_with_the_time() {
    let folder = tempfile::tempdir().unwrap();
    let robot = bent();
    let model = model_of(&robot, &settings(ModelKind::One, 1));
    let mut runs = recorded(&model, &grid(0.01, 200), 2, [0.01, 0.0], 9);
    // Far above the peak of v (2 + 0.2 v - 0.3 v²).
    runs.iter_mut().for_each(|run| run.torques.iter_mut().for_each(|u| *u = 40.0));
    write_data_set(folder.path(), &[("a", runs)]);
    let data = DataSet::open(folder.path()).unwrap();
    let error =
        conform(&robot, &data, &[], &settings(ModelKind::One, 3), &Watch::SILENT).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("suite a: the model runs away after 0.") && text.contains("--until"),
        "{text}"
    );
}

/// Sets under which the model may run away have no reachable set to the end, and that is the
/// answer.
#[test]
fn a_reachable_set_that_is_lost_is_an_answer() {
    let folder = tempfile::tempdir().unwrap();
    let (robot, settings) = (bent(), settings(ModelKind::One, 3));
    let data = two_suites(folder.path(), &model_of(&robot, &settings));
    let found = conform(&robot, &data, &[], &settings, &Watch::SILENT).unwrap();
    let mut model = Model::new(&robot, &data, &settings, &found);
    model.input_set.radius = vec![20.0; 2];
    let answer = check(&model, &data, &[], &settings, &|_, _| {}).unwrap();
    assert!(!answer.conformant && answer.lost.len() == 2, "{answer:?}");
    assert!(answer.violations.count > 0 && answer.violations.worst.is_none());
    serde_json::from_str::<serde_json::Value>(&serde_json::to_string(&answer).unwrap()).unwrap();
}
