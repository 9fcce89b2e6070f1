//! Time per run of the LWA 4P with friction: 1 s at 250 Hz on one core. Items are runs.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use reachtube_ode::{DormandPrince, Ensemble, InitialValueProblem, Tolerance};
use reachtube_robot::{DrivenBy, Robot, RobotField};
use reachtube_scalar::{Lanes, Lanewise};

const SAMPLES: usize = 251;
const RUNS: usize = 16;

fn main() {
    divan::main();
}

/// Returns sample times, the initial states of the runs, and the torques that all runs share.
fn recorded() -> (Vec<f64>, Vec<Vec<f64>>, Vec<f64>) {
    let times: Vec<f64> = (0..SAMPLES).map(|k| 0.004 * k as f64).collect();
    let start = |r: usize| (0..12).map(|i| 0.3 * (1.3 * r as f64 + i as f64).sin()).collect();
    let torque = |t: f64| (0..6).map(move |i| 10.0 * (5.0 * t + f64::from(i)).cos());
    let torques = times[1..].iter().flat_map(|t| torque(*t)).collect();
    (times, (0..RUNS).map(start).collect(), torques)
}

/// One Runge-Kutta step per sample.
#[divan::bench(
    types = [f64, Lanes<4>, Lanes<8>],
    args = [DrivenBy::Motor, DrivenBy::Input],
    sample_count = 20
)]
fn fixed<S: Lanewise>(bencher: Bencher, driven_by: DrivenBy) {
    let (robot, (times, starts, inputs)) = (Robot::lwa4p(), recorded());
    let runs: Vec<_> =
        starts.iter().map(|start| InitialValueProblem { start, inputs: &inputs }).collect();
    let mut field = RobotField::<S>::new(&robot, driven_by).regularised_below(0.01);
    let mut ensemble = Ensemble::new(12);
    bencher.counter(ItemsCount::new(RUNS)).bench_local(|| {
        ensemble.integrate(&mut field, &times, 1, &runs, |_, _, x| {
            black_box(x);
        })
    });
}

#[divan::bench(args = [1e-4, 1e-6, 1e-8], consts = [true, false], sample_count = 10)]
fn adaptive<const MOTOR: bool>(bencher: Bencher, tolerance: f64) {
    let (robot, (times, starts, inputs)) = (Robot::lwa4p(), recorded());
    let driven_by = if MOTOR { DrivenBy::Motor } else { DrivenBy::Input };
    let mut field = RobotField::new(&robot, driven_by).regularised_below(0.01);
    let mut solver = DormandPrince::new(12, Tolerance { relative: tolerance, absolute: tolerance });
    bencher.counter(ItemsCount::new(RUNS)).bench_local(|| {
        for start in &starts {
            let outcome = solver.simulate(
                &mut field,
                &times,
                InitialValueProblem { start, inputs: &inputs },
                |_, x| {
                    black_box(x);
                },
            );
            assert!(outcome.is_reached(), "{outcome:?}");
        }
    });
}
