//! The input gains κ from the input set to the reachable set.

use std::f64::consts::PI;

use proptest::prelude::*;
use reachtube_reach::{Disturbance, IntervalMatrix, LinearSystem, Propagation, TimeGrid, step};
use reachtube_scalar::Interval;

use crate::arm::arm;
use crate::rational::system;

use Disturbance::{Constant, Measurable, Sample};

/// A power of two, so that k h and the recorded times are the same numbers.
const STEP: f64 = 1.0 / 256.0;

fn on(grid: &TimeGrid, system: &LinearSystem) -> Propagation {
    Propagation::new(system, grid).expect("a short horizon")
}

fn uniform(system: &LinearSystem, samples: usize) -> Propagation {
    on(&TimeGrid::uniform(STEP, samples), system)
}

/// Returns times that differ from k h by up to a third of a step.
fn jittered(samples: usize) -> TimeGrid {
    let time = |k: usize| (k as f64 + 0.33 * (1.7 * k as f64).sin()) * STEP;
    TimeGrid::from_times(&(0..samples).map(time).collect::<Vec<_>>()).expect("increasing")
}

/// Returns the system with e^{Aτ} B = (sin ωτ, cos ωτ).
fn oscillator(omega: f64) -> LinearSystem {
    system(&[&[0.0, omega], &[-omega, 0.0]], &[&[0.0], &[1.0]], &[0.0, 0.0])
}

fn assert_near(x: Interval, value: f64, tolerance: f64, what: &str) {
    assert!((x - value).mag() <= tolerance, "{what}: {x:?} is not {value} within {tolerance:e}");
}

/// Fails unless all entries of the gains agree within `relative` times the largest.
fn assert_same(left: &[IntervalMatrix], right: &[IntervalMatrix], relative: f64) {
    assert_eq!(left.len(), right.len());
    let largest = right.last().unwrap().iter().map(|x| x.mag()).fold(0.0, f64::max);
    assert!(largest.is_finite());
    for (k, (left, right)) in left.iter().zip(right).enumerate() {
        assert_eq!(left.shape(), right.shape());
        for (x, y) in left.iter().zip(right) {
            assert!(x.hull(*y).width() <= relative * largest, "sample {k}: {x:?} and {y:?}");
            assert!(x.intersection(*y).is_some(), "sample {k}: {x:?} and {y:?}");
        }
    }
}

#[test]
fn one_joint_has_the_same_gain_under_every_disturbance() {
    let (damping, b) = (2.5, 0.75);
    let joint = system(&[&[0.0, 1.0], &[0.0, -damping]], &[&[0.0], &[b]], &[0.0, 0.0]);
    let propagation = uniform(&joint, 700);
    let constant = Constant.input_gains(&propagation);
    assert_same(&Sample.input_gains(&propagation), &constant, 1e-12);
    assert_same(&Measurable.input_gains(&propagation), &constant, 1e-12);
    for k in [0, 1, 300, 699] {
        let t = k as f64 * STEP;
        let speed = b * -(-damping * t).exp_m1() / damping;
        assert_near(constant[k][(1, 0)], speed, 2e-13, "speed");
        assert_near(constant[k][(0, 0)], (b * t - speed) / damping, 2e-13, "position");
    }
}

/// Returns ∫₀ᵗ |sin|.
fn absolute_sine(t: f64) -> f64 {
    2.0 * (t / PI).floor() + 1.0 - t.rem_euclid(PI).cos()
}

/// Returns ∫₀ᵗ |cos|.
fn absolute_cosine(t: f64) -> f64 {
    absolute_sine(t + PI / 2.0) - 1.0
}

#[test]
fn an_oscillator_has_the_integral_of_absolute_sine_and_cosine() {
    for omega in [1.0, 5.0] {
        for grid in [TimeGrid::uniform(STEP, 1500), jittered(1500)] {
            let gains = Measurable.input_gains(&on(&grid, &oscillator(omega)));
            for k in (0..1500).step_by(41) {
                let t = omega * grid.times()[k];
                assert_near(gains[k][(0, 0)], absolute_sine(t) / omega, 1e-11, "∫|sin|");
                assert_near(gains[k][(1, 0)], absolute_cosine(t) / omega, 1e-11, "∫|cos|");
            }
        }
    }
}

#[test]
fn cells_as_long_as_several_turns_are_resolved() {
    let grid = TimeGrid::uniform(0.5, 9);
    let gains = Measurable.input_gains(&on(&grid, &oscillator(100.0)));
    for (k, gain) in gains.iter().enumerate() {
        assert_near(gain[(0, 0)], absolute_sine(50.0 * k as f64) / 100.0, 3e-10, "∫|sin|");
    }
    let stiff = system(&[&[-2000.0, 0.0], &[0.0, -0.5]], &[&[2000.0], &[1.0]], &[0.0, 0.0]);
    let gains = Measurable.input_gains(&on(&TimeGrid::uniform(0.25, 5), &stiff));
    assert_near(gains[4][(0, 0)], 1.0, 1e-10, "stiff");
    assert_near(gains[4][(1, 0)], -2.0 * (-0.5f64).exp_m1(), 1e-12, "slow");
}

#[test]
fn halving_stops_where_the_response_has_decayed() {
    // Only rounding errors of either sign remain of e^{At} B, so halving would not end.
    let coupled = system(&[&[-60.0, 25.0], &[20.0, -70.0]], &[&[1.0], &[-1.5]], &[0.0, 0.0]);
    let gains = Measurable.input_gains(&uniform(&coupled, 1500));
    assert!(gains[1499].iter().all(|x| x.width() < 1e-12 * x.hi()), "{:?}", gains[1499]);
}

#[test]
fn a_constant_disturbance_reaches_least_and_a_measurable_one_furthest() {
    for (system, grid) in [
        (arm(), TimeGrid::uniform(0.004, 300)),
        (arm(), jittered(120)),
        (oscillator(7.0), TimeGrid::uniform(0.05, 100)),
    ] {
        let propagation = on(&grid, &system);
        let gains =
            [Constant, Sample, Measurable].map(|disturbance| disturbance.input_gains(&propagation));
        for pair in gains.windows(2) {
            for (less, more) in
                pair[0].iter().flatten_entries().zip(pair[1].iter().flatten_entries())
            {
                assert!(less.lo() <= more.hi(), "{less:?} {more:?}");
            }
        }
    }
    // Where entries change sign, the three gains differ clearly.
    let propagation = on(&TimeGrid::uniform(0.3, 30), &oscillator(7.0));
    let at_end = |disturbance: Disturbance| disturbance.input_gains(&propagation)[29][(0, 0)];
    assert!(at_end(Constant).hi() < 0.2 * at_end(Sample).lo());
    assert!(at_end(Sample).hi() < 0.97 * at_end(Measurable).lo());
}

trait FlattenEntries<'a> {
    fn flatten_entries(self) -> impl Iterator<Item = &'a Interval>;
}

impl<'a, I: Iterator<Item = &'a IntervalMatrix>> FlattenEntries<'a> for I {
    fn flatten_entries(self) -> impl Iterator<Item = &'a Interval> {
        self.flat_map(|matrix| matrix.iter())
    }
}

#[test]
fn a_measurable_disturbance_is_the_limit_of_ever_faster_samples() {
    let system = arm();
    let measurable =
        Measurable.input_gains(&on(&TimeGrid::uniform(0.004, 101), &system))[100].clone();
    let mut last = f64::INFINITY;
    for parts in [1, 4, 16] {
        let fine = on(&TimeGrid::uniform(0.004 / parts as f64, 100 * parts + 1), &system);
        let sample = Sample.input_gains(&fine)[100 * parts].clone();
        assert!(sample.iter().zip(&measurable).all(|(x, y)| x.lo() <= y.hi()));
        let missing =
            sample.iter().zip(&measurable).map(|(x, y)| y.hi() - x.lo()).fold(0.0, f64::max);
        assert!(missing < last || missing < 1e-12, "{missing:e} after {last:e}");
        last = missing;
    }
    assert!(last < 1e-6, "{last:e}");
}

#[test]
fn a_measurable_disturbance_agrees_with_the_trapezoidal_rule() {
    let (system, parts) = (arm(), 4000);
    let h = 0.4 / f64::from(parts);
    let fine = on(&TimeGrid::uniform(h, parts as usize + 1), &system);
    let b = system.b().map(Interval::point);
    let mut sum = nalgebra::DMatrix::zeros(12, 6);
    for k in 0..parts as usize {
        // Trapezoidal rule for the absolute values; its error at a sign change is below h² times
        // the slope.
        let ends = [k, k + 1].map(|k| (fine.exponential(k) * &b).map(|x| x.mid().abs()));
        sum += (&ends[0] + &ends[1]) * (0.5 * h);
    }
    let gains = Measurable.input_gains(&on(&TimeGrid::uniform(0.004, 101), &system))[100].clone();
    for (x, &rule) in gains.iter().zip(&sum) {
        assert_near(*x, rule, 2e-6, "trapezoids");
    }
}

/// Evaluates Σ_j |Γ(t_k - t_j) - Γ(t_k - t_{j+1})| term by term.
fn brute_force(system: &LinearSystem, times: &[f64], k: usize) -> IntervalMatrix {
    let gamma =
        |j: usize| step(system, Interval::point(times[k]) - Interval::point(times[j])).gamma;
    let mut sum = IntervalMatrix::from_element(system.states(), system.inputs(), Interval::ZERO);
    for j in 0..k {
        sum += (gamma(j) - gamma(j + 1)).map(|x| x.abs());
    }
    sum
}

#[test]
fn samples_at_any_times_agree_with_the_sum_term_by_term() {
    let odd = system(
        &[&[0.0, 6.0, 1.0], &[-6.0, -1.0, 0.0], &[0.5, 2.0, -3.0]],
        &[&[0.0, 1.0], &[1.0, 0.0], &[-2.0, 1.0]],
        &[0.0; 3],
    );
    for (system, scale) in [(odd, 8.0), (arm(), 1.0)] {
        let times: Vec<f64> = jittered(90).times().iter().map(|t| t * scale).collect();
        let grid = TimeGrid::from_times(&times).unwrap();
        assert_eq!(grid.step(), None);
        let propagation = on(&grid, &system);
        let (gains, measurable) =
            (Sample.input_gains(&propagation), Measurable.input_gains(&propagation));
        for k in [1, 2, 30, 89] {
            let sum = brute_force(&system, grid.times(), k);
            for ((x, y), z) in gains[k].iter().zip(&sum).zip(&measurable[k]) {
                assert!(x.lo() <= y.hi() && y.lo() <= x.hi(), "sample {k}: {x:?} misses {y:?}");
                assert!(y.lo() - x.lo() < 1e-11, "sample {k}: {x:?} is loose below {y:?}");
                assert_eq!(x.hi(), z.hi());
            }
        }
    }
}

#[test]
fn recorded_times_of_a_fixed_rate_give_the_gains_of_that_rate() {
    let times: Vec<f64> = (0..301).map(|k| k as f64 * STEP).chain([300.5 * STEP]).collect();
    for system in [arm(), oscillator(9.0)] {
        let recorded = on(&TimeGrid::from_times(&times).unwrap(), &system);
        let uniform = uniform(&system, 301);
        assert_eq!(recorded.grid().step(), None);
        let (any_grid, fixed) = (Sample.input_gains(&recorded), Sample.input_gains(&uniform));
        for (x, y) in any_grid.iter().flatten_entries().zip(fixed.iter().flatten_entries()) {
            assert!(x.lo() <= y.hi() && y.lo() <= x.hi(), "{x:?} misses {y:?}");
            assert!((y.lo() - x.lo()).abs() < 1e-11, "{x:?} is loose below {y:?}");
        }
        assert_same(
            &Measurable.input_gains(&recorded)[..301],
            &Measurable.input_gains(&uniform),
            1e-11,
        );
        assert_same(
            &Constant.input_gains(&recorded)[..301],
            &Constant.input_gains(&uniform),
            1e-11,
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None, ..ProptestConfig::with_cases(40)
    })]

    #[test]
    fn random_systems_keep_the_order_and_agree_with_trapezoids(
        a in proptest::array::uniform4(-8.0f64..8.0), b in -2.0f64..2.0,
    ) {
        let system = system(&[&[a[0], a[1]], &[a[2], a[3]]], &[&[1.0], &[b]], &[0.0, 0.0]);
        let propagation = on(&TimeGrid::uniform(0.02, 41), &system);
        let [constant, sample, measurable] =
            [Constant, Sample, Measurable].map(|d| d.input_gains(&propagation)[40].clone());
        let fine = on(&TimeGrid::uniform(0.02 / 64.0, 40 * 64 + 1), &system);
        let b = system.b().map(Interval::point);
        for i in 0..2 {
            let value = |k: usize| (fine.exponential(k) * &b)[i].mid().abs();
            let trapezoids = (0..40 * 64).map(|k| 0.5 * (value(k) + value(k + 1))).sum::<f64>();
            let rule = trapezoids * 0.02 / 64.0;
            let gain = measurable[i];
            prop_assert!(constant[i].lo() <= sample[i].hi() && sample[i].lo() <= gain.hi());
            prop_assert!((gain - rule).mag() < 1e-4 * gain.hi(), "{gain:?} {rule}");
            // The terms of e^{At} B may cancel where b is nearly orthogonal to a growing mode.
            let terms = propagation.exponential(40).iter().map(|x| x.mag()).fold(1.0, f64::max);
            prop_assert!(gain.width() < 1e-11 * terms, "{gain:?}");
        }
    }
}
