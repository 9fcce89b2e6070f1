//! Recordings as motions of the model, on recordings whose disturbances and noise are known.

mod common;

use std::path::Path;

use common::{
    Disturbed, Random, Recorded, check_against, conform_all, grid, read, two_joints, write_data_set,
};
use reachtube_abstraction::{Abstraction, ModelKind};
use reachtube_conform::{
    Error, Hulls, Keep, Model, Noise, Notion, Problem, Settings, Setup, Silent, UncertaintySets,
    Verdict,
};
use reachtube_reach::{Disturbance, Hyperrectangle};
use reachtube_recordings::{DataSet, Torque};

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

/// The verdict on the recordings in `folder` for sets about 0 with U of ± `input` N m.
fn verdict(folder: &Path, input: f64) -> Verdict {
    let problem = read(&two_joints(), folder, &[], &settings(Notion::Trace));
    // The nominal starts at the mean of the runs, at most 0.011 from the middle of the starts.
    let sets = UncertaintySets {
        initial_set: Hyperrectangle { centre: vec![0.0; 4], radius: vec![0.021; 4] },
        input_set: Hyperrectangle { centre: vec![0.0; 2], radius: vec![input; 2] },
        noise_set: Some(Hyperrectangle { centre: vec![0.0; 4], radius: NOISE.into() }),
    };
    let hulls = Hulls::new(&problem, sets).unwrap();
    Verdict::new(&problem, &hulls, |_, _, _| ()).unwrap()
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
            Err(error @ Error::Trace(_)) => error.to_string(),
            answer => panic!("{answer:?}"),
        }
    };
    let words = refused(|settings| settings.noise = Noise::None);
    assert!(words.contains("--noise 0.001,0.01"), "{words}");
    let words = refused(|settings| settings.noise = Noise::Fixed(vec![1e-3, 1e-3, 1e-2, 0.0]));
    assert!(words.contains("in every state"), "{words}");
    let words = refused(|settings| settings.disturbance = Disturbance::Constant);
    assert!(words.contains("--disturbance sample"), "{words}");
    let words = refused(|settings| {
        settings.abstraction = Abstraction { model: ModelKind::Two, order: 3 };
    });
    assert!(words.contains("linear models only") && words.contains("--explain"), "{words}");
}
