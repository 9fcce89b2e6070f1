//! Recorded points in the reachable set itself and in its phase planes, against an independent
//! program and simulated motions.

use crate::common::{
    Disturbed, Random, Recorded, check_against, conform_all, grid, read, read_with, shared, step,
    two_joints, write_data_set,
};
use microlp::{ComparisonOp, OptimizationDirection, SolveOutcome, Variable};
use nalgebra::{DMatrix, DVector};
use reachtube_abstraction::{ExpansionPoint, linear_model};
use reachtube_conform::claim::Certificate;
use reachtube_conform::settings::{Centre, InitialLimit, States};
use reachtube_conform::{
    Code, Conformance, Error, Model, Notion, Problem, Settings, Tube, UncertaintySets, check, reach,
};
use reachtube_reach::{Disturbance, Hyperrectangle, LinearSystem};
use reachtube_robot::Robot;

fn settings(notion: Notion) -> Settings {
    Settings { notion, ..Settings::default() }
}

/// A folder with some suites of the virtual arm.
fn recorded(times: &[f64], runs: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let robot = two_joints();
    let arm = Disturbed { robot: &robot, times, start: 0.01, input: 0.5 };
    let suite = |seed| {
        let mut random = Random(seed);
        (0..runs).map(|_| arm.record(&mut random)).collect::<Vec<Recorded>>()
    };
    write_data_set(folder.path(), &[("a", suite(3)), ("b", suite(4))]);
    folder
}

fn found(folder: &std::path::Path, settings: &Settings) -> (Problem, Conformance) {
    let problem = read(&two_joints(), folder, &[], settings);
    let found = conform_all(&problem);
    (problem, found)
}

fn jittered() -> Vec<f64> {
    (0..30).map(|k| 0.01 * f64::from(k) + if k % 3 == 1 { 0.0021 } else { 0.0 }).collect()
}

#[test]
fn stronger_notions_cost_more_and_are_proved() {
    for times in [grid(0.01, 60), jittered()] {
        let folder = recorded(&times, 8);
        for disturbance in [Disturbance::Constant, Disturbance::Sample, Disturbance::Measurable] {
            for centre in [Centre::Free, Centre::Origin, Centre::Zero] {
                let costs = [Notion::Hull, Notion::PhasePlane, Notion::Exact].map(|notion| {
                    let settings = Settings { disturbance, centre, ..settings(notion) };
                    let (_, found) = found(folder.path(), &settings);
                    let verdict = &found.verdict;
                    assert!(verdict.conformant, "{disturbance:?} {centre:?} {notion:?}");
                    let points = 2 * 8 * (times.len() - 1);
                    let expected = match notion {
                        Notion::Hull => None,
                        Notion::PhasePlane => Some(2 * points),
                        Notion::Exact => Some(points),
                    };
                    assert_eq!(verdict.points.as_ref().map(|points| points.points), expected);
                    assert!(found.optimality_gap.unwrap() < 1e-4, "{:?}", found.optimality_gap);
                    found.cost
                });
                assert!(
                    costs[0] < costs[1] && costs[1] < costs[2],
                    "{disturbance:?} {centre:?} {costs:?}"
                );
            }
        }
    }
}

#[test]
fn sets_of_the_hull_are_refuted_by_a_combination_of_states() {
    let folder = recorded(&grid(0.01, 60), 8);
    let (problem, hull) = found(folder.path(), &settings(Notion::Hull));
    let mut model = Model::new(&problem, &hull);
    assert!(check_against(&model, folder.path(), &[]).verdict.conformant);
    model.settings.notion = Notion::Exact;
    let verdict = check_against(&model, folder.path(), &[]).verdict;
    let points = verdict.points.as_ref().unwrap();
    assert!(!verdict.conformant && verdict.violations.count == 0 && points.outside > 0);
    let unproved: usize = verdict.suites.iter().map(|suite| suite.points_unproved.unwrap()).sum();
    assert_eq!(unproved, points.unproved);
    // The witness holds by itself: with own exponentials, no motion in the sets reaches so far.
    let worst = points.worst.as_ref().unwrap();
    let system = linear_model(&two_joints(), &ExpansionPoint::zero(2)).unwrap();
    let (exponential, increments) = powers(&system, 0.01, worst.sample);
    let l = DVector::from_column_slice(&worst.direction);
    let along = |matrix: &DMatrix<f64>| (matrix.transpose() * &l).abs();
    let of = |gains: DVector<f64>, radii: &[f64]| gains.iter().zip(radii).map(|(g, r)| g * r).sum();
    let mut reach: f64 = of(along(&exponential), &model.initial_set.radius);
    for increment in &increments {
        reach += of(along(increment), &model.input_set.radius);
    }
    assert!((reach / worst.reach - 1.0).abs() < 1e-6, "{reach} {worst:?}");
    assert!(worst.value > worst.reach * (1.0 + 1e-6), "{worst:?}");
    assert!(worst.combination.contains("q"), "{worst:?}");
}

/// e^{A k h} and the columns that an input held over each of the k steps has at the end, by a
/// Taylor series of single steps.
fn powers(system: &LinearSystem, h: f64, k: usize) -> (DMatrix<f64>, Vec<DMatrix<f64>>) {
    let (n, m) = (system.states(), system.inputs());
    let unit = |size: usize, j: usize| DVector::from_fn(size, |i, _| f64::from(i == j));
    let zero = |size| DVector::zeros(size);
    let phi: Vec<_> = (0..n).map(|j| step(system, h, &unit(n, j), &zero(m))).collect();
    let gamma: Vec<_> = (0..m).map(|j| step(system, h, &zero(n), &unit(m, j))).collect();
    let (phi, mut next) = (DMatrix::from_columns(&phi), DMatrix::from_columns(&gamma));
    let mut exponential = DMatrix::identity(n, n);
    let mut increments = Vec::new();
    for _ in 0..k {
        exponential = &phi * exponential;
        increments.push(next.clone());
        next = &phi * next;
    }
    (exponential, increments)
}

/// The least cost of sets for which each point is a sum of the columns of e^{At} and of the
/// increments with factors up to the radii: one program with the factors of all points among its
/// unknowns, as the peers write it.
fn cost_with_factors(problem: &Problem, system: &LinearSystem, h: f64) -> f64 {
    let deviations = deviations(problem);
    let samples = deviations.iter().map(Vec::len).max().unwrap();
    let mut program = microlp::Problem::new(OptimizationDirection::Minimize);
    let free = (f64::NEG_INFINITY, f64::INFINITY);
    let centre: Vec<Variable> = (0..6).map(|_| program.add_var(0.0, free)).collect();
    let all: Vec<_> = (0..samples).map(|k| powers(system, h, k)).collect();
    let cost = |j: usize| -> f64 {
        let of = |(e, increments): &(DMatrix<f64>, Vec<DMatrix<f64>>)| match j {
            0..4 => e.column(j).abs().sum(),
            _ => increments.iter().map(|g| g.column(j - 4).abs().sum()).sum(),
        };
        2.0 * h * all.iter().map(of).sum::<f64>()
    };
    let radius: Vec<Variable> =
        (0..6).map(|j| program.add_var(cost(j), (0.0, f64::INFINITY))).collect();
    for run in &deviations {
        for (k, d) in run.iter().enumerate() {
            let (e, increments) = &all[k];
            let columns = (0..4)
                .map(|j| (j, e.column(j)))
                .chain(increments.iter().flat_map(|g| (0..2).map(|j| (4 + j, g.column(j)))));
            let mut rows = vec![Vec::new(); 4];
            for (owner, column) in columns {
                let factor = program.add_var(0.0, free);
                for sign in [1.0, -1.0] {
                    let bound = [(factor, sign), (radius[owner], -1.0)];
                    program.add_constraint(bound, ComparisonOp::Le, 0.0);
                }
                rows.iter_mut().zip(column.iter()).for_each(|(row, x)| row.push((factor, *x)));
            }
            let total = increments.iter().fold(DMatrix::zeros(4, 2), |sum, g| sum + g);
            for (i, mut row) in rows.into_iter().enumerate() {
                row.extend((0..4).map(|j| (centre[j], e[(i, j)])));
                row.extend((0..2).map(|j| (centre[4 + j], total[(i, j)])));
                program.add_constraint(row, ComparisonOp::Eq, d[i]);
            }
        }
    }
    match program.solve().unwrap() {
        SolveOutcome::Solution(solution) => solution.objective(),
        other => panic!("{other:?}"),
    }
}

/// The deviations of every run from its nominal motion, sample by sample.
fn deviations(problem: &Problem) -> Vec<Vec<DVector<f64>>> {
    let (initial_set, input_set) = (Hyperrectangle::zero(4), Hyperrectangle::zero(2));
    let none = UncertaintySets { initial_set, input_set, noise_set: None };
    let nominal = reach(problem, &Tube::new(problem, none).unwrap()).unwrap();
    let mut all = Vec::new();
    for (suite, reach) in problem.recordings().suites.iter().zip(&nominal) {
        for summary in &suite.runs {
            let run = problem.run(summary.index).unwrap();
            let at =
                |k: usize| DVector::from_fn(4, |i, _| run.state(k)[i] - reach.nominal[4 * k + i]);
            all.push((0..run.len()).map(at).collect());
        }
    }
    all
}

#[test]
fn the_cost_is_that_of_the_program_with_all_factors_as_unknowns() {
    let folder = recorded(&grid(0.01, 9), 3);
    let (problem, found) = found(folder.path(), &settings(Notion::Exact));
    let system = linear_model(&two_joints(), &ExpansionPoint::zero(2)).unwrap();
    let expected = cost_with_factors(&problem, &system, 0.01);
    let (cost, bound) = (found.cost, found.lower_bound.unwrap());
    assert!((bound / expected - 1.0).abs() < 3e-5, "{bound} {expected}");
    assert!((cost / expected - 1.0).abs() < 5e-5, "{cost} {expected}");
}

#[test]
fn motions_inside_the_sets_are_inside_and_a_smaller_set_loses_some() {
    let folder = recorded(&grid(0.01, 60), 8);
    let (problem, found) = found(folder.path(), &settings(Notion::Exact));
    let model = Model::new(&problem, &found);
    // New motions of the same arm, with starts and inputs at the corners of the sets.
    let system = linear_model(&two_joints(), &ExpansionPoint::zero(2)).unwrap();
    let mut random = Random(11);
    let start = &problem.recordings().suites[0].nominal_start;
    let other = tempfile::tempdir().unwrap();
    let corner = |random: &mut Random, set: &reachtube_reach::Hyperrectangle| {
        let entry = |i: usize| set.centre[i] + random.signed().signum() * set.radius[i];
        (0..set.dimension()).map(entry).collect::<Vec<f64>>()
    };
    let runs: Vec<Recorded> = (0..20)
        .map(|_| {
            let offset = DVector::from_vec(corner(&mut random, &model.initial_set));
            let mut x = DVector::from_column_slice(start) + offset * (1.0 - 1e-7);
            let (times, mut states, mut torques) = (grid(0.01, 60), Vec::new(), Vec::new());
            for &t in &times {
                let u = DVector::from_fn(2, |j, _| (3.0 * t + j as f64).sin());
                states.extend(x.iter());
                torques.extend(u.iter());
                let du = DVector::from_vec(corner(&mut random, &model.input_set));
                x = step(&system, 0.01, &x, &(u + du));
            }
            Recorded { times, states, torques }
        })
        .collect();
    write_data_set(other.path(), &[("a", runs)]);
    let (_, setup) = reachtube_arm::parse(&model.to_json(), "model".as_ref()).unwrap();
    let others = read_with(setup, other.path(), &[]);
    let tube = Tube::new(&others, model.sets()).unwrap();
    let verdict = check(&model, &others, &tube).unwrap().verdict;
    assert_eq!(verdict.points.as_ref().map(|points| points.outside), Some(0), "{verdict:?}");
    let mut smaller = model.clone();
    smaller.initial_set.radius.iter_mut().for_each(|r| *r *= 0.9);
    smaller.input_set.radius.iter_mut().for_each(|r| *r *= 0.9);
    let verdict = check_against(&smaller, folder.path(), &[]).verdict;
    assert!(!verdict.conformant && verdict.points.unwrap().outside > 0);
}

#[test]
fn positions_alone_and_noise_are_judged_too() {
    let folder = recorded(&grid(0.01, 40), 6);
    let cost = |adjust: &dyn Fn(&mut Settings)| {
        let mut settings = settings(Notion::Exact);
        adjust(&mut settings);
        let (_, found) = found(folder.path(), &settings);
        assert!(found.verdict.conformant, "{settings:?}");
        found.cost
    };
    let all = cost(&|_| {});
    let positions = cost(&|settings| settings.states = States::Positions);
    assert!(positions < all, "{positions} {all}");
    let noise = vec![1e-4, 1e-4, 1e-3, 1e-3];
    let fixed = |settings: &mut Settings| {
        settings.noise = reachtube_conform::Noise::Fixed(noise.clone());
    };
    cost(&fixed);
    cost(&|settings| settings.noise = reachtube_conform::Noise::Fitted);
}

/// Positions of runs that start within 1e-4 rad of each other and then spread by their inputs.
#[test]
fn an_initial_set_that_takes_over_is_warned_of_and_can_be_limited() {
    let folder = tempfile::tempdir().unwrap();
    let robot = two_joints();
    let times = grid(0.01, 60);
    let mut random = Random(5);
    let arm = Disturbed { robot: &robot, times: &times, start: 1e-4, input: 20.0 };
    let runs = (0..8).map(|_| arm.record(&mut random)).collect();
    write_data_set(folder.path(), &[("a", runs)]);
    let with = |initial_limit: InitialLimit, notion: Notion| {
        let states = States::Positions;
        let (problem, found) =
            found(folder.path(), &Settings { states, initial_limit, ..settings(notion) });
        assert!(found.verdict.conformant, "{initial_limit:?} {notion:?}");
        let starts = Code::InitialSetStarts;
        let warned = found.warnings.iter().any(|warning| warning.code == starts);
        let runs = &problem.recordings().suites[0].runs;
        let start = &problem.recordings().suites[0].nominal_start;
        let set = &found.sets.initial_set;
        let beyond = (0..4).map(|i| {
            let (low, high) = set.bounds(i);
            let furthest = runs.iter().map(|run| (run.start[i] - start[i]).abs());
            high.max(-low) / furthest.fold(0.0, f64::max)
        });
        (found.cost, warned, beyond.collect::<Vec<f64>>())
    };
    for notion in [Notion::Hull, Notion::Exact] {
        let (free, warned, beyond) = with(InitialLimit::None, notion);
        assert!(warned && beyond[..2].iter().any(|part| *part > 20.0), "{beyond:?}");
        let (positions, warned, beyond) = with(InitialLimit::Positions, notion);
        assert!(!warned && beyond[..2].iter().all(|part| *part < 1.01), "{beyond:?}");
        assert!(beyond[2..].iter().any(|part| *part > 20.0), "{beyond:?}");
        let (states, _, beyond) = with(InitialLimit::States, notion);
        assert!(beyond.iter().all(|part| *part < 1.01), "{beyond:?}");
        assert!(free < positions && positions < states, "{free} {positions} {states}");
    }
}

#[test]
fn a_model_of_the_hull_has_no_certificate_of_points() {
    let folder = recorded(&grid(0.01, 20), 3);
    let (problem, found) = found(folder.path(), &settings(Notion::Hull));
    let certificate = Certificate::new(&problem, &Model::new(&problem, &found));
    assert!(matches!(certificate, Err(Error::NotPoints)));
}

#[test]
fn a_certificate_has_a_line_for_every_point() {
    let folder = recorded(&grid(0.01, 20), 3);
    let (problem, found) = found(folder.path(), &settings(Notion::PhasePlane));
    let certificate = Certificate::new(&problem, &Model::new(&problem, &found)).unwrap();
    let mut text = Vec::new();
    certificate.write(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    assert_eq!(text.lines().count(), 2 * 3 * 19 * 2 + 1);
    let head: serde_json::Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    assert_eq!(head["notion"], "phase-plane");
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn all_points_of_the_papers_arm_are_proved() {
    let folder = shared("schunk_lwa4p");
    let costs = [(Notion::PhasePlane, 6139.03, 314_430), (Notion::Exact, 6895.38, 52_405)];
    for (notion, bound, points) in costs {
        let settings = Settings { notion, ..Settings::default() };
        let problem = read(&Robot::lwa4p(), &folder, &["A", "B", "D", "E"], &settings);
        let found = conform_all(&problem);
        let verdict = found.verdict.points.as_ref().unwrap();
        assert!(found.verdict.conformant && verdict.points == points, "{notion:?} {verdict:?}");
        assert!((found.lower_bound.unwrap() / (0.004 * bound) - 1.0).abs() < 5e-5, "{notion:?}");
        assert!(found.optimality_gap.unwrap() < 5e-5, "{notion:?} {:?}", found.optimality_gap);
    }
}
