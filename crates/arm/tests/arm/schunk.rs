//! The recordings of the paper's own arm: cost against an independent solver, proof, and a check
//! that fails where it must.

use std::path::Path;

use crate::common::{self, check_against, conform_all, read};
use nalgebra::{DMatrix, DVector};
use reachtube_conform::next_motion::Trend;
use reachtube_conform::settings::{Centre, States};
use reachtube_conform::{Conformance, Model, Problem, Settings};
use reachtube_reach::{Disturbance, System};
use reachtube_recordings::{DataSet, ReadOptions, Run, RunSource};
use reachtube_robot::Robot;

fn conform_with(
    folder: &Path,
    suites: &[&str],
    adjust: impl Fn(&mut Settings),
) -> (Problem, Conformance) {
    let mut settings = Settings::default();
    adjust(&mut settings);
    let problem = read(&Robot::lwa4p(), folder, suites, &settings);
    let found = conform_all(&problem);
    (problem, found)
}

/// Optimal costs found by HiGHS 1.11 (dual simplex, through SciPy) on the whole program, all 52,224
/// or 26,112 rows, with e^{At} by SciPy's Padé approximation and κ of `measurable` by 50
/// subdivisions of each sample (hence 1e-6 there): suites A, B, D, E, unit weights, mean first
/// state, 12 states in the cost. They are the paper's sums, in which each sample counts 1; samples
/// are 0.004 s apart.
const OPTIMA: [(States, Disturbance, [f64; 3]); 6] = [
    (States::All, Disturbance::Constant, [6818.561053712907, 6818.561053712875, 8372.7249271995]),
    (States::All, Disturbance::Sample, [6048.047985391407, 6048.047985391244, 7296.460846264912]),
    (
        States::All,
        Disturbance::Measurable,
        [6048.041327597189, 6048.041327597189, 7296.45810698982],
    ),
    (
        States::Positions,
        Disturbance::Constant,
        [4077.952629703163, 4119.457416560856, 5227.013665532468],
    ),
    (
        States::Positions,
        Disturbance::Sample,
        [4190.645059667318, 4235.435876073377, 5401.906499505786],
    ),
    (
        States::Positions,
        Disturbance::Measurable,
        [4190.646094536758, 4235.437004112476, 5401.9082782636115],
    ),
];

#[test]
#[ignore = "needs the recordings in ../shared"]
fn costs_are_those_of_an_independent_solver_and_the_sets_are_proved() {
    let folder = common::shared("schunk_lwa4p");
    for (states, disturbance, costs) in OPTIMA {
        for (centre, optimum) in [Centre::Free, Centre::Origin, Centre::Zero].into_iter().zip(costs)
        {
            let (_, found) = conform_with(&folder, &["A", "B", "D", "E"], |settings| {
                (settings.states, settings.disturbance, settings.centre) =
                    (states, disturbance, centre);
            });
            let lower_bound = found.lower_bound.unwrap();
            let case = format!("{states:?} {disturbance:?} {centre:?}");
            for cost in [found.cost / 0.004, found.cost_of_samples] {
                assert!((cost / optimum - 1.0).abs() < 1e-8, "{case}: {cost} for {optimum}");
            }
            assert!(
                (found.cost - lower_bound) / found.cost < 1e-9,
                "{case}: bound {}",
                lower_bound
            );
            assert!(found.verdict.conformant && found.verdict.largest_excess <= 0.0, "{case}");
            let suites_by_samples = 937 + 703 + 234 + 1088;
            let rows = if states == States::All { 12 } else { 6 };
            assert_eq!(found.verdict.rows, suites_by_samples * rows, "{case}");
            let sets = found.sets.initial_set.centre.iter().zip(&found.sets.initial_set.radius);
            match centre {
                Centre::Free => {}
                Centre::Origin => assert!(sets.clone().all(|(c, r)| c.abs() <= *r), "{case}"),
                Centre::Zero => assert!(sets.clone().all(|(c, _)| *c == 0.0), "{case}"),
            }
        }
    }
}

/// Gauges by an independent linear program: 1.6, 2.2, 2.0 and 3.0.
#[test]
#[ignore = "needs the recordings in ../shared"]
fn gauges_are_those_of_an_independent_program_and_warming_up_is_named() {
    let folder = common::shared("schunk_lwa4p");
    let (_, found) = conform_with(&folder, &["A", "B", "D", "E"], |_| {});
    let gauges: Vec<f64> = found.left_out.iter().map(|left| left.gauge.unwrap()).collect();
    assert_eq!(gauges.len(), 4);
    for (gauge, expected) in gauges.iter().zip([1.6, 2.2, 2.0, 3.0]) {
        assert!((gauge - expected).abs() < 0.05, "{gauges:?}");
    }
    for (suite, joint) in [("A", 3), ("B", 3), ("E", 3)] {
        let trend = |trend: &&Trend| trend.suite == suite && trend.part == joint;
        assert!(found.trends.iter().find(trend).unwrap().correlation.abs() > 0.9);
    }
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn a_motion_that_was_not_fitted_is_not_claimed_and_a_fitted_one_is() {
    let folder = common::shared("schunk_lwa4p");
    let (problem, found) = conform_with(&folder, &["A", "B", "D"], |_| {});
    let model = Model::new(&problem, &found);
    let fitted = check_against(&model, &folder, &["B", "A"]);
    let verdict = &fitted.verdict;
    assert!(verdict.conformant && verdict.violations.count == 0 && fitted.trust.is_none());
    let checked = check_against(&model, &folder, &["E"]);
    let other = &checked.verdict;
    let worst = other.violations.worst.clone().unwrap();
    assert!(
        !other.conformant
            && other.violations.count > 1000
            && worst.suite == "E"
            && worst.excess > 0.1
    );
    assert_eq!(checked.trust.unwrap().motions, 1);
}

/// The count of `check` by plain floating point: x̂ by the exact discretisation, the reach by
/// running sums.
#[test]
#[ignore = "needs the recordings in ../shared"]
fn violations_are_counted_as_a_plain_simulation_counts_them() {
    let folder = common::shared("schunk_lwa4p");
    let (problem, found) = conform_with(&folder, &["A", "B"], |_| {});
    let model = Model::new(&problem, &found);
    let checked = check_against(&model, &folder, &["D", "E"]).verdict;
    let data = DataSet::open(&folder).unwrap();
    let options = ReadOptions::of(6);
    let mut count = 0;
    let mut worst: f64 = 0.0;
    for suite in data.select(&["D", "E"].map(String::from)).unwrap() {
        let runs: Vec<_> =
            suite.runs.iter().map(|&run| data.read(run, &options).unwrap()).collect();
        for (_, _, excess) in plain_excess(problem.dynamics(), &model, &runs) {
            count += usize::from(excess > 0.0);
            worst = worst.max(excess);
        }
    }
    assert_eq!(checked.violations.count, count);
    assert!((checked.violations.worst.unwrap().excess - worst).abs() < 1e-9);
}

/// (sample, state, excess) by plain floating point.
fn plain_excess(dynamics: &System, model: &Model, runs: &[Run]) -> Vec<(usize, usize, f64)> {
    let system = dynamics.linear_system().expect("model 1 of order 1 is linear");
    let sets = model.sets();
    let vector = |values: &[f64]| -> DVector<f64> { DVector::from_column_slice(values) };
    let zero = DVector::zeros(6);
    let columns = |f: &dyn Fn(usize) -> DVector<f64>, n: usize| {
        DMatrix::from_columns(&(0..n).map(f).collect::<Vec<_>>())
    };
    let unit = |n: usize, j: usize| DVector::from_fn(n, |i, _| f64::from(u8::from(i == j)));
    let phi = columns(&|j| common::step(system, 0.004, &unit(12, j), &zero), 12);
    let gamma = columns(&|j| common::step(system, 0.004, &DVector::zeros(12), &unit(6, j)), 6);
    let mean =
        runs.iter().map(|run| vector(run.state(0))).sum::<DVector<f64>>() / runs.len() as f64;
    let (mut e, mut g, mut gain) =
        (DMatrix::identity(12, 12), DMatrix::zeros(12, 6), DMatrix::zeros(12, 6));
    let (mut x, mut rows) = (mean, Vec::new());
    for k in 0..runs[0].len() {
        let centre: DVector<f64> =
            &x + &e * vector(&sets.initial_set.centre) + &g * vector(&sets.input_set.centre);
        let radius: DVector<f64> =
            e.abs() * vector(&sets.initial_set.radius) + &gain * vector(&sets.input_set.radius);
        for i in 0..12 {
            let apart = runs.iter().map(|run| (run.state(k)[i] - centre[i]).abs());
            let furthest = apart.max_by(f64::total_cmp).unwrap();
            rows.push((k, i, furthest - radius[i]));
        }
        x = &phi * x + &gamma * vector(runs[0].torque(k));
        let increment: DMatrix<f64> = &e * &gamma;
        gain += increment.abs();
        g += increment;
        e *= &phi;
    }
    rows
}
