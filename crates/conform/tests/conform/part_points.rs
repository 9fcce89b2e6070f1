//! The notions that need every recorded point, over folds: the points stay in parts, which are
//! asked in rounds, and the answer equals one machine's to the last bit.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::{Disturbed, Random, fold_of, grid, two_joints};
use reachtube_abstraction::{Abstraction, ModelKind};
use reachtube_conform::fleet::{
    FleetProblem, Fold, OnDefect, PartPoints, PartReader, PointServer, check_elsewhere,
    conform_elsewhere,
};
use reachtube_conform::{
    Conformance, Error, FitSettings, Group, Keep, Model, Noise, Notion, Problem, Settings, Setup,
    Silent, Tube, check, conform, fit,
};
use reachtube_recordings::{Defect, MemoryRuns, Run, RunSource, Torque};

/// Suites whose recordings share their input, but for the runs of D; B has recordings of different
/// lengths.
fn campaign(suites: &[(&str, usize)]) -> MemoryRuns {
    let robot = two_joints();
    let (mut runs, mut random) = (MemoryRuns::default(), Random(5));
    for (suite, count) in suites {
        for index in 0..*count {
            let times = grid(0.01, if *suite == "B" { 20 + index % 3 } else { 24 });
            let arm = Disturbed { robot: &robot, times: &times, start: 0.01, input: 0.5 };
            let mut run = arm.record(&mut random);
            if *suite == "D" {
                run.torques[1] += 0.001 * index as f64;
            }
            let run = Run::new(2, run.times, run.states, run.torques).unwrap();
            runs.push(&format!("{suite}{index:03}"), Some(suite), None, run);
        }
    }
    runs
}

fn setup(notion: Notion, noise: Noise) -> Setup {
    let settings = Settings { notion, noise, ..Settings::new(Torque::Compensated, 2) };
    Setup::new(two_joints(), settings).unwrap()
}

/// Parts that are asked in turn, and whose answers merge in another order each time.
#[derive(Debug)]
struct Parts {
    fleet: FleetProblem,
    /// One part may be lost and read again.
    parts: Mutex<Vec<PartPoints>>,
    asked: AtomicUsize,
}

impl PointServer for Parts {
    fn ask(&self, question: &[u8]) -> Result<Vec<u8>, String> {
        let round = self.asked.fetch_add(1, Ordering::Relaxed);
        let mut parts = self.parts.lock().unwrap();
        // What a part remembers of earlier rounds makes no difference.
        let lost = round % parts.len();
        parts[lost] = PartPoints::from_bytes(&parts[lost].to_bytes()).map_err(|e| e.to_string())?;
        let answer = |part: &PartPoints| part.answer(&self.fleet, question).unwrap();
        let mut answers: Vec<Vec<u8>> = parts.iter().map(answer).collect();
        answers.rotate_left(lost);
        let middle = answers.len() / 2;
        let halves = [&answers[middle..], &answers[..middle]];
        let halves = halves.into_iter().filter(|half| !half.is_empty());
        let merged: Vec<Vec<u8>> =
            halves.map(|half| PartPoints::merge(half.iter().map(Vec::as_slice)).unwrap()).collect();
        PartPoints::merge(merged.iter().map(Vec::as_slice)).map_err(|error| error.to_string())
    }
}

/// Reads recording `index`; that at the place `broken` has a defect.
fn read(
    runs: &MemoryRuns,
    index: usize,
    fold: &Fold,
    broken: Option<usize>,
) -> Result<Run, Vec<Defect>> {
    if broken == Some(index) {
        return Err(vec![Defect::new(
            &runs.runs()[index].file,
            None,
            "cut off",
            "record it again",
        )]);
    }
    runs.read(index, &fold.read_options())
}

/// Folds recordings in parts: recording i is in part `part(i)`.
fn in_parts(
    setup: &Setup,
    runs: &MemoryRuns,
    count: usize,
    part: impl Fn(usize) -> usize,
    broken: Option<usize>,
) -> (Problem, Parts) {
    let all = 0..runs.runs().len();
    let mut whole = Fold::new(setup).unwrap();
    for index in all.clone() {
        let read = read(runs, index, &whole, broken);
        whole.take(index as u64, &runs.runs()[index], read).unwrap();
    }
    let fleet = FleetProblem::new(setup.clone(), whole.clone()).unwrap();
    let points = |own: usize| {
        let mut reader = PartReader::new(&fleet).unwrap();
        for index in all.clone().rev().filter(|index| part(*index) == own) {
            let read = read(runs, index, &whole, broken);
            reader.take(index as u64, &runs.runs()[index], read).unwrap();
        }
        reader.finish()
    };
    let parts = Mutex::new((0..count).map(points).collect());
    let problem = Problem::of_fold(setup.clone(), whole.clone(), OnDefect::Report).unwrap();
    (problem, Parts { fleet, parts, asked: AtomicUsize::new(0) })
}

fn found(problem: &Problem, server: Option<&Parts>) -> (Conformance, String) {
    let found = match server {
        Some(server) => conform_elsewhere(problem, server, &Silent),
        None => conform(problem, &Silent, None),
    };
    let found = found.unwrap();
    let model = Model::new(problem, &found).to_json();
    (found, model)
}

#[test]
fn points_in_any_parts_give_the_model_file_of_one_machine() {
    let runs = campaign(&[("A", 9), ("B", 7), ("D", 3)]);
    for (notion, noise) in [
        (Notion::Exact, Noise::None),
        (Notion::Exact, Noise::Fitted),
        (Notion::PhasePlane, Noise::None),
    ] {
        let setup = setup(notion, noise);
        let source = Box::new(runs.clone());
        let once = Problem::read(setup.clone(), source, &[], Keep::Needed, &Silent).unwrap();
        let (alone, file) = found(&once, None);
        let points = alone.verdict.points.as_ref().unwrap();
        assert!(alone.verdict.conformant && points.unproved == 0 && points.points > 400);
        assert!(!alone.tight.is_empty() && alone.cost > 0.0);
        for (count, stride) in [(1, 1), (2, 1), (5, 3), (19, 1)] {
            let (problem, server) =
                in_parts(&setup, &runs, count, |index| index * stride % count, None);
            assert_eq!(found(&problem, Some(&server)).1, file, "{notion:?}, {count} parts");
        }
    }
}

#[test]
fn recordings_with_defects_are_left_out_of_the_points_too() {
    let setup = setup(Notion::Exact, Noise::None);
    let runs = campaign(&[("A", 8)]);
    let (problem, server) = in_parts(&setup, &runs, 3, |index| index % 3, Some(4));
    let (found, _) = found(&problem, Some(&server));
    assert!(found.verdict.conformant);
    assert_eq!(found.verdict.points.unwrap().points, 7 * 23);
}

#[test]
fn a_check_names_the_same_points() {
    let fitted = campaign(&[("A", 4)]);
    let others = campaign(&[("A", 12), ("B", 5)]);
    let setup = setup(Notion::Exact, Noise::None);
    let source = Box::new(fitted);
    let problem = Problem::read(setup.clone(), source, &[], Keep::Needed, &Silent).unwrap();
    let model: Model = Model::new(&problem, &conform(&problem, &Silent, None).unwrap());
    let answer = |problem: &Problem, server: Option<&Parts>| {
        let tube = Tube::new(problem, model.sets()).unwrap();
        let answer = match server {
            Some(server) => check_elsewhere(&model, problem, &tube, server),
            None => check(&model, problem, &tube),
        };
        answer.unwrap().verdict
    };
    let source = Box::new(others.clone());
    let once = Problem::read(setup.clone(), source, &[], Keep::Needed, &Silent).unwrap();
    let expected = answer(&once, None);
    let points = expected.points.as_ref().unwrap();
    assert!(points.outside > 0 && points.worst.is_some());
    for count in [1, 4] {
        let (problem, server) = in_parts(&setup, &others, count, |index| index % count, None);
        assert_eq!(answer(&problem, Some(&server)), expected);
    }
}

#[test]
fn points_of_other_recordings_are_refused() {
    let setup = setup(Notion::Exact, Noise::None);
    let runs = campaign(&[("A", 6)]);
    // One recording is in no part.
    let part = |index| if index == 5 { 9 } else { index % 2 };
    let (problem, server) = in_parts(&setup, &runs, 2, part, None);
    let refused = conform_elsewhere(&problem, &server, &Silent).unwrap_err();
    assert!(
        matches!(&refused, Error::Fold(why) if why.problem.contains("are missing")),
        "{refused}"
    );
    // No part has the points.
    let fold = fold_of(&setup, &runs);
    let problem = Problem::of_fold(setup.clone(), fold, OnDefect::Refuse).unwrap();
    assert!(matches!(conform(&problem, &Silent, None), Err(Error::Fold(_))));
    for bytes in [&b""[..], b"nonsense"] {
        assert!(PartPoints::from_bytes(bytes).is_err() && PartPoints::merge([bytes]).is_err());
    }
}

#[test]
fn a_fit_is_refused_because_points_are_deviations_from_the_motions_before_it() {
    let runs = campaign(&[("A", 4), ("B", 4)]);
    let setup = setup(Notion::Exact, Noise::None);
    let (problem, _) = in_parts(&setup, &runs, 2, |index| index % 2, None);
    let settings = FitSettings { groups: vec![Group::Viscous], pull: Some(0.02) };
    let refused = fit(&problem, &settings, &Silent).unwrap_err().to_string();
    assert!(refused.contains("fit for the notion hull"), "{refused}");
}

#[test]
fn notions_that_need_whole_recordings_are_refused_by_name() {
    let refused = |setup: &Setup| match Fold::new(setup) {
        Err(Error::Fold(why)) => assert!(why.problem.contains("use the notion hull"), "{why}"),
        other => panic!("{other:?}"),
    };
    let abstraction = Abstraction { model: ModelKind::Two, order: 3 };
    let exact =
        Settings { notion: Notion::Exact, abstraction, ..Settings::new(Torque::Compensated, 2) };
    let exact = Setup::new(two_joints(), exact).unwrap();
    assert!(exact.dynamics().linear_system().is_none());
    refused(&exact);
}
