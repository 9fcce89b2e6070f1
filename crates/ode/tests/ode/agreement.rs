//! Tests of one method against another, and of one call against another.

use crate::distance;
use proptest::prelude::*;
use reachtube_ode::{DormandPrince, InitialValueProblem, RungeKutta4, Tolerance};
use reachtube_scalar::Interval;

/// A driven, damped pendulum: x = (angle, velocity), u = (torque).
fn pendulum(_: f64, x: &[f64], u: &[f64], dx: &mut [f64]) {
    (dx[0], dx[1]) = (x[1], u[0] - 9.0 * x[0].sin() - 0.2 * x[1]);
}

const FINE: Tolerance = Tolerance { relative: 1e-11, absolute: 1e-11 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn adaptive_steps_agree_with_small_fixed_steps(
        start in prop::array::uniform2(-2.0..2.0f64),
        inputs in prop::collection::vec(-3.0..3.0f64, 30),
        gaps in prop::collection::vec(0.01..0.1f64, 30),
    ) {
        let mut times = vec![0.0];
        times.extend(gaps.iter().scan(0.0, |t, gap| {
            *t += gap;
            Some(*t)
        }));
        let (mut x, mut fixed) = (start, vec![start]);
        for (k, u) in inputs.iter().enumerate() {
            RungeKutta4::new(2).integrate(
                &mut pendulum,
                [times[k], times[k + 1]],
                50,
                &mut x,
                &[*u],
            );
            fixed.push(x);
        }
        let mut worst = 0.0_f64;
        let run = InitialValueProblem { start: &start, inputs: &inputs };
        let outcome = DormandPrince::new(2, FINE).simulate(&mut pendulum, &times, run, |k, x| {
            worst = worst.max(distance(x, &fixed[k]));
        });
        prop_assert!(outcome.is_reached());
        prop_assert!(worst < 1e-8, "{}", worst);
    }
}

#[test]
fn the_step_is_kept_over_the_jumps_of_the_input() {
    let mut evaluations = 0;
    let mut counted = |t: f64, x: &[f64], u: &[f64], dx: &mut [f64]| {
        evaluations += 1;
        pendulum(t, x, u, dx);
    };
    let times: Vec<f64> = (0..=1000).map(|k| 0.004 * f64::from(k)).collect();
    let inputs: Vec<f64> = times[1..].iter().map(|t| (3.0 * t).sin()).collect();
    let run = InitialValueProblem { start: &[0.5, 0.0], inputs: &inputs };
    assert!(
        DormandPrince::new(2, Tolerance::default())
            .simulate(&mut counted, &times, run, |_, _| {})
            .is_reached()
    );
    // Each span takes one step with seven evaluations. Only the first span searches its step size.
    assert!((7000..7050).contains(&evaluations), "{evaluations} evaluations");
}

#[test]
fn a_used_solver_gives_the_same_run() {
    let run = InitialValueProblem { start: &[0.5, 0.0], inputs: &[1.0, -1.0] };
    let mut solver = DormandPrince::new(2, Tolerance::default());
    let mut ends = |start: &[f64]| {
        let mut end = [0.0; 2];
        let run = InitialValueProblem { start, ..run };
        assert!(
            solver
                .simulate(&mut pendulum, &[0.0, 0.7, 1.9], run, |_, x| end.copy_from_slice(x))
                .is_reached()
        );
        end
    };
    let first = ends(&[0.5, 0.0]);
    ends(&[-2.0, 9.0]);
    assert_eq!(ends(&[0.5, 0.0]), first);
}

#[test]
fn runge_kutta_over_intervals_encloses_the_method() {
    fn field<S: reachtube_scalar::Scalar>(_: f64, x: &[S], u: &[S], dx: &mut [S]) {
        dx[0] = x[1].clone();
        dx[1] = u[0].clone() - x[0].clone() * x[0].clone() * x[0].clone();
    }
    let mut wide = [Interval::centred(0.5, 1e-3), Interval::point(0.0)];
    RungeKutta4::new(2).integrate(&mut field, [0.0, 1.0], 20, &mut wide, &[Interval::point(0.1)]);
    for start in [0.499, 0.5, 0.5004, 0.501] {
        let mut x = [start, 0.0];
        RungeKutta4::new(2).integrate(&mut field, [0.0, 1.0], 20, &mut x, &[0.1]);
        assert!(
            wide.iter().zip(x).all(|(wide, x)| wide.contains(x) && wide.width() < 0.02),
            "{wide:?} {x:?}"
        );
    }
}

#[test]
#[should_panic(expected = "7 input entries do not form one row for each of 2 spans")]
fn inputs_that_do_not_form_rows_panic() {
    let run = InitialValueProblem { start: &[0.0, 0.0], inputs: &[1.0; 7] };
    let _ = DormandPrince::new(2, FINE).simulate(&mut pendulum, &[0.0, 1.0, 2.0], run, |_, _| {});
}
