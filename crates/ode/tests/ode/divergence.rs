//! Tests that an integration without a solution to the end reports where and why it stopped.

use proptest::prelude::*;
use reachtube_ode::{
    Cause, DormandPrince, Ensemble, InitialValueProblem, Outcome, Tolerance, VectorField,
};
use reachtube_scalar::{Lanes, Lanewise};

fn solver() -> DormandPrince {
    DormandPrince::new(1, Tolerance::default())
}

/// The field ẋ = x², with the solution x = 1 / (1 / x0 - t).
struct Square;

impl<S: Lanewise> VectorField<S> for Square {
    fn rate(&mut self, _: f64, x: &[S], _: &[S], dx: &mut [S]) {
        dx[0] = x[0] * x[0];
    }
}

proptest! {
    #[test]
    fn a_pole_is_found(start in 0.1..100.0f64) {
        let Outcome::Diverged { time, .. } =
            solver().integrate(&mut Square, [0.0, 20.0], &mut [start], &[])
        else {
            return Err(TestCaseError::fail("passed a pole"));
        };
        prop_assert!((time * start - 1.0).abs() < 1e-6, "{} for {}", time, 1.0 / start);
    }
}

#[test]
fn a_bound_is_met_in_time() {
    let mut growth = |_: f64, x: &[f64], _: &[f64], dx: &mut [f64]| dx[0] = x[0];
    let mut x = [-1.0];
    let outcome = solver().bounded_by(1000.0).integrate(&mut growth, [0.0, 20.0], &mut x, &[]);
    let Outcome::Diverged { time, cause: Cause::Bound } = outcome else { panic!("{outcome:?}") };
    // The time is that at the end of the step that left the bound.
    assert!(
        (time.exp() / 1000.0 - 1.0).abs() < 0.5 && (time.exp() / x[0] + 1.0).abs() < 1e-6,
        "{time} s, {x:?}"
    );
    assert!(
        solver()
            .bounded_by(1000.0)
            .integrate(&mut growth, [0.0, 6.0], &mut [-1.0], &[])
            .is_reached()
    );
}

#[test]
fn nan_and_chatter_stop_the_integration() {
    let stopped = |outcome, at: f64, why: Cause| {
        let Outcome::Diverged { time, cause } = outcome else { panic!("{outcome:?}") };
        // The chattering solution advances by about 1e-6 s per step.
        let slack = if why == Cause::StepCount { 1e-2 } else { 1e-9 };
        assert!((time - at).abs() < slack && cause == why, "{outcome:?}");
    };
    let mut nan = |_: f64, _: &[f64], _: &[f64], dx: &mut [f64]| dx[0] = f64::NAN;
    stopped(solver().integrate(&mut nan, [3.0, 4.0], &mut [1.0], &[]), 3.0, Cause::StepSize);
    // The rate is NaN beyond t = 1 s.
    let mut root = |t: f64, _: &[f64], _: &[f64], dx: &mut [f64]| dx[0] = (1.0 - t).sqrt();
    stopped(solver().integrate(&mut root, [0.0, 4.0], &mut [1.0], &[]), 1.0, Cause::StepSize);
    let mut still = |_: f64, _: &[f64], _: &[f64], dx: &mut [f64]| dx[0] = 0.0;
    for start in [f64::NAN, f64::NEG_INFINITY] {
        stopped(solver().integrate(&mut still, [2.0, 4.0], &mut [start], &[]), 2.0, Cause::Bound);
    }
    let mut chatter = |_: f64, x: &[f64], _: &[f64], dx: &mut [f64]| dx[0] = -x[0].signum();
    let outcome = solver().within_steps(1000).integrate(&mut chatter, [0.0, 2.0], &mut [1.0], &[]);
    stopped(outcome, 1.0, Cause::StepCount);
}

#[test]
fn a_solver_works_after_a_divergence() {
    let mut solver = solver();
    let mut x = [1.0];
    assert!(!solver.integrate(&mut Square, [0.0, 2.0], &mut x, &[]).is_reached());
    x = [1.0];
    assert!(solver.integrate(&mut Square, [0.0, 0.5], &mut x, &[]).is_reached());
    assert!((x[0] - 2.0).abs() < 1e-6);
    let mut nan = |_: f64, _: &[f64], _: &[f64], dx: &mut [f64]| dx[0] = f64::NAN;
    assert!(!solver.integrate(&mut nan, [0.0, 1.0], &mut x, &[]).is_reached());
    assert_eq!(solver.integrate(&mut Square, [0.0, 0.0], &mut x, &[]), Outcome::Reached);
}

#[test]
fn a_run_that_diverges_does_not_affect_its_neighbours() {
    let starts = [[0.1], [1.0], [-2.0], [0.5], [5.0]];
    let runs = starts.each_ref().map(|start| InitialValueProblem { start, inputs: &[] });
    let times: Vec<f64> = (0..=300).map(|k| 0.01 * f64::from(k)).collect();
    let mut reached = [0; 5];
    let mut ensemble = Ensemble::<Lanes<4>>::new(1).bounded_by(1e6);
    let outcomes = ensemble.integrate(&mut Square, &times, 10, &runs, |run, sample, x| {
        let exact = 1.0 / (1.0 / starts[run][0] - times[sample]);
        // Near its pole and beyond, a run with fixed steps is not a solution.
        let is_early = starts[run][0] * times[sample] < 0.9;
        assert!((x[0] / exact - 1.0).abs() < 1e-3 || !is_early, "{run}: {} is not {exact}", x[0]);
        reached[run] = sample;
    });
    for (run, [start]) in starts.iter().enumerate() {
        let pole = 1.0 / start;
        if (0.0..3.0).contains(&pole) {
            let Outcome::Diverged { time, cause: Cause::Bound } = outcomes[run] else {
                panic!("{:?}", outcomes[run])
            };
            assert!(
                (time - pole).abs() < 0.03 && times[reached[run]] == time,
                "{time} is not {pole}"
            );
        } else {
            assert_eq!((outcomes[run], reached[run]), (Outcome::Reached, 300));
        }
    }
}
