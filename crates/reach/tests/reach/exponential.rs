//! The matrices e^{Ah}, Γ(h) and γ(h) of one step.

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use reachtube_reach::{LinearSystem, step};
use reachtube_scalar::Interval;

use crate::rational::{assert_encloses, exact, exact_step, largest, system};

/// Fails unless the step encloses the exact one, with widths up to `relative` times the largest
/// entry of each matrix (for Φ at least 1).
fn assert_tight(system: &LinearSystem, h: f64, relative: f64) {
    let step = step(system, Interval::point(h));
    let rows = exact_step(system, &exact(h));
    let (n, m) = (system.states(), system.inputs());
    let drift = DMatrix::from_column_slice(n, 1, step.drift.as_slice());
    for (matrix, from, name) in [(&step.phi, 0, "Φ"), (&step.gamma, n, "Γ"), (&drift, n + m, "γ")]
    {
        let width = assert_encloses(matrix, &rows, from, name);
        let allowed = relative * largest(matrix).max(if from == 0 { 1.0 } else { 0.0 });
        assert!(width <= allowed, "{name} over {h} s is {width:e} wide, more than {allowed:e}");
    }
}

#[test]
fn a_double_integrator_is_tight_and_keeps_its_zeros() {
    let integrator = system(&[&[0.0, 1.0], &[0.0, 0.0]], &[&[0.0], &[1.0]], &[0.5, -9.81]);
    for h in [1.0 / 1024.0, 0.004, 0.25, 37.5] {
        assert_tight(&integrator, h, if h < 0.5 { 4e-15 } else { 1e-13 });
        let step = step(&integrator, Interval::point(h));
        assert_eq!(step.phi[(1, 0)], Interval::ZERO);
        assert!(h > 0.5 || step.phi[(0, 0)] == Interval::ONE);
    }
}

#[test]
fn stiff_unstable_and_coupled_systems_are_tight() {
    let stiff = system(&[&[-900.0, 3.0], &[1.0, -0.5]], &[&[2.0, 0.0], &[0.5, 1.0]], &[1.0, 1.0]);
    let unstable = system(&[&[0.0, 1.0], &[9.0, 0.5]], &[&[0.0], &[3.0]], &[0.0, 2.0]);
    let rotation = system(&[&[0.0, 40.0], &[-40.0, 0.0]], &[&[1.0], &[-2.0]], &[3.0, 0.0]);
    for h in [0.001, 0.004, 0.1] {
        assert_tight(&stiff, h, 3e-13);
        assert_tight(&unstable, h, 8e-15);
        assert_tight(&rotation, h, 4e-14);
    }
}

#[test]
fn an_entry_below_the_remainder_of_the_series_is_enclosed() {
    // The entries along a chain of integrators are hⁱ/i!; the series stops before the last one.
    let chain = DMatrix::from_fn(9, 9, |i, j| if j == i + 1 { 1.0 } else { 0.0 });
    let system =
        LinearSystem::new(chain, DMatrix::from_element(9, 1, 1.0), DVector::zeros(9)).unwrap();
    for h in [0.01, 0.05] {
        let (step, rows) = (step(&system, Interval::point(h)), exact_step(&system, &exact(h)));
        assert_encloses(&step.phi, &rows, 0, "Φ");
        assert!(step.phi[(0, 8)].hi() > 0.0 && step.phi[(0, 8)].hi() < 1e-15);
    }
}

#[test]
fn an_interval_of_lengths_covers_each_length() {
    let damped = system(&[&[0.0, 1.0], &[-2.0, -7.0]], &[&[0.0], &[4.0]], &[0.0, 1.0]);
    let over_all = step(&damped, Interval::new(0.0, 0.125).unwrap());
    for sixteenth in 0..=16 {
        let rows = exact_step(&damped, &exact(f64::from(sixteenth) / 128.0));
        assert_encloses(&over_all.phi, &rows, 0, "Φ");
        assert_encloses(&over_all.gamma, &rows, 2, "Γ");
    }
    assert!(largest(&over_all.phi) < 1.5);
}

#[test]
fn an_overflow_gives_an_infinite_bound() {
    let explosive = system(&[&[1e300]], &[&[1.0]], &[0.0]);
    assert_eq!(step(&explosive, Interval::point(1e300)).phi[(0, 0)].hi(), f64::INFINITY);
}

fn any_system() -> impl Strategy<Value = LinearSystem> {
    let quarters = || (-16i32..=16).prop_map(|n| f64::from(n) / 4.0);
    (1usize..=3, 1usize..=2).prop_flat_map(move |(n, m)| {
        let entries = |count| proptest::collection::vec(quarters(), count);
        (entries(n * n), entries(n * m), entries(n)).prop_map(move |(a, b, d)| {
            let (a, b) = (DMatrix::from_vec(n, n, a), DMatrix::from_vec(n, m, b));
            LinearSystem::new(a, b, DVector::from_vec(d)).expect("finite")
        })
    })
}

fn cases(count: u32) -> ProptestConfig {
    ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(count) }
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn random_systems_over_short_steps(
        system in any_system(), h in prop_oneof![Just(1.0 / 256.0), Just(0.01), Just(0.0625)],
    ) {
        assert_tight(&system, h, 2e-14);
    }

    #[test]
    fn random_systems_over_long_steps(
        system in any_system(), h in prop_oneof![Just(1.0), Just(3.7)],
    ) {
        let step = step(&system, Interval::point(h));
        let rows = exact_step(&system, &exact(h));
        assert_encloses(&step.phi, &rows, 0, "Φ");
        assert_encloses(&step.gamma, &rows, system.states(), "Γ");
    }
}
