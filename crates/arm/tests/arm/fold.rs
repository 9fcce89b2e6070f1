//! Folds of recordings give the model files of the recordings, to the last bit, however they are
//! grouped and in whatever order they come.

use crate::common::{Disturbed, Random, fold_of, grid, setup, two_joints};
use proptest::prelude::*;
use reachtube_abstraction::{Abstraction, ModelKind};
use reachtube_arm::ArmSettings;
use reachtube_conform::fleet::{Fold, OnDefect};
use reachtube_conform::settings::NominalStart;
use reachtube_conform::{
    Error, Keep, Model, Problem, Settings, Setup, Silent, Tube, check, conform,
};
use reachtube_finding::FrontEnd;
use reachtube_recordings::{Defect, MemoryRuns, Run, RunEntry, RunSource};
use reachtube_robot::Robot;
use reachtube_robot::friction::{Warming, WarmingBy};

/// Suites of virtual recordings whose input is the suite's own; runs of B are of different lengths,
/// and runs of D have an input each.
fn campaign(robot: &Robot, suites: &[(&str, usize)]) -> MemoryRuns {
    seeded(robot, suites, 7)
}

fn seeded(robot: &Robot, suites: &[(&str, usize)], seed: u64) -> MemoryRuns {
    let mut runs = MemoryRuns::default();
    let mut random = Random(seed);
    let most = suites.iter().map(|(_, count)| *count).max().unwrap_or(0);
    for index in 0..most {
        for (suite, _) in suites.iter().filter(|(_, count)| index < *count) {
            let samples = if *suite == "B" { 30 + index % 4 } else { 36 };
            let times = grid(0.01, samples);
            let arm = Disturbed { robot, times: &times, start: 0.01, input: 0.5 };
            let mut run = arm.record(&mut random);
            if *suite == "D" {
                run.torques[1] += 0.001 * index as f64;
            }
            let run = Run::new(2, run.times, run.states, run.torques).unwrap();
            let motion = (*suite != "C").then(|| if *suite == "A" { "lift" } else { "turn" });
            // The motion of a suite may be named by a later run alone.
            let motion = motion.filter(|_| *suite != "B" || index == 2);
            runs.push(&format!("{suite}{index:05}"), Some(suite), motion, run);
        }
    }
    runs
}

const SUITES: [(&str, usize); 4] = [("A", 9), ("B", 7), ("C", 5), ("D", 3)];

/// Nonlinear, so that each case has a flowpipe of its own.
fn cubic(arm: &mut ArmSettings, _: &mut Settings) {
    arm.abstraction = Abstraction { model: ModelKind::One, order: 3 };
}

fn model_of(problem: &Problem) -> String {
    let found = conform(problem, &Silent, None).unwrap();
    assert!(found.verdict.conformant);
    Model::new(problem, &found).to_json()
}

fn read(setup: &Setup, runs: &MemoryRuns) -> Problem {
    let runs = Box::new(runs.clone());
    Problem::read(setup.clone(), runs, &[], Keep::Needed, &Silent).unwrap()
}

/// Takes run `index` of a source at its place.
fn take(fold: &mut Fold, runs: &MemoryRuns, index: usize) {
    let read = runs.read(index, &fold.read_options());
    fold.take(index as u64, &runs.runs()[index], read).unwrap();
}

/// Folds the runs, each in the part it is assigned to and in this order, and merges the parts as
/// `merges` say, through bytes.
fn grouped(
    setup: &Setup,
    runs: &MemoryRuns,
    order: &[usize],
    parts: &[usize],
    merges: &[usize],
) -> Fold {
    let mut folds = vec![Fold::new(setup).unwrap(); 1 + parts.iter().max().unwrap_or(&0)];
    order.iter().for_each(|&index| take(&mut folds[parts[index]], runs, index));
    let mut merges = merges.iter().cycle();
    while folds.len() > 1 {
        let first = folds.swap_remove(merges.next().unwrap() % folds.len()).to_bytes();
        let other = folds.swap_remove(merges.next().unwrap() % folds.len());
        let mut merged = Fold::from_bytes(setup, &first).unwrap();
        merged.merge(other).unwrap();
        folds.push(merged);
    }
    folds.pop().unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(24)
    })]

    #[test]
    fn any_grouping_in_any_order_gives_the_model_file_of_one_machine(
        order in Just((0..24).collect::<Vec<usize>>()).prop_shuffle(),
        parts in prop::collection::vec(0usize..5, 24),
        merges in prop::collection::vec(0usize..100, 10),
    ) {
        let robot = two_joints();
        let runs = campaign(&robot, &SUITES);
        let setup = setup(&robot, |_, _| {});
        let fold = grouped(&setup, &runs, &order, &parts, &merges);
        let whole = fold_of(&setup, &runs);
        prop_assert_eq!(fold.to_bytes(), whole.to_bytes());
        let problem = Problem::of_fold(setup.clone(), fold, OnDefect::Refuse).unwrap();
        let once = read(&setup, &runs);
        prop_assert_eq!(&problem.recordings().notes, &once.recordings().notes);
        prop_assert_eq!(model_of(&problem), model_of(&once));
    }
}

#[test]
fn models_that_are_not_linear_and_starts_of_their_own_give_the_same_files() {
    let robot = two_joints();
    let runs = campaign(&robot, &[("A", 5), ("B", 4), ("D", 3)]);
    let own: fn(&mut _, &mut Settings) = |_, settings| settings.nominal = NominalStart::Own;
    let calibrated: fn(&mut _, &mut Settings) = |_, sets| sets.calibrate = vec!["lift".into()];
    for adjust in [cubic, own, calibrated] {
        let setup = setup(&robot, adjust);
        let order: Vec<usize> = (0..12).rev().collect();
        let parts: Vec<usize> = (0..12).map(|index| index % 3).collect();
        let fold = grouped(&setup, &runs, &order, &parts, &[1, 0, 2]);
        let problem = Problem::of_fold(setup.clone(), fold, OnDefect::Refuse).unwrap();
        assert_eq!(model_of(&problem), model_of(&read(&setup, &runs)));
    }
}

/// Friction that depends on the run: each run is a case of its own although all share their input,
/// and the sets that hold for every run need the mean of the temperatures.
#[test]
fn robots_that_warm_up_give_the_same_files_and_need_every_run() {
    let runs = campaign(&two_joints(), &[("A", 6)]);
    let mut warm = MemoryRuns::default();
    for (index, entry) in runs.runs().iter().enumerate() {
        let run = runs.read(index, &Default::default()).unwrap();
        let temperatures = vec![20.1 + index as f64 / 3.0; run.len() * 2];
        let run = run.with_temperatures(temperatures).unwrap();
        warm.push(&entry.file, Some("A"), None, run);
    }
    for by in [WarmingBy::Temperature, WarmingBy::Runs] {
        let mut description = two_joints().description().clone();
        let law = Warming { by, reference: 20.0, viscous: 0.01, ..Warming::default() };
        description.joints.iter_mut().for_each(|joint| joint.friction.warming = Some(law));
        let robot = Robot::from_description(&description).unwrap();
        let setup = setup(&robot, |_, _| {});
        let fold = grouped(&setup, &warm, &[5, 1, 0, 2, 4, 3], &[0, 1, 0, 2, 2, 1], &[0, 1]);
        let problem = Problem::of_fold(setup.clone(), fold, OnDefect::Refuse).unwrap();
        let model = model_of(&problem);
        assert!(model.contains("any_run"));
        assert_eq!(model, model_of(&read(&setup, &warm)));
        let mut small = Fold::with_most_bytes(&setup, 5_000).unwrap();
        small.take_source(&warm, 0).unwrap();
        let Err(Error::Fold(why)) = Problem::of_fold(setup, small, OnDefect::Refuse) else {
            panic!("the fold has not kept every run")
        };
        assert!(why.problem.contains("friction depends on it"), "{why}");
    }
}

/// Everything that is drawn from large suites is drawn alike, and only the list of the recordings
/// is missing.
#[test]
fn a_fold_of_many_runs_differs_from_reading_in_the_list_of_recordings_alone() {
    let robot = two_joints();
    let runs = campaign(&robot, &[("A", 700), ("C", 310)]);
    let setup = setup(&robot, |_, _| {});
    let fold = fold_of(&setup, &runs);
    let problem = Problem::of_fold(setup.clone(), fold, OnDefect::Refuse).unwrap();
    let once = read(&setup, &runs);
    assert_eq!(problem.recordings().notes, once.recordings().notes);
    let value =
        |problem| -> serde_json::Value { serde_json::from_str(&model_of(problem)).unwrap() };
    let (mut own, mut other) = (value(&problem), value(&once));
    assert_eq!(own["data"]["root"], problem.recordings().root);
    assert_eq!(own["data"]["suites"][1]["run_count"], 310);
    assert_eq!(other["data"]["suites"][1]["runs"].as_array().unwrap().len(), 310);
    assert_eq!(once.recordings().root, problem.recordings().root);
    for value in [&mut own, &mut other] {
        value["data"] = serde_json::Value::Null;
        value["sha256"] = serde_json::Value::Null;
    }
    assert_eq!(own, other);
}

/// The size comes from the envelopes, the sample and the names of the runs that have a bound.
#[test]
fn the_size_in_bytes_does_not_grow_with_the_runs() {
    let robot = two_joints();
    let few = campaign(&robot, &[("A", 300)]);
    let setup = setup(&robot, |_, _| {});
    let size = |count: usize| {
        let mut fold = Fold::new(&setup).unwrap();
        for index in 0..count {
            let mut entry = few.runs()[index % 300].clone();
            entry.file = format!("A{index:05}");
            // Copies with digests of their own, so that the sample is drawn anew.
            let read = few.read(index % 300, &fold.read_options());
            let read = read.map(|run| Run { sha256: format!("{:064x}", digest(index)), ..run });
            fold.take(index as u64, &entry, read).unwrap();
        }
        fold.to_bytes().len()
    };
    let (small, large) = (size(1_000), size(20_000));
    // The numbers in the sample and of the owners take up to three bytes instead of two, each
    // count likewise, and the tree has up to 15 subtrees instead of 6.
    let numbers = 2 * 256 + 2 * 256 + 16;
    assert!(large.abs_diff(small) < numbers + 9 * 40, "{small} {large}");
    println!("{small} bytes for 1,000 runs, {large} for 20,000");
}

/// Scatters numbers.
fn digest(index: usize) -> u128 {
    u128::from((index as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15)) << 64
}

#[test]
fn recordings_are_checked_by_fold_as_by_reading() {
    let robot = two_joints();
    let runs = campaign(&robot, &SUITES);
    let setup_of_fit = setup(&robot, |_, _| {});
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.json");
    let mut fold = Fold::new(&setup_of_fit).unwrap();
    (0..12).for_each(|index| take(&mut fold, &runs, index));
    let problem = Problem::of_fold(setup_of_fit, fold, OnDefect::Refuse).unwrap();
    std::fs::write(&path, model_of(&problem)).unwrap();
    let (model, setup) = reachtube_arm::open(&path).unwrap();
    let checked = |problem: &Problem| {
        let tube = Tube::new(problem, model.sets()).unwrap();
        check(&model, problem, &tube).unwrap()
    };
    for range in [12..24, 6..18] {
        let mut other = MemoryRuns::default();
        for index in range.clone() {
            let (entry, run) = (&runs.runs()[index], runs.read(index, &Default::default()));
            other.push(&entry.file, entry.suite.as_deref(), None, run.unwrap());
        }
        let mut fold = Fold::to_check(&setup, &model).unwrap();
        let mut rest = fold.clone();
        fold.take_source(&other, 100).unwrap();
        take(&mut rest, &other, 0);
        rest.merge(Fold::from_bytes(&setup, &fold.to_bytes()).unwrap()).unwrap();
        let refused = rest.take(500, &runs.runs()[20], runs.read(20, &Default::default()));
        assert!(refused.is_ok());
        let mut stored = Fold::from_bytes(&setup, &fold.to_bytes()).unwrap();
        let refused = stored.take(1, &runs.runs()[20], runs.read(20, &Default::default()));
        assert!(matches!(refused, Err(Error::Fold(why)) if why.problem.contains("after it was")));
        let by_fold = Problem::of_fold(setup.clone(), fold, OnDefect::Refuse).unwrap();
        let (by_fold, once) = (checked(&by_fold), checked(&read(&setup, &other)));
        assert_eq!(by_fold, once);
        assert_eq!(by_fold.trust.is_some(), range.start == 12);
        let worst = by_fold.verdict.violations.worst.unwrap();
        let states = &by_fold.worst_by_state;
        assert!(states.iter().all(|of_state| of_state.excess <= worst.excess));
        assert!(states.contains(&worst) && states.len() <= 4);
        assert!(runs.runs().iter().any(|entry| entry.file == worst.run));
    }
}

#[test]
fn what_cannot_be_known_to_be_new_counts_as_used() {
    let robot = two_joints();
    let setup = setup(&robot, |_, _| {});
    let large = campaign(&robot, &[("A", 1100)]);
    let other = seeded(&robot, &[("C", 3)], 8);
    let fold = fold_of(&setup, &large);
    let problem = Problem::of_fold(setup.clone(), fold, OnDefect::Refuse).unwrap();
    let model = Model::new(&problem, &conform(&problem, &Silent, None).unwrap());
    assert!(model.data.root.is_some() && model.data.run_count() == 1100);
    let new = read(&setup, &other);
    assert_eq!(model.knows_of(new.recordings()), None);
    let tube = Tube::new(&new, model.sets()).unwrap();
    let answer = check(&model, &new, &tube).unwrap();
    assert!(answer.trust.is_none());
    assert!(answer.notes.iter().any(|note| note.contains("so they count as used")));
    // The other way round: a model that lists its recordings, and a fold that has not kept all.
    let small = read(&setup, &other);
    let model = Model::new(&small, &conform(&small, &Silent, None).unwrap());
    assert_eq!(model.knows_of(problem.recordings()), None);
    let mut fold = Fold::to_check(&setup, &model).unwrap();
    fold.take_source(&large, 0).unwrap();
    let compared = Problem::of_fold(setup.clone(), fold.clone(), OnDefect::Refuse).unwrap();
    assert_eq!(model.knows_of(compared.recordings()), Some(false));
    fold.take_source(&other, 2000).unwrap();
    let compared = Problem::of_fold(setup, fold, OnDefect::Refuse).unwrap();
    assert_eq!(model.knows_of(compared.recordings()), Some(true));
}

#[test]
fn defects_are_values_and_are_reported_when_asked_for() {
    let robot = two_joints();
    let runs = campaign(&robot, &SUITES);
    let setup = setup(&robot, |_, _| {});
    let mut fold = Fold::new(&setup).unwrap();
    for index in 0..24 {
        let read = match index {
            5 => Err(vec![Defect::new("A5.csv", Some(7), "it is cut off", "record it again")]),
            // Degrees in place of rad.
            7 => runs.read(7, &fold.read_options()).map(|run| Run {
                torques: run.torques.iter().map(|tau| 1e9 * tau).collect(),
                ..run
            }),
            _ => runs.read(index, &fold.read_options()),
        };
        fold.take(index as u64, &runs.runs()[index], read).unwrap();
    }
    let mut fold = Fold::from_bytes(&setup, &fold.to_bytes()).unwrap();
    assert_eq!((fold.run_count(), fold.defect_count()), (22, 2));
    assert_eq!(fold.defects()[0].to_string(), "A5.csv:7: it is cut off; record it again");
    let refused = Problem::of_fold(setup.clone(), fold.clone(), OnDefect::Refuse).unwrap_err();
    assert!(refused.to_string().contains("A5.csv:7"), "{refused}");
    // A place is taken by a recording with defects too.
    assert!(fold.take(5, &runs.runs()[5], runs.read(5, &Default::default())).is_err());
    let problem = Problem::of_fold(setup.clone(), fold, OnDefect::Report).unwrap();
    let note = &problem.recordings().notes[0];
    assert!(note.starts_with("2 recordings are left out") && note.contains("A5.csv:7"), "{note}");
    let model: serde_json::Value = serde_json::from_str(&model_of(&problem)).unwrap();
    assert_eq!(model["data"]["skipped"], 2);
}

#[test]
fn what_a_fold_cannot_do_is_refused_by_name() {
    let robot = two_joints();
    let runs = campaign(&robot, &[("A", 3), ("D", 3)]);
    let refusal = |result: Result<Fold, Error>| match result {
        Err(error @ Error::Fold(_)) => error.written_for(FrontEnd::CommandLine),
        other => panic!("{other:?}"),
    };
    let setup_of = setup(&robot, |_, _| {});
    let fold = fold_of(&setup_of, &runs);
    // The same recording twice, another setup, damage.
    let twice = fold.clone().merge(fold.clone());
    assert!(matches!(twice, Err(Error::Fold(why)) if why.problem.contains("same place")));
    let until = setup(&robot, |_, settings| settings.until = Some(0.2));
    let other = fold.clone().merge(Fold::new(&until).unwrap());
    assert!(matches!(other, Err(Error::Fold(why)) if why.problem.contains("another setup")));
    assert!(refusal(Fold::from_bytes(&until, &fold.to_bytes())).contains("another setup"));
    let mut bytes = fold.to_bytes();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    assert!(refusal(Fold::from_bytes(&setup_of, &bytes)).contains("damaged"));
    for end in [0, 10, 16, 30, middle] {
        refusal(Fold::from_bytes(&setup_of, &bytes[..end]));
    }
    // Runs with inputs of their own beyond the limit, or of which some share theirs.
    let mut small = Fold::with_most_bytes(&setup_of, 5_000).unwrap();
    small.take_source(&runs, 0).unwrap();
    let mut mixed = fold.clone();
    let d = runs.runs().iter().position(|entry| entry.suite.as_deref() == Some("D")).unwrap();
    let copy = RunEntry { file: "copy".into(), ..runs.runs()[d].clone() };
    mixed.take(50, &copy, runs.read(d, &Default::default())).unwrap();
    for fold in [small, mixed] {
        let refused = Problem::of_fold(setup_of.clone(), fold, OnDefect::Refuse);
        let Err(Error::Fold(why)) = refused else { panic!("{refused:?}") };
        assert!(
            why.problem.starts_with("suite D: of its ") && why.problem.contains("on one machine"),
            "{why}"
        );
    }
    // Samples that a fold has not kept.
    let problem = Problem::of_fold(setup_of, fold, OnDefect::Refuse).unwrap();
    let last = runs.runs().iter().rposition(|entry| entry.suite.as_deref() == Some("A")).unwrap();
    assert!(matches!(problem.run(last), Err(Error::Fold(why)) if why.problem.contains("not kept")));
    assert!(problem.run(0).is_ok());
}
