//! Recordings as motions of the model, on recordings whose disturbances and noise are known.

use std::path::Path;

use crate::common::{
    Disturbed, Random, Recorded, bent, check_against, conform_all, grid, read, two_joints,
    write_data_set,
};
use reachtube_abstraction::{Abstraction, ModelField, ModelKind, PolynomialModel};
use reachtube_conform::result::FrontEnd;
use reachtube_conform::{
    Error, Keep, Model, Noise, Notion, Problem, Settings, Setup, Silent, Tube, UncertaintySets,
    Verdict,
};
use reachtube_ode::{DormandPrince, InitialValueProblem, Tolerance};
use reachtube_reach::{Disturbance, Hyperrectangle};
use reachtube_recordings::{DataSet, Torque};
use reachtube_robot::Robot;

/// Noise of positions and velocities, rad and rad/s.
const NOISE: [f64; 4] = [1e-4, 1e-4, 1e-3, 1e-3];

fn settings(notion: Notion) -> Settings {
    Settings { notion, noise: Noise::Fixed(NOISE.into()), ..Settings::new(Torque::Compensated, 2) }
}

/// Runs from within ± 0.01 rad and rad/s, whose inputs are off by ± 0.5 N m and whose states are
/// measured with noise.
fn recorded(runs: usize) -> Vec<Recorded> {
    let (robot, times, mut random) = (two_joints(), grid(0.01, 50), Random(3));
    let arm = Disturbed { robot: &robot, times: &times, start: 0.01, input: 0.5 };
    let mut noisy = || {
        let mut run = arm.record(&mut random);
        for (at, x) in run.states.iter_mut().enumerate() {
            *x += NOISE[at % 4] * random.signed();
        }
        run
    };
    (0..runs).map(|_| noisy()).collect()
}

/// The verdict on the recordings of `robot` in `folder` for sets about 0 with U of ± `input` N m.
fn verdict_of(robot: &Robot, settings: &Settings, folder: &Path, input: f64) -> Verdict {
    let problem = read(robot, folder, &[], settings);
    // The nominal starts at the mean of the runs, at most 0.011 from the middle of the starts.
    let sets = UncertaintySets {
        initial_set: Hyperrectangle { centre: vec![0.0; 4], radius: vec![0.021; 4] },
        input_set: Hyperrectangle { centre: vec![0.0; 2], radius: vec![input; 2] },
        noise_set: Some(Hyperrectangle { centre: vec![0.0; 4], radius: NOISE.into() }),
    };
    let tube = Tube::new(&problem, sets).unwrap();
    let verdict = Verdict::new(&problem, &tube).unwrap();
    // A verdict asks the points that its claim names, for sets of any origin.
    assert!(verdict.points.as_ref().is_some_and(|points| points.points > 0));
    verdict
}

fn verdict(folder: &Path, input: f64) -> Verdict {
    verdict_of(&two_joints(), &settings(Notion::Trace), folder, input)
}

/// Runs of the model of the settings, integrated by another method, from within ± 0.01 rad and
/// rad/s, whose inputs are off by ± 0.5 N m, at each sample or by one number throughout, and whose
/// states are measured with noise.
fn motions(robot: &Robot, settings: &Settings, runs: usize) -> Vec<Recorded> {
    let Abstraction { model, order } = settings.abstraction;
    let model = PolynomialModel::new(robot, model, order, &settings.expansion_point).unwrap();
    let (times, mut random) = (grid(0.01, 50), Random(5));
    let torques: Vec<f64> =
        times.iter().flat_map(|t| [2.0 * (2.0 * t).sin(), 1.5 * (3.0 * t).cos()]).collect();
    let is_constant = settings.disturbance == Disturbance::Constant;
    let mut record = || {
        let start: Vec<f64> = (0..4).map(|i| 0.1 * i as f64 + 0.01 * random.signed()).collect();
        let constant = [0.5 * random.signed(), 0.5 * random.signed()];
        let off = |j: usize| if is_constant { constant[j] } else { 0.5 * random.signed() };
        let inputs: Vec<f64> = torques[..98]
            .iter()
            .zip([0, 1].into_iter().cycle().map(off))
            .map(|(u, d)| u + d)
            .collect();
        let (mut states, start) = (Vec::new(), model.state(&start[..2], &start[2..]));
        let outcome = DormandPrince::new(model.states(), Tolerance::default()).simulate(
            &mut ModelField::new(&model),
            &times,
            InitialValueProblem { start: &start, inputs: &inputs },
            |_, x| states.extend(&x[..4]),
        );
        assert!(outcome.is_reached());
        let mut noisy = |(at, x): (usize, f64)| x + NOISE[at % 4] * random.signed();
        let states = states.into_iter().enumerate().map(&mut noisy).collect();
        Recorded { times: times.clone(), states, torques: torques.clone() }
    };
    (0..runs).map(|_| record()).collect()
}

/// Models that are not linear, and disturbances that never change.
#[test]
fn motions_of_other_models_and_of_a_constant_disturbance_are_found_and_proved() {
    let robot = bent();
    let all = [
        (ModelKind::One, 1, Disturbance::Constant),
        (ModelKind::One, 3, Disturbance::Sample),
        (ModelKind::Two, 3, Disturbance::Sample),
        (ModelKind::Two, 3, Disturbance::Constant),
    ];
    for (model, order, disturbance) in all {
        let folder = tempfile::tempdir().unwrap();
        let abstraction = Abstraction { model, order };
        let settings = Settings { abstraction, disturbance, ..settings(Notion::Trace) };
        write_data_set(folder.path(), &[("a", motions(&robot, &settings, 6))]);
        let known = verdict_of(&robot, &settings, folder.path(), 0.5).traces.unwrap();
        assert_eq!((known.unproved, known.factor), (0, Some(1.0)), "{model:?} {disturbance:?}");
        // With a quarter of U, up to four times as much is needed.
        let less = verdict_of(&robot, &settings, folder.path(), 0.125);
        let factor = less.traces.unwrap().factor.unwrap();
        assert!(!less.conformant && (2.5..4.1).contains(&factor), "{model:?} {factor}");
    }
}

#[test]
fn sets_of_a_model_that_is_not_linear_are_widened_until_every_recording_is_a_motion() {
    let (robot, folder) = (bent(), tempfile::tempdir().unwrap());
    let abstraction = Abstraction { model: ModelKind::One, order: 3 };
    let settings = Settings { abstraction, ..settings(Notion::Trace) };
    write_data_set(folder.path(), &[("a", motions(&robot, &settings, 5))]);
    let of = |notion: Notion| {
        let settings = Settings { notion, ..settings.clone() };
        conform_all(&read(&robot, folder.path(), &[], &settings))
    };
    let (exact, trace) = (of(Notion::Exact), of(Notion::Trace));
    assert!(trace.verdict.conformant && trace.cost > exact.cost, "{:?}", trace.verdict);
    assert_eq!(trace.verdict.traces.unwrap().unproved, 0);
    let ratio = trace.sets.input_set.radius[0] / exact.sets.input_set.radius[0];
    assert!(ratio > 1.05, "{ratio}");
}

/// One input held throughout cannot follow what changed at each sample.
#[test]
fn a_constant_disturbance_is_not_one_that_changes() {
    let (robot, folder) = (bent(), tempfile::tempdir().unwrap());
    let abstraction = Abstraction { model: ModelKind::One, order: 1 };
    let changing = Settings { abstraction, ..settings(Notion::Trace) };
    write_data_set(folder.path(), &[("a", motions(&robot, &changing, 4))]);
    let constant = Settings { disturbance: Disturbance::Constant, ..changing.clone() };
    let of = |settings: &Settings| {
        verdict_of(&robot, settings, folder.path(), 0.5).traces.unwrap().unproved
    };
    assert_eq!((of(&changing), of(&constant)), (0, 4));
}

#[test]
fn motions_under_the_sets_are_found_and_proved() {
    let folder = tempfile::tempdir().unwrap();
    write_data_set(folder.path(), &[("a", recorded(12))]);
    let known = verdict(folder.path(), 0.5);
    let traces = known.traces.clone().unwrap();
    assert!(known.conformant && traces.unproved == 0, "{known:?}");
    assert_eq!((traces.factor, traces.worst), (Some(1.0), None));
    // With half of U, twice as much is needed; the noise hides a little of it.
    let half = verdict(folder.path(), 0.25);
    let traces = half.traces.clone().unwrap();
    let factor = traces.factor.unwrap();
    assert!(!half.conformant && (1.7..=2.02).contains(&factor), "{traces:?}");
    assert_eq!(half.suites[0].traces_unproved, Some(traces.unproved));
    assert!(half.suites[0].violating_runs.contains(&traces.worst.unwrap()));
}

#[test]
fn a_velocity_that_is_not_that_of_the_position_has_no_motion() {
    let folder = tempfile::tempdir().unwrap();
    let mut runs = recorded(3);
    runs[1].states.chunks_exact_mut(4).for_each(|x| x[2] *= 1.2);
    write_data_set(folder.path(), &[("a", runs)]);
    let traces = verdict(folder.path(), 0.5).traces.unwrap();
    assert_eq!((traces.unproved, traces.factor), (1, None));
    assert_eq!(traces.worst.as_deref(), Some("a_01.csv"));
}

#[test]
fn sets_of_traces_cost_more_than_those_of_points_and_are_proved() {
    let folder = tempfile::tempdir().unwrap();
    write_data_set(folder.path(), &[("a", recorded(6)), ("b", recorded(4))]);
    let found = |notion: Notion| {
        let problem = read(&two_joints(), folder.path(), &[], &settings(notion));
        let found = conform_all(&problem);
        assert!(found.verdict.conformant, "{notion:?} {:?}", found.verdict);
        (Model::new(&problem, &found), found.cost)
    };
    let ((mut exact, least), (trace, cost)) = (found(Notion::Exact), found(Notion::Trace));
    assert!(cost > least && trace.gap_of_not_minimal().is_some(), "{cost} {least}");
    assert!(check_against(&trace, folder.path(), &[]).verdict.conformant);
    // The sets of the points are too small for the motions, by the factor that was found.
    exact.settings.notion = Notion::Trace;
    let verdict = check_against(&exact, folder.path(), &[]).verdict;
    let factor = verdict.traces.unwrap().factor.unwrap();
    let ratio = trace.input_set.radius[0] / exact.input_set.radius[0];
    assert!(!verdict.conformant && (factor / ratio - 1.0).abs() < 0.02, "{factor} {ratio}");
}

#[test]
fn what_the_notion_is_not_for_is_refused_with_the_remedy() {
    let folder = tempfile::tempdir().unwrap();
    write_data_set(folder.path(), &[("a", recorded(3))]);
    let refused = |change: fn(&mut Settings)| {
        let mut settings = settings(Notion::Trace);
        change(&mut settings);
        let setup = Setup::new(two_joints(), settings).unwrap();
        let data = Box::new(DataSet::open(folder.path()).unwrap());
        match Problem::read(setup, data, &[], Keep::Needed, &Silent) {
            Err(error @ Error::Trace(_)) => error.written_for(FrontEnd::CommandLine),
            answer => panic!("{answer:?}"),
        }
    };
    let words = refused(|settings| settings.noise = Noise::None);
    assert!(words.contains("--noise 0.001,0.01"), "{words}");
    let words = refused(|settings| settings.noise = Noise::Fixed(vec![1e-3, 1e-3, 1e-2, 0.0]));
    assert!(words.contains("in every state"), "{words}");
}
