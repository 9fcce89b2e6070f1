//! Many steps: e^{A t_k}, Γ(t_k) and solutions.

use nalgebra::dmatrix;
use proptest::prelude::*;
use reachtube_reach::{IntervalMatrix, IntervalVector, LinearSystem, Propagation, TimeGrid};
use reachtube_scalar::Interval;

use crate::arm::arm;
use crate::random::Random;
use crate::rational::{
    Rational, assert_encloses, assert_holds, exact, exact_step, largest, multiply, rounded, system,
};

/// A power of two, so that k h and the recorded times are the same numbers.
const STEP: f64 = 1.0 / 256.0;

fn decay() -> LinearSystem {
    system(&[&[-0.75, 0.0], &[0.0, -12.0]], &[&[1.0], &[2.0]], &[0.0, 1.0])
}

fn growth() -> LinearSystem {
    system(&[&[0.0, 1.0], &[9.0, 0.25]], &[&[0.0], &[3.0]], &[0.5, 0.0])
}

fn rotation() -> LinearSystem {
    system(&[&[0.0, 3.0], &[-3.0, 0.0]], &[&[1.0], &[0.0]], &[0.0, 0.25])
}

fn double_integrator() -> LinearSystem {
    system(&[&[0.0, 1.0], &[0.0, 0.0]], &[&[0.0], &[1.0]], &[0.0, -9.81])
}

fn uniform(system: &LinearSystem, samples: usize) -> Propagation {
    Propagation::new(system, &TimeGrid::uniform(STEP, samples)).expect("a short horizon")
}

/// Returns the propagation at the times of [`uniform`] and one more that does not fit the rate.
fn recorded(system: &LinearSystem, samples: usize) -> Propagation {
    let odd = (samples as f64 - 0.5) * STEP;
    let times: Vec<f64> = (0..samples).map(|k| k as f64 * STEP).chain([odd]).collect();
    let grid = TimeGrid::from_times(&times).expect("increasing");
    assert_eq!(grid.step(), None);
    Propagation::new(system, &grid).expect("a short horizon")
}

fn widest(matrix: &IntervalMatrix) -> f64 {
    matrix.iter().map(|x| x.width()).fold(0.0, f64::max)
}

#[test]
fn two_thousand_steps_enclose_the_exact_exponential_and_integral() {
    for system in [decay(), growth(), rotation(), double_integrator()] {
        for propagation in [uniform(&system, 2001), recorded(&system, 2001)] {
            for k in [0, 1, 2, 77, 1000, 2000] {
                let rows = exact_step(&system, &exact(k as f64 * STEP));
                let (e, g) = (&propagation.exponential(k), propagation.integral(k));
                let widths = [assert_encloses(e, &rows, 0, "E"), assert_encloses(g, &rows, 2, "Γ")];
                assert!(
                    widths[0] <= 5e-12 * largest(e) && widths[1] <= 5e-11 * largest(g),
                    "{k} {widths:?}"
                );
            }
        }
    }
}

#[test]
fn widths_grow_linearly_where_the_exponential_stays_bounded() {
    for system in [rotation(), double_integrator(), arm()] {
        let propagation = uniform(&system, 2001);
        let relative =
            |k: usize| widest(&propagation.exponential(k)) / largest(&propagation.exponential(k));
        assert!(relative(2000) < 2.6 * relative(1000), "{:e} {:e}", relative(1000), relative(2000));
        assert!(relative(2000) < 3e-11);
    }
}

#[test]
fn decaying_entries_keep_their_relative_width() {
    let propagation = uniform(&decay(), 2001);
    let fast = propagation.exponential(2000)[(1, 1)];
    assert!(fast.lo() > 0.0 && fast.width() < 1e-11 * fast.hi(), "{fast:?}");
}

#[test]
fn steps_of_several_periods_stay_tight() {
    let fast = system(&[&[0.0, 200.0], &[-200.0, 0.0]], &[&[1.0], &[0.0]], &[0.0, 0.0]);
    let propagation = Propagation::new(&fast, &TimeGrid::uniform(0.25, 1001)).unwrap();
    assert!(
        widest(&propagation.exponential(1000)) < 1e-8,
        "{:e}",
        widest(&propagation.exponential(1000))
    );
    let rows = exact_step(&fast, &exact(0.25));
    assert_encloses(&propagation.exponential(1), &rows, 0, "E");
}

#[test]
fn growth_beyond_the_rounding_unit_is_enclosed() {
    let explosive = system(&[&[40.0]], &[&[1.0]], &[0.0]);
    let propagation = uniform(&explosive, 513);
    let rows = exact_step(&explosive, &exact(2.0));
    let width = assert_encloses(&propagation.exponential(512), &rows, 0, "E");
    assert!(width < 1e-11 * largest(&propagation.exponential(512)));
}

/// The entries e^{40 t} cos 30 t and e^{40 t} sin 30 t change sign, and exceed 1/ε after 0.9 s. The
/// documentation names this limit: widths grow exponentially relative to the entries.
#[test]
fn beyond_a_growth_of_the_rounding_unit_widths_grow_faster_than_linearly() {
    let spiral = system(&[&[40.0, 30.0], &[-30.0, 40.0]], &[&[1.0], &[0.0]], &[0.0, 0.0]);
    let relative = |propagation: Propagation, k: usize| {
        let exponential = propagation.exponential(k);
        widest(&exponential) / largest(&exponential)
    };
    let at_a_rate = [1024, 2048].map(|k| relative(uniform(&spiral, k + 1), k));
    let as_recorded = [128, 256].map(|k| relative(recorded(&spiral, k + 1), k));
    for [once, twice] in [at_a_rate, as_recorded] {
        assert!(twice > 100.0 * once, "{once:e} {twice:e}");
    }
}

#[test]
fn recorded_and_uniform_times_agree() {
    let (uniform, recorded) = (uniform(&arm(), 400), recorded(&arm(), 400));
    for k in 0..400 {
        let exponentials = [&uniform, &recorded].map(|propagation| propagation.exponential(k));
        let pairs = exponentials[0].iter().zip(&exponentials[1]);
        for (x, y) in pairs.chain(uniform.integral(k).iter().zip(recorded.integral(k))) {
            let common = x.intersection(*y).expect("both hold the exact entry");
            assert!(x.hull(*y).width() < 1e-11, "{common:?}");
        }
    }
}

/// Computes the exact solution by exact steps.
fn exact_solution(
    system: &LinearSystem,
    start: &[f64],
    inputs: &[f64],
    samples: usize,
) -> Vec<Vec<Rational>> {
    let step = exact_step(system, &exact(STEP));
    let mut x: Vec<Rational> = start.iter().map(|&x| exact(x)).collect();
    let mut states = vec![x.clone()];
    let m = system.inputs();
    for k in 1..samples {
        let row = &inputs[(k - 1) * m..k * m];
        let known = x.iter().cloned().chain(row.iter().map(|&u| exact(u))).chain([exact(1.0)]);
        let column = known.map(|x| vec![x]).collect();
        x = multiply(&step, &column).into_iter().map(|row| rounded(&row[0])).collect();
        states.push(x.clone());
    }
    states
}

fn random_inputs(count: usize, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    (0..count).map(|_| 3.0 * random.symmetric()).collect()
}

#[test]
fn solutions_enclose_the_exact_ones() {
    for system in [decay(), growth(), rotation(), double_integrator()] {
        let inputs = random_inputs(1000, 7);
        let states = exact_solution(&system, &[0.3, -0.7], &inputs, 1000);
        for propagation in [uniform(&system, 1000), recorded(&system, 1000)] {
            let start = IntervalVector::from_vec(vec![Interval::point(0.3), Interval::point(-0.7)]);
            let trajectory = propagation.solve(&start, &inputs);
            assert_eq!(trajectory.len(), 1000);
            for (k, exact_state) in states.iter().enumerate().step_by(37) {
                let largest = trajectory.state(k).iter().map(|x| x.mag()).fold(1.0, f64::max);
                for (x, value) in trajectory.state(k).iter().zip(exact_state) {
                    assert_holds(*x, value, &format!("state {k}"));
                    assert!(x.width() < 1e-11 * largest, "{k} {x:?}");
                }
            }
        }
    }
}

#[test]
fn solutions_agree_with_the_sum_over_the_inputs() {
    let (system, samples) = (arm(), 200);
    let propagation = uniform(&system, samples);
    let inputs = random_inputs(6 * samples, 11);
    let start = IntervalVector::from_element(12, Interval::point(0.2));
    let trajectory = propagation.solve(&start, &inputs);
    for k in [1, 50, 199] {
        let mut sum = propagation.exponential(k) * &start;
        for j in 0..k {
            let row = &inputs[6 * j..6 * (j + 1)];
            let u = IntervalVector::from_iterator(6, row.iter().map(|&u| Interval::point(u)));
            sum += propagation.exponential(k - 1 - j) * (&propagation.step(j).gamma * u);
        }
        for (x, y) in sum.iter().zip(trajectory.state(k)) {
            assert!(x.intersection(*y).is_some() && x.hull(*y).width() < 1e-11, "{x:?} {y:?}");
        }
    }
}

#[test]
fn a_set_of_initial_states_contains_the_solution_from_each_and_little_more() {
    let (system, inputs) = (rotation(), random_inputs(500, 3));
    let propagation = uniform(&system, 500);
    let start = IntervalVector::from_element(2, Interval::new(-0.5, 0.25).unwrap());
    let trajectory = propagation.solve(&start, &inputs);
    assert!(start.iter().zip(trajectory.state(0)).all(|(x, y)| y.encloses(x) && y.width() < 0.76));
    for vertex in [[-0.5, -0.5], [0.25, -0.5], [0.25, 0.25], [0.0, 0.1]] {
        let states = exact_solution(&system, &vertex, &inputs, 500);
        for k in [1, 130, 499] {
            let values = trajectory.state(k).iter().zip(&states[k]);
            values.for_each(|(x, value)| assert_holds(*x, value, "from a vertex"));
        }
    }
    // The hull of a rotated square is at most |cos| + |sin| <= √2 times as wide as the square.
    assert!(trajectory.state(499).iter().all(|x| x.width() < 0.75 * 2f64.sqrt() + 1e-9));
}

#[test]
fn a_trajectory_has_at_most_one_state_per_sample_and_row() {
    let propagation = uniform(&rotation(), 10);
    let start = IntervalVector::from_element(2, Interval::ONE);
    assert_eq!(propagation.solve(&start, &[1.0; 25]).len(), 10);
    assert_eq!(propagation.solve(&start, &[1.0; 4]).len(), 4);
    assert_eq!(propagation.solve(&start, &[]).len(), 0);
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None, ..ProptestConfig::with_cases(40)
    })]

    #[test]
    fn the_exponential_is_a_semigroup(
        a in proptest::array::uniform4(-3.0f64..3.0), j in 0usize..150, k in 0usize..150,
    ) {
        let matrix = dmatrix![a[0], a[1]; a[2], a[3]];
        let drift = nalgebra::dvector![0.0, 0.0];
        let system = LinearSystem::new(matrix, dmatrix![1.0; 0.0], drift).unwrap();
        let propagation = uniform(&system, 300);
        let product = propagation.exponential(j) * propagation.exponential(k);
        for (x, y) in product.iter().zip(&propagation.exponential(j + k)) {
            prop_assert!(x.intersection(*y).is_some());
            prop_assert!(y.width() <= 1e-11 * largest(&propagation.exponential(j + k)));
        }
    }
}
