//! Benchmarks of the linear reachable sets of a six-joint arm, 12 states and 6 inputs, over 5 s at
//! 250 Hz.

#[path = "../tests/reach/arm.rs"]
mod arm;

use arm::arm;
use divan::{Bencher, black_box};
use reachtube_reach::{
    Disturbance, Hyperrectangle, IntervalVector, Propagation, ReachSets, StepBounds, StepRadii,
    TimeGrid,
};
use reachtube_scalar::Interval;

const SAMPLES: usize = 1251;
const STEP: f64 = 0.004;
const DISTURBANCES: [Disturbance; 3] =
    [Disturbance::Constant, Disturbance::Sample, Disturbance::Measurable];

fn main() {
    divan::main();
}

fn uniform() -> TimeGrid {
    TimeGrid::uniform(STEP, SAMPLES)
}

/// Returns sample times that differ from the fixed rate by up to a tenth of a step.
fn jittered() -> TimeGrid {
    let time = |k: usize| (k as f64 + 0.1 * (k as f64).sin()) * STEP;
    TimeGrid::from_times(&(0..SAMPLES).map(time).collect::<Vec<_>>()).expect("increasing")
}

fn propagation(grid: &TimeGrid) -> Propagation {
    Propagation::new(&arm(), grid).expect("a short horizon")
}

fn sets() -> (Hyperrectangle, Hyperrectangle) {
    let set = |n: usize| Hyperrectangle { centre: vec![0.01; n], radius: vec![0.02; n] };
    (set(12), set(6))
}

#[divan::bench]
fn propagate(bencher: Bencher) {
    let (system, grid) = (arm(), uniform());
    bencher.bench(|| Propagation::new(black_box(&system), black_box(&grid)));
}

#[divan::bench]
fn propagate_jittered(bencher: Bencher) {
    let (system, grid) = (arm(), jittered());
    bencher.bench(|| Propagation::new(black_box(&system), black_box(&grid)));
}

#[divan::bench(args = DISTURBANCES)]
fn input_gains(bencher: Bencher, disturbance: Disturbance) {
    let propagation = propagation(&uniform());
    bencher.bench(|| disturbance.input_gains(black_box(&propagation)));
}

#[divan::bench(args = [Disturbance::Sample, Disturbance::Measurable])]
fn input_gains_jittered(bencher: Bencher, disturbance: Disturbance) {
    let propagation = propagation(&jittered());
    bencher.bench(|| disturbance.input_gains(black_box(&propagation)));
}

#[divan::bench]
fn solve(bencher: Bencher) {
    let propagation = propagation(&uniform());
    let start = IntervalVector::from_element(12, Interval::point(0.1));
    let inputs = vec![0.3; 6 * SAMPLES];
    bencher.bench(|| propagation.solve(black_box(&start), black_box(&inputs)));
}

#[divan::bench]
fn reach_sets(bencher: Bencher) {
    let propagation = propagation(&uniform());
    let gains = Disturbance::Sample.input_gains(&propagation);
    let (initial, input) = sets();
    bencher.bench(|| ReachSets::new(black_box(&propagation), &gains, &initial, &input));
}

#[divan::bench]
fn tube_radii(bencher: Bencher) {
    let propagation = propagation(&uniform());
    let (initial, input) = sets();
    bencher
        .bench(|| StepRadii::new(black_box(&propagation), Disturbance::Constant, &initial, &input));
}

#[divan::bench]
fn tube(bencher: Bencher) {
    let propagation = propagation(&uniform());
    let (initial, input) = sets();
    let gains = Disturbance::Constant.input_gains(&propagation);
    let reach = ReachSets::new(&propagation, &gains, &initial, &input);
    let radii = StepRadii::new(&propagation, Disturbance::Constant, &initial, &input);
    let inputs = vec![0.3; 6 * SAMPLES];
    let nominal =
        propagation.solve(&IntervalVector::from_element(12, Interval::point(0.1)), &inputs);
    bencher.bench(|| {
        StepBounds::new(black_box(&propagation), &nominal, &inputs, &reach, &input, &radii)
    });
}

/// Measures the whole computation, from the model and its sets to the hulls at all samples, for
/// disturbances held over samples and for measurable ones.
#[divan::bench(args = [Disturbance::Sample, Disturbance::Measurable])]
fn linear_reachable_set(bencher: Bencher, disturbance: Disturbance) {
    let (system, grid, (initial, input)) = (arm(), uniform(), sets());
    bencher.bench(|| {
        let propagation =
            Propagation::new(black_box(&system), black_box(&grid)).expect("a short horizon");
        ReachSets::new(&propagation, &disturbance.input_gains(&propagation), &initial, &input)
    });
}
