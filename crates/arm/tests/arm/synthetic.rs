//! Recordings whose disturbances are known.

use std::path::Path;

use crate::common::{
    self, Disturbed, Random, Recorded, check_against, conform_all, grid, read, two_joints,
    write_data_set,
};
use microlp::{ComparisonOp, OptimizationDirection, SolveOutcome};
use nalgebra::DVector;
use reachtube_abstraction::{ExpansionPoint, linear_model};
use reachtube_conform::settings::{Centre, NominalStart, Weights};
use reachtube_conform::{Conformance, Model, Noise, Problem, Settings, reach};
use reachtube_reach::{Disturbance, IntervalMatrix, LinearSystem, Propagation, TimeGrid};
use reachtube_recordings::{DataSet, ReadOptions, RunSource};
use reachtube_robot::Robot;

fn suite(robot: &Robot, times: &[f64], runs: usize, seed: u64) -> Vec<Recorded> {
    let arm = Disturbed { robot, times, start: 0.01, input: 0.5 };
    let mut random = Random(seed);
    (0..runs).map(|_| arm.record(&mut random)).collect()
}

fn run(robot: &Robot, folder: &Path, settings: &Settings) -> (Problem, Conformance) {
    let problem = read(robot, folder, &[], settings);
    let found = conform_all(&problem);
    (problem, found)
}

#[test]
fn sets_cost_no_more_than_the_disturbances_that_were_there() {
    let folder = tempfile::tempdir().unwrap();
    let robot = two_joints();
    write_data_set(
        folder.path(),
        &[
            ("a", suite(&robot, &grid(0.01, 80), 12, 3)),
            ("b", suite(&robot, &grid(0.01, 50), 9, 4)),
        ],
    );
    let (_, found) = run(&robot, folder.path(), &Settings::default());
    assert!(found.verdict.conformant);
    // The nominal motion starts at the mean of the runs, so what was there lies in sets of twice
    // the radius of the starts.
    let truth = |start: f64, input: f64| {
        let propagation = Propagation::new(
            &linear_model(&robot, &ExpansionPoint::zero(2)).unwrap(),
            &TimeGrid::uniform(0.01, 80),
        )
        .unwrap();
        let gains = Disturbance::Sample.input_gains(&propagation);
        let at = |k: usize| {
            let e: f64 = propagation.exponential(k).iter().map(|x| 2.0 * start * x.mag()).sum();
            e + gains[k].iter().map(|x| 2.0 * input * x.mag()).sum::<f64>()
        };
        0.01 * (0..80).map(at).sum::<f64>()
    };
    assert!(found.cost <= truth(0.02, 0.5), "{} > {}", found.cost, truth(0.02, 0.5));
    assert!(found.cost > 0.2 * truth(0.01, 0.5));
}

#[test]
fn one_sample_is_its_own_hull() {
    let folder = tempfile::tempdir().unwrap();
    let starts = [[0.1, 0.0, -0.2, 0.3], [0.3, 0.1, 0.0, 0.3], [-0.1, 0.2, 0.2, 0.3]];
    let runs =
        starts.map(|x| Recorded { times: vec![0.0], states: x.to_vec(), torques: vec![0.0; 2] });
    write_data_set(folder.path(), &[("a", runs.to_vec())]);
    let (_, found) = run(&two_joints(), folder.path(), &Settings::default());
    assert!(found.verdict.conformant);
    // A sample without a neighbour stands for 1 s.
    assert!((found.cost - (0.4 + 0.2 + 0.4)).abs() < 1e-9, "{}", found.cost);
    for (radius, exact) in found.sets.initial_set.radius.iter().zip([0.2, 0.1, 0.2, 0.0]) {
        assert!((radius - exact).abs() < 1e-9);
    }
}

#[test]
fn recordings_of_the_model_itself_need_sets_of_rounding_only() {
    let folder = tempfile::tempdir().unwrap();
    let robot = two_joints();
    let times = grid(0.01, 60);
    let exact = Disturbed { robot: &robot, times: &times, start: 0.0, input: 0.0 };
    write_data_set(folder.path(), &[("a", vec![exact.record(&mut Random(1))])]);
    let (_, found) = run(&robot, folder.path(), &Settings::default());
    assert!(found.verdict.conformant && found.cost < 1e-10, "{}", found.cost);
}

/// A data set of four runs at other times: every how many samples, and how far each run's times are
/// off, s.
fn resampled(every: usize, off: f64) -> Conformance {
    let folder = tempfile::tempdir().unwrap();
    let (robot, times, mut random) = (two_joints(), grid(0.005, 161), Random(7));
    let arm = Disturbed { robot: &robot, times: &times, start: 0.02, input: 0.5 };
    let at = |run: usize| {
        let Recorded { times, states, .. } = arm.record(&mut random);
        let jitter = |k: usize| off * ((7 * k + 3 * run) % 5) as f64;
        let kept = || (0..times.len()).step_by(every);
        Recorded {
            times: kept().map(|k| times[k] + if k > 0 { jitter(k) } else { 0.0 }).collect(),
            states: kept().flat_map(|k| states[4 * k..4 * k + 4].to_vec()).collect(),
            torques: vec![0.0; 2 * kept().count()],
        }
    };
    let runs: Vec<Recorded> = (0..4).map(at).collect();
    write_data_set(folder.path(), &[("a", runs)]);
    let settings = Settings { disturbance: Disturbance::Constant, ..Settings::default() };
    run(&robot, folder.path(), &settings).1
}

#[test]
fn the_cost_depends_neither_on_the_sample_rate_nor_on_jitter_of_the_stamps() {
    let (usual, half, jittered) = (resampled(1, 0.0), resampled(2, 0.0), resampled(1, 1e-9));
    assert!((half.cost / usual.cost - 1.0).abs() < 0.03, "{} for {}", half.cost, usual.cost);
    assert!(half.cost_of_samples < 0.6 * usual.cost_of_samples);
    let change = jittered.cost / usual.cost - 1.0;
    assert!(change.abs() < 1e-3, "{} for {}", jittered.cost, usual.cost);
    // The paper's sum counts the runs' times one by one.
    assert!(jittered.cost_of_samples > 1.5 * usual.cost_of_samples);
    assert!((usual.cost_of_samples * 0.005 / usual.cost - 1.0).abs() < 1e-12);
}

/// Every row handed at once to a simplex solver that shares nothing with the program.
#[test]
fn row_generation_finds_the_optimum_of_the_whole_program() {
    let folder = tempfile::tempdir().unwrap();
    let robot = two_joints();
    write_data_set(
        folder.path(),
        &[
            ("a", suite(&robot, &grid(0.02, 40), 6, 11)),
            ("b", suite(&robot, &grid(0.02, 25), 5, 12)),
        ],
    );
    for disturbance in [Disturbance::Constant, Disturbance::Sample, Disturbance::Measurable] {
        for centre in [Centre::Free, Centre::Origin, Centre::Zero] {
            for noise in [Noise::None, Noise::Fitted, Noise::Fixed(vec![0.002, 0.002, 0.01, 0.01])]
            {
                let mut settings = Settings::default();
                (settings.disturbance, settings.centre, settings.noise) =
                    (disturbance, centre, noise);
                settings.weights = Weights::Given(vec![1.0, 2.0, 0.5, 0.25]);
                settings.sensor_noise = Some(vec![0.004, 0.001, 0.02, 1.0]);
                let (_, found) = run(&robot, folder.path(), &settings);
                let data = DataSet::open(folder.path()).unwrap();
                let simplex = whole_program(&robot, &data, &settings);
                let case = format!("{disturbance:?} {centre:?} {:?}", settings.noise);
                assert!(found.verdict.conformant, "{case}");
                for cost in [found.cost / 0.02, found.cost_of_samples] {
                    assert!((cost / simplex - 1.0).abs() < 1e-7, "{case}: {cost} for {simplex}");
                }
            }
        }
    }
}

/// The entries of E_k and R_k of two joints, 4 x 6 each, at 40 samples of 0.02 s.
struct Coefficients {
    propagation: Propagation,
    input_gains: Vec<IntervalMatrix>,
}

impl Coefficients {
    fn new(system: &LinearSystem, settings: &Settings) -> Self {
        let propagation = Propagation::new(system, &TimeGrid::uniform(0.02, 40)).unwrap();
        let input_gains = settings.disturbance.input_gains(&propagation);
        Self { propagation, input_gains }
    }

    fn centre(&self, k: usize, i: usize, j: usize) -> f64 {
        let Self { propagation, .. } = self;
        if j < 4 {
            propagation.exponential(k)[(i, j)].mid()
        } else {
            propagation.integral(k)[(i, j - 4)].mid()
        }
    }

    fn radius(&self, k: usize, i: usize, j: usize) -> f64 {
        if j < 4 { self.centre(k, i, j).abs() } else { self.input_gains[k][(i, j - 4)].mid() }
    }

    fn cost(&self, weights: &[f64], j: usize) -> f64 {
        let all = (0..40).flat_map(|k| (0..4).map(move |i| (k, i)));
        all.map(|(k, i)| 2.0 * weights[i] * self.radius(k, i, j)).sum()
    }
}

/// For each suite and sample, the largest deviation of a run upward and downward, 4 each.
fn deviations(system: &LinearSystem, data: &DataSet) -> Vec<(usize, [[f64; 4]; 2])> {
    let mut all = Vec::new();
    for suite in data.suites() {
        let read = |run: &usize| data.read(*run, &ReadOptions::default()).unwrap();
        let runs: Vec<_> = suite.runs.iter().map(read).collect();
        let starts = runs.iter().map(|run| DVector::from_column_slice(run.state(0)));
        let mut x = starts.sum::<DVector<f64>>() / runs.len() as f64;
        for k in 0..runs[0].len() {
            let furthest = |sign: f64, i: usize| {
                let deviations = runs.iter().map(|run| sign * (run.state(k)[i] - x[i]));
                deviations.fold(f64::NEG_INFINITY, f64::max)
            };
            let sides = [1.0, -1.0].map(|sign| [0, 1, 2, 3].map(|i| furthest(sign, i)));
            all.push((k, sides));
            x = common::step(system, 0.02, &x, &DVector::from_column_slice(runs[0].torque(k)));
        }
    }
    all
}

/// The optimal cost of the program as docs/method.md states it, by microlp.
fn whole_program(robot: &Robot, data: &DataSet, settings: &Settings) -> f64 {
    let system = linear_model(robot, &ExpansionPoint::zero(2)).unwrap();
    let coefficients = Coefficients::new(&system, settings);
    let Weights::Given(weights) = &settings.weights else { unreachable!() };
    let mut problem = microlp::Problem::new(OptimizationDirection::Minimize);
    let limit = if settings.centre == Centre::Zero { 0.0 } else { f64::INFINITY };
    let centres: Vec<_> = (0..6).map(|_| problem.add_var(0.0, (-limit, limit))).collect();
    let radii: Vec<_> = (0..6)
        .map(|j| problem.add_var(coefficients.cost(weights, j), (0.0, f64::INFINITY)))
        .collect();
    let noise = |i: usize| match &settings.noise {
        Noise::None => (0.0, 0.0),
        Noise::Fitted => (0.0, settings.sensor_noise.as_ref().unwrap()[i]),
        Noise::Fixed(radii) => (radii[i], radii[i]),
    };
    let noise: Vec<_> =
        (0..4).map(|i| problem.add_var(2.0 * 40.0 * weights[i], noise(i))).collect();
    for (k, sides) in deviations(&system, data) {
        for (sign, bounds) in [1.0, -1.0].into_iter().zip(sides) {
            for (i, bound) in bounds.into_iter().enumerate() {
                let mut row = vec![(noise[i], 1.0)];
                row.extend((0..6).map(|j| (centres[j], sign * coefficients.centre(k, i, j))));
                row.extend((0..6).map(|j| (radii[j], coefficients.radius(k, i, j))));
                problem.add_constraint(row, ComparisonOp::Ge, bound);
            }
        }
    }
    if settings.centre == Centre::Origin {
        for (centre, radius) in centres.iter().zip(&radii) {
            problem.add_constraint([(*centre, 1.0), (*radius, -1.0)], ComparisonOp::Le, 0.0);
            problem.add_constraint([(*centre, -1.0), (*radius, -1.0)], ComparisonOp::Le, 0.0);
        }
    }
    match problem.solve().unwrap() {
        SolveOutcome::Solution(solution) => solution.objective(),
        SolveOutcome::Interrupted(_) => panic!("no limit was set"),
    }
}

#[test]
fn runs_with_their_own_input_or_times_have_their_own_nominal_solution() {
    let robot = two_joints();
    let mut settings = Settings::default();
    let same = tempfile::tempdir().unwrap();
    write_data_set(same.path(), &[("a", suite(&robot, &grid(0.01, 50), 5, 8))]);
    let (shared_problem, shared) = run(&robot, same.path(), &settings);
    // The input of one run is changed in one sample by an amount that nothing can see: only the way
    // of computing differs.
    let mut runs = suite(&robot, &grid(0.01, 50), 5, 8);
    runs[3].torques[20] += 1e-13;
    let other = tempfile::tempdir().unwrap();
    write_data_set(other.path(), &[("a", runs)]);
    let (own_problem, own) = run(&robot, other.path(), &settings);
    assert!(
        shared_problem.recordings().suites[0].shared.is_some()
            && own_problem.recordings().suites[0].shared.is_none()
    );
    assert!((own.cost / shared.cost - 1.0).abs() < 1e-9 && own.verdict.conformant);
    assert!(own_problem.recordings().notes.iter().any(|note| note.contains("own nominal")));
    // Started at its own first state, a run has no deviation there. Sensors this bad do not limit
    // X0.
    settings.nominal = NominalStart::Own;
    settings.sensor_noise = Some(vec![0.1; 4]);
    let (_, started) = run(&robot, same.path(), &settings);
    assert!(started.verdict.conformant && started.cost < shared.cost);
}

#[test]
fn suites_of_different_rates_share_a_model() {
    let robot = two_joints();
    let folder = tempfile::tempdir().unwrap();
    let jittered: Vec<f64> =
        (0..70).map(|k| 0.01 * k as f64 + if k % 3 == 1 { 0.002 } else { 0.0 }).collect();
    let suites = [
        ("a", suite(&robot, &grid(0.01, 80), 4, 21)),
        ("b", suite(&robot, &grid(0.004, 150), 4, 22)),
        ("c", suite(&robot, &jittered, 4, 23)),
    ];
    write_data_set(folder.path(), &suites);
    for disturbance in [Disturbance::Constant, Disturbance::Sample, Disturbance::Measurable] {
        let settings = Settings { disturbance, ..Settings::default() };
        let (problem, found) = run(&robot, folder.path(), &settings);
        assert!(found.verdict.conformant);
        let samples: Vec<usize> =
            reach(&problem, &found.tube).unwrap().iter().map(|suite| suite.times.len()).collect();
        assert_eq!(samples, [80, 150, 70]);
        let model = Model::new(&problem, &found);
        assert!(check_against(&model, folder.path(), &[]).verdict.conformant);
    }
}

#[test]
fn a_point_pushed_out_of_the_set_is_the_witness() {
    let robot = two_joints();
    let folder = tempfile::tempdir().unwrap();
    let mut runs = suite(&robot, &grid(0.01, 60), 6, 31);
    write_data_set(folder.path(), &[("a", runs.clone())]);
    let settings = Settings::default();
    let (problem, found) = run(&robot, folder.path(), &settings);
    let model = Model::new(&problem, &found);
    let (k, i) = (37, 1);
    runs[2].states[k * 4 + i] -= 0.5;
    write_data_set(folder.path(), &[("a", runs)]);
    let checked = check_against(&model, folder.path(), &[]).verdict;
    let worst = checked.violations.worst.unwrap();
    assert!(!checked.conformant && checked.violations.count == 1);
    assert_eq!(
        (worst.run.as_str(), worst.sample, worst.part, worst.state.to_string().as_str()),
        ("a_02.csv", k, 2, "q2")
    );
    assert!(worst.excess > 0.0 && worst.excess <= 0.5);
}

#[test]
fn a_model_survives_its_file() {
    let robot = two_joints();
    let folder = tempfile::tempdir().unwrap();
    write_data_set(folder.path(), &[("a", suite(&robot, &grid(0.01, 40), 4, 41))]);
    let settings = Settings::default();
    let (problem, found) = run(&robot, folder.path(), &settings);
    let model = Model::new(&problem, &found);
    let path = folder.path().join("model.json");
    std::fs::write(&path, model.to_json()).unwrap();
    let loaded = reachtube_arm::open(&path).unwrap().0;
    assert_eq!(loaded, model);
    assert!(check_against(&loaded, folder.path(), &[]).verdict.conformant);
}
