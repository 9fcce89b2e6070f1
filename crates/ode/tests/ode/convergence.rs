//! Tests of the orders of convergence against exact solutions.

use crate::{distance, order};
use nalgebra::{DMatrix, DVector, dmatrix, dvector};
use reachtube_ode::{DormandPrince, RungeKutta4, Tolerance};

/// A damped, coupled, driven system ẋ = A x + B u.
fn linear() -> (DMatrix<f64>, DMatrix<f64>) {
    let a = dmatrix![0.0, 1.0, 0.0; -4.0, -0.4, 1.0; 0.5, 0.0, -1.0];
    (a, dmatrix![0.0, 0.0; 1.0, 0.0; 0.3, -2.0])
}

/// Returns the solution after t under a held input, by the exponential of [[A, B u], [0, 0]].
fn exact(t: f64, x: &DVector<f64>, u: &DVector<f64>) -> DVector<f64> {
    let (a, b) = linear();
    let mut block = DMatrix::zeros(4, 4);
    block.view_mut((0, 0), (3, 3)).copy_from(&a);
    block.view_mut((0, 3), (3, 1)).copy_from(&(b * u));
    ((block * t).exp() * x.push(1.0)).rows(0, 3).into_owned()
}

fn linear_field() -> impl FnMut(f64, &[f64], &[f64], &mut [f64]) {
    let (a, b) = linear();
    move |_, x, u, dx| {
        let rate = &a * DVector::from_column_slice(x) + &b * DVector::from_column_slice(u);
        dx.copy_from_slice(rate.as_slice());
    }
}

/// An oscillator with a time-dependent frequency: x = sin(t + t²).
fn chirp(t: f64, x: &[f64], _: &[f64], dx: &mut [f64]) {
    let w = 1.0 + 2.0 * t;
    (dx[0], dx[1]) = (w * x[1], -w * x[0]);
}

fn exact_chirp(t: f64) -> [f64; 2] {
    [(t + t * t).sin(), (t + t * t).cos()]
}

/// Returns a solver that takes any span in one step.
fn one_step_solver(dimension: usize) -> DormandPrince {
    let mut solver = DormandPrince::new(dimension, Tolerance { relative: 0.0, absolute: 1e9 });
    let mut at_rest = |_: f64, _: &[f64], _: &[f64], dx: &mut [f64]| dx.fill(0.0);
    assert!(
        solver.integrate(&mut at_rest, [0.0, 1e9], &mut vec![0.0; dimension], &[]).is_reached()
    );
    solver
}

#[test]
fn runge_kutta_is_of_order_4() {
    let (start, u) = (dvector![1.0, -0.5, 0.2], dvector![0.7, -0.1]);
    let error = |steps: usize| {
        let mut x = start.clone();
        let span = [0.0, 2.0];
        RungeKutta4::new(3).integrate(
            &mut linear_field(),
            span,
            steps,
            x.as_mut_slice(),
            u.as_slice(),
        );
        (2.0 / steps as f64, distance(x.as_slice(), exact(2.0, &start, &u).as_slice()))
    };
    let found = order(&[error(50), error(400)]);
    assert!((found - 4.0).abs() < 0.1, "order {found}");
    let error = |steps: usize| {
        let mut x = exact_chirp(0.0);
        RungeKutta4::new(2).integrate(&mut chirp, [0.0, 2.0], steps, &mut x, &[]);
        (2.0 / steps as f64, distance(&x, &exact_chirp(2.0)))
    };
    let found = order(&[error(100), error(800)]);
    assert!((found - 4.0).abs() < 0.1, "order {found}");
}

#[test]
fn dormand_prince_is_of_order_5() {
    let error = |steps: usize| {
        let (mut solver, mut x) = (one_step_solver(2), exact_chirp(0.0));
        let at = |k: usize| 2.0 * k as f64 / steps as f64;
        for k in 0..steps {
            assert!(solver.integrate(&mut chirp, [at(k), at(k + 1)], &mut x, &[]).is_reached());
        }
        (2.0 / steps as f64, distance(&x, &exact_chirp(2.0)))
    };
    let found = order(&[error(60), error(240)]);
    assert!((found - 5.0).abs() < 0.15, "order {found}");
}

#[test]
fn errors_scale_with_the_tolerance_and_steps_with_its_fifth_root() {
    let run = |tolerance: f64| {
        let (mut evaluations, mut x) = (0, exact_chirp(0.0));
        let mut counted = |t: f64, x: &[f64], u: &[f64], dx: &mut [f64]| {
            evaluations += 1;
            chirp(t, x, u, dx);
        };
        let tolerance = Tolerance { relative: 0.0, absolute: tolerance };
        assert!(
            DormandPrince::new(2, tolerance)
                .integrate(&mut counted, [0.0, 3.0], &mut x, &[])
                .is_reached()
        );
        (evaluations as f64, distance(&x, &exact_chirp(3.0)))
    };
    let (coarse, fine) = (run(1e-5), run(1e-10));
    assert!(coarse.1 < 1e-3 && fine.1 < 1e-8, "errors {} and {}", coarse.1, fine.1);
    // A tolerance 10⁵ times smaller needs 10^(5/5) times the steps, up to the first steps.
    let growth = fine.0 / coarse.0;
    assert!((8.0..12.0).contains(&growth), "{} and {} evaluations", coarse.0, fine.0);
}

#[test]
fn a_held_input_gives_the_exact_solution() {
    let times: Vec<f64> = (0..=40).map(|k| 0.05 * f64::from(k) + 0.01 * f64::from(k % 3)).collect();
    let inputs: Vec<f64> = (0..80).map(|k| (1.7 * f64::from(k)).sin()).collect();
    let mut state = dvector![1.0, -0.5, 0.2];
    let run = reachtube_ode::InitialValueProblem { start: &[1.0, -0.5, 0.2], inputs: &inputs };
    let tolerance = Tolerance { relative: 1e-10, absolute: 1e-10 };
    let mut samples = 0;
    let outcome =
        DormandPrince::new(3, tolerance).simulate(&mut linear_field(), &times, run, |k, x| {
            if k > 0 {
                let u = DVector::from_column_slice(&inputs[2 * k - 2..2 * k]);
                state = exact(times[k] - times[k - 1], &state, &u);
            }
            assert!(distance(x, state.as_slice()) < 1e-9);
            samples += 1;
        });
    assert!(outcome.is_reached());
    assert_eq!(samples, 41);
}
