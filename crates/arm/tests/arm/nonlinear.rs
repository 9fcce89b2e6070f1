//! Conformance of models that are not linear, on recordings whose disturbances are known and on the
//! paper's own.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, Mutex};

use crate::common::{
    self, Random, Recorded, bent, check_against, conform_all, grid, read, read_with, setup,
    write_data_set,
};
use reachtube_abstraction::{Abstraction, ExpansionPoint, ModelField, ModelKind, PolynomialModel};
use reachtube_arm::ArmSettings;
use reachtube_conform::settings::Method;
use reachtube_conform::tube::Enclosure;
use reachtube_conform::{
    Conformance, Model, Notion, Problem, Progress, Settings, Silent, Tube, UncertaintySets,
    Verdict, check, conform,
};
use reachtube_finding::FrontEnd;
use reachtube_ode::{DormandPrince, InitialValueProblem, Tolerance};
use reachtube_reach::{Disturbance, Hyperrectangle, System as Dynamics};
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

/// A model and its order.
type Kind = (ModelKind, u32);

const LINEAR: Kind = (ModelKind::One, 1);
const CUBIC: Kind = (ModelKind::One, 3);

fn model_of(robot: &Robot, (model, order): Kind) -> PolynomialModel {
    PolynomialModel::new(robot, model, order, &ExpansionPoint::zero(robot.joint_count())).unwrap()
}

/// Reads all suites in a folder for a model of the bent robot.
fn read_for(folder: &Path, (model, order): Kind, settings: &Settings) -> Problem {
    let setup = setup(&bent(), |arm, sets| {
        arm.abstraction = Abstraction { model, order };
        sets.clone_from(settings);
    });
    read_with(setup, folder, &[])
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
        let run = InitialValueProblem { start: &start, inputs: &inputs };
        let mut solver = DormandPrince::new(model.states(), Tolerance::default());
        let outcome =
            solver.simulate(&mut ModelField::new(model), times, run, |_, x| states.extend(&x[..4]));
        assert!(outcome.is_reached());
        Recorded { times: times.to_vec(), states, torques }
    };
    (0..runs).map(record).collect()
}

/// Two suites of the model.
fn two_suites(folder: &Path, model: &PolynomialModel) {
    let suites = [
        ("a", recorded(model, &grid(0.01, 90), 8, [0.02, 0.3], 5)),
        ("b", recorded(model, &grid(0.01, 60), 6, [0.02, 0.3], 6)),
    ];
    write_data_set(folder, &suites);
}

fn radii(sets: &UncertaintySets) -> Vec<f64> {
    let all = |set: &Hyperrectangle| [set.centre.clone(), set.radius.clone()].concat();
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
fn the_long_way(robot: &Robot, folder: &Path, names: &[&str], settings: &Settings) -> Conformance {
    let dynamics = Dynamics::Nonlinear(Arc::new(model_of(robot, LINEAR)));
    let arm = ArmSettings::new(Torque::Compensated, robot.joint_count());
    let setup = reachtube_arm::setup_of(robot.clone(), dynamics, arm, settings.clone());
    conform_all(&read_with(setup.unwrap(), folder, names))
}

#[test]
fn a_linear_model_has_the_sets_of_the_one_program() {
    let folder = tempfile::tempdir().unwrap();
    let robot = bent();
    two_suites(folder.path(), &model_of(&robot, LINEAR));
    for disturbance in [Disturbance::Sample, Disturbance::Constant] {
        let settings = Settings { disturbance, ..Settings::default() };
        let short = conform_all(&read(&robot, folder.path(), &[], &settings));
        let long = the_long_way(&robot, folder.path(), &[], &settings);
        assert!(short.verdict.conformant && long.verdict.conformant);
        assert_eq!(
            (short.verdict.enclosure, long.verdict.enclosure),
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
#[ignore = "needs the recordings in ../shared"]
fn the_first_schunk_samples_have_the_costs_of_the_one_program() {
    let folder = common::shared("schunk_lwa4p");
    let settings = Settings { until: Some(0.6), ..Settings::default() };
    let (robot, suites) = (Robot::lwa4p(), ["A", "B", "D", "E"]);
    let short = conform_all(&read(&robot, &folder, &suites, &settings));
    let long = the_long_way(&robot, &folder, &suites, &settings);
    let cost = long.search.as_ref().unwrap().linearised_cost.unwrap();
    assert!((cost / short.cost - 1.0).abs() < 1e-6, "{cost} for {}", short.cost);
    assert!(long.verdict.conformant && long.cost < 1.001 * cost, "{}", long.cost);
}

#[test]
#[ignore = "needs the recordings in ../shared; takes long: all samples on the way of the others"]
fn the_schunk_recordings_have_the_costs_of_the_one_program() {
    let folder = common::shared("schunk_lwa4p");
    let (settings, suites) = (Settings::default(), ["A", "B", "D", "E"]);
    let long = the_long_way(&Robot::lwa4p(), &folder, &suites, &settings);
    let cost = long.search.as_ref().unwrap().linearised_cost_of_samples.unwrap();
    // The optimum found by HiGHS, as in the test of the linear route.
    assert!((cost / 6_048.047_985_391_407 - 1.0).abs() < 1e-6, "{cost}");
    let enclosed = long.cost_of_samples;
    assert!(long.verdict.conformant && enclosed < 1.001 * cost, "{enclosed}");
}

#[test]
fn sets_of_each_model_enclose_its_runs_and_are_not_wider_than_what_was_there() {
    for kind in [CUBIC, (ModelKind::Two, 4), (ModelKind::Three, 3)] {
        let folder = tempfile::tempdir().unwrap();
        two_suites(folder.path(), &model_of(&bent(), kind));
        let problem = read_for(folder.path(), kind, &Settings::default());
        let found = conform_all(&problem);
        let search = found.search.clone().unwrap();
        assert!(
            found.verdict.conformant && found.verdict.rows == 4 * 150,
            "{kind:?}: {:?}",
            found.verdict
        );
        assert!(search.rounds < 20 && search.runs_away.is_none(), "{search:?}");
        // Nominals start at the mean of the runs: sets that were there have at most twice the
        // radius of the starts.
        let widest = |set: &Hyperrectangle| set.radius.iter().fold(0.0, |max: f64, r| max.max(*r));
        assert!(
            widest(&found.sets.initial_set) < 0.1 && widest(&found.sets.input_set) < 0.6,
            "{:?}",
            found.sets
        );
        let model = Model::new(&problem, &found);
        let path = folder.path().join("model.json");
        std::fs::write(&path, model.to_json()).unwrap();
        let loaded = reachtube_arm::open(&path).unwrap().0;
        assert_eq!(loaded, model);
        assert!(check_against(&loaded, folder.path(), &[]).verdict.conformant);
    }
}

/// Sets that are smaller in any radius by a few parts in a hundred leave a run out: the rows that
/// decide are met by motions of the model itself.
#[test]
fn no_radius_can_be_made_smaller_alone() {
    let folder = tempfile::tempdir().unwrap();
    two_suites(folder.path(), &model_of(&bent(), CUBIC));
    let problem = read_for(folder.path(), CUBIC, &Settings::default());
    let found = conform_all(&problem);
    let model = Model::new(&problem, &found);
    let largest = found.sets.input_set.radius.iter().fold(0.0, |max: f64, r| max.max(*r));
    for joint in (0..2).filter(|joint| found.sets.input_set.radius[*joint] > 0.1 * largest) {
        let mut smaller = model.clone();
        smaller.input_set.radius[joint] *= 0.95;
        let tube = Tube::new(&problem, smaller.sets()).unwrap();
        let answer = check(&smaller, &problem, &tube).unwrap().verdict;
        assert!(!answer.conformant && answer.violations.worst.is_some(), "joint {joint}");
    }
}

/// In the stronger notions as well, a linear model has the sets of the one program.
#[test]
fn a_linear_model_has_the_sets_of_the_cutting_planes() {
    let folder = tempfile::tempdir().unwrap();
    let robot = bent();
    two_suites(folder.path(), &model_of(&robot, LINEAR));
    for notion in [Notion::PhasePlane, Notion::Exact] {
        let settings = Settings { notion, ..Settings::default() };
        let short = conform_all(&read(&robot, folder.path(), &[], &settings));
        let long = the_long_way(&robot, folder.path(), &[], &settings);
        assert!(short.verdict.conformant && long.verdict.conformant, "{:?}", long.verdict);
        // The enclosure is for disturbances that change at any time, and a little wider, so that
        // the sets may be smaller.
        let ratio = long.search.as_ref().unwrap().linearised_cost.unwrap() / short.cost;
        assert!((0.99..1.001).contains(&ratio), "{notion:?}: {ratio}");
    }
}

#[test]
fn stronger_notions_cost_more_and_are_proved_for_each_model() {
    for kind in [CUBIC, (ModelKind::Two, 4)] {
        let folder = tempfile::tempdir().unwrap();
        two_suites(folder.path(), &model_of(&bent(), kind));
        let costs = [Notion::Hull, Notion::PhasePlane, Notion::Exact].map(|notion| {
            let settings = Settings { notion, ..Settings::default() };
            let problem = read_for(folder.path(), kind, &settings);
            let found = conform_all(&problem);
            assert!(found.verdict.conformant, "{kind:?} {notion:?}: {:?}", found.verdict);
            let points = found.verdict.points.as_ref().map(|points| points.points);
            let all = 8 * 89 + 6 * 59;
            let expected = match notion {
                Notion::Hull => None,
                Notion::PhasePlane => Some(2 * all),
                Notion::Exact => Some(all),
            };
            assert_eq!(points, expected);
            let mut model = Model::new(&problem, &found);
            model.settings.notion = Notion::Exact;
            let exact = check_against(&model, folder.path(), &[]).verdict;
            let points = exact.points.unwrap();
            assert_eq!(exact.conformant, notion == Notion::Exact, "{kind:?} {notion:?}");
            assert_eq!(points.outside > 0, notion != Notion::Exact);
            assert_eq!(points.worst.is_some(), points.outside > 0);
            if let Some(worst) = points.worst {
                assert!(worst.value > worst.reach && worst.combination.contains('q'), "{worst:?}");
            }
            found.cost
        });
        assert!(costs[0] < costs[1] && costs[1] < costs[2], "{kind:?} {costs:?}");
        assert!(costs[2] < 2.0 * costs[0], "{kind:?} {costs:?}");
    }
}

/// Motions of the model itself lie in its computed sets, in all states together.
#[test]
fn points_of_motions_under_the_sets_are_proved() {
    let folder = tempfile::tempdir().unwrap();
    let kind = (ModelKind::Two, 4);
    let exact = Settings { notion: Notion::Exact, ..Settings::default() };
    let runs = recorded(&model_of(&bent(), kind), &grid(0.01, 60), 40, [0.02, 0.3], 11);
    write_data_set(folder.path(), &[("a", runs)]);
    let problem = read_for(folder.path(), kind, &exact);
    // The nominal starts at the mean of the runs, at most 0.02 from the middle of the starts.
    let sets = |input: f64| UncertaintySets {
        initial_set: Hyperrectangle { centre: vec![0.0; 4], radius: vec![0.04; 4] },
        input_set: Hyperrectangle { centre: vec![0.0; 2], radius: vec![input; 2] },
        noise_set: None,
    };
    let verdict = |input: f64| {
        let tube = Tube::new(&problem, sets(input)).unwrap();
        Verdict::new(&problem, &tube).unwrap()
    };
    let (known, less) = (verdict(0.3), verdict(0.05));
    assert!(known.conformant && known.points.unwrap().points == 40 * 59);
    assert!(!less.conformant && less.points.unwrap().outside > 0);
}

#[test]
fn bisection_costs_more_than_the_programs() {
    let folder = tempfile::tempdir().unwrap();
    two_suites(folder.path(), &model_of(&bent(), CUBIC));
    let found = |settings: &Settings| conform_all(&read_for(folder.path(), CUBIC, settings));
    let program = found(&Settings::default());
    let bisection = Settings { method: Method::Bisection, ..Settings::default() };
    let baseline = found(&bisection);
    assert!(program.verdict.conformant && baseline.verdict.conformant);
    assert!(baseline.cost > 0.999 * program.cost, "{} for {}", baseline.cost, program.cost);
    assert!(baseline.search.unwrap().reachable_sets > 10 * program.search.unwrap().reachable_sets);
    let planes = Settings { notion: Notion::PhasePlane, ..bisection };
    let planes = found(&planes);
    assert!(planes.verdict.conformant && planes.cost > 0.99 * baseline.cost, "{}", planes.cost);
}

/// Collects what a search reports, and stops it by a panic after some messages.
struct Interrupting {
    messages: Mutex<Vec<String>>,
    stop_after: usize,
}

impl Interrupting {
    fn after(stop_after: usize) -> Self {
        Self { messages: Mutex::default(), stop_after }
    }

    fn messages(&self) -> Vec<String> {
        self.messages.lock().unwrap().clone()
    }
}

impl Progress for Interrupting {
    fn finished(&self, what: &str) {
        let mut messages = self.messages.lock().unwrap();
        messages.push(what.to_string());
        assert!(messages.len() < self.stop_after, "interrupted");
    }
}

/// An interrupted search continues where it was, and comes to the same sets bit by bit.
#[test]
fn a_search_goes_on_where_it_was_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    two_suites(folder.path(), &model_of(&bent(), CUBIC));
    let path = folder.path().join("progress.json");
    for method in [Method::Program, Method::Bisection] {
        let settings = Settings { method, ..Settings::default() };
        let problem = read_for(folder.path(), CUBIC, &settings);
        let uninterrupted = Interrupting::after(usize::MAX);
        let whole = conform(&problem, &uninterrupted, None).unwrap();
        let stopped = Interrupting::after(3);
        let run = AssertUnwindSafe(|| conform(&problem, &stopped, Some(&path)).map(|_| ()));
        assert!(catch_unwind(run).is_err() && path.exists());
        let other = Settings { disturbance: Disturbance::Constant, ..settings.clone() };
        let other = read_for(folder.path(), CUBIC, &other);
        let refused = conform(&other, &Silent, Some(&path)).unwrap_err().to_string();
        let words = "progress.json: it holds the progress of another job";
        assert!(refused.contains(words), "{refused}");
        let resuming = Interrupting::after(usize::MAX);
        let resumed = conform(&problem, &resuming, Some(&path)).unwrap();
        assert_eq!(resumed.sets, whole.sets);
        assert_eq!(resuming.messages(), uninterrupted.messages()[3..]);
        assert!(!path.exists());
    }
}

#[test]
fn a_model_that_runs_away_is_refused_with_the_time() {
    let folder = tempfile::tempdir().unwrap();
    let mut runs = recorded(&model_of(&bent(), LINEAR), &grid(0.01, 200), 2, [0.01, 0.0], 9);
    // Far above the peak of v (2 + 0.2 v - 0.3 v²).
    runs.iter_mut().for_each(|run| run.torques.iter_mut().for_each(|u| *u = 40.0));
    write_data_set(folder.path(), &[("a", runs)]);
    let problem = read_for(folder.path(), CUBIC, &Settings::default());
    let text = conform(&problem, &Silent, None).unwrap_err().written_for(FrontEnd::Python);
    assert!(
        text.contains("suite a: the model runs away after 0.") && text.contains("(until=0."),
        "{text}"
    );
}

/// Sets under which the model may diverge have no reachable set to the end, and that is the answer.
#[test]
fn a_reachable_set_that_is_lost_is_an_answer() {
    let folder = tempfile::tempdir().unwrap();
    two_suites(folder.path(), &model_of(&bent(), CUBIC));
    let problem = read_for(folder.path(), CUBIC, &Settings::default());
    let found = conform_all(&problem);
    let mut model = Model::new(&problem, &found);
    model.input_set.radius = vec![20.0; 2];
    let answer = check(&model, &problem, &Tube::new(&problem, model.sets()).unwrap()).unwrap();
    let verdict = &answer.verdict;
    assert!(!verdict.conformant && verdict.lost.len() == 2, "{answer:?}");
    assert!(verdict.violations.count > 0 && verdict.violations.worst.is_none());
    serde_json::from_str::<serde_json::Value>(&serde_json::to_string(&answer).unwrap()).unwrap();
}
