//! Folding of recordings: a part of 1000 runs of 5 s at 250 Hz, its bytes, and the merge of parts.

use divan::Bencher;
use reachtube_arm::ArmSettings;
use reachtube_conform::fleet::Fold;
use reachtube_conform::{Settings, Setup};
use reachtube_recordings::{MemoryRuns, ReadOptions, Run, RunSource, Torque};
use reachtube_robot::Robot;

const SAMPLES: usize = 1250;
const JOINTS: usize = 6;

fn main() {
    divan::main();
}

fn setup() -> Setup {
    let arm = ArmSettings::new(Torque::Compensated, JOINTS);
    reachtube_arm::setup(Robot::lwa4p(), arm, Settings::default()).unwrap()
}

/// Runs of one suite, each with scatter of its own.
fn runs(count: usize) -> MemoryRuns {
    let mut runs = MemoryRuns::default();
    let times: Vec<f64> = (0..SAMPLES).map(|k| 0.004 * k as f64).collect();
    for index in 0..count {
        let scatter = |at: usize| 1e-3 * ((at * 31 + index * 17) as f64).sin();
        let states = (0..SAMPLES * 2 * JOINTS).map(scatter).collect();
        let run = Run::new(JOINTS, times.clone(), states, vec![0.0; SAMPLES * JOINTS]).unwrap();
        runs.push(&format!("fleet/robot-17/run-{index:07}.csv"), Some("A"), Some("M"), run);
    }
    runs
}

fn part(setup: &Setup, runs: &MemoryRuns, first: u64) -> Fold {
    let mut fold = Fold::new(setup).unwrap();
    fold.take_source(runs, first).unwrap();
    fold
}

/// The runs are in memory already.
#[divan::bench(sample_count = 5)]
fn fold_of_1000_runs_on_all_cores(bencher: Bencher) {
    let (setup, runs) = (setup(), runs(1000));
    bencher.bench(|| part(&setup, &runs, 0));
}

#[divan::bench(sample_count = 5)]
fn fold_of_1000_runs_on_one_core(bencher: Bencher) {
    let (setup, runs) = (setup(), runs(1000));
    bencher.bench(|| {
        let mut fold = Fold::new(&setup).unwrap();
        for (index, entry) in runs.runs().iter().enumerate() {
            fold.take(index as u64, entry, runs.read(index, &ReadOptions::default())).unwrap();
        }
        fold
    });
}

#[divan::bench(sample_count = 5)]
fn to_bytes_and_back(bencher: Bencher) {
    let setup = setup();
    let fold = part(&setup, &runs(1000), 0);
    println!("{} bytes", fold.to_bytes().len());
    bencher.bench(|| Fold::from_bytes(&setup, &fold.to_bytes()).unwrap());
}

#[divan::bench(sample_count = 5)]
fn merge_of_two_parts(bencher: Bencher) {
    let setup = setup();
    let runs = runs(1000);
    let (first, second) = (part(&setup, &runs, 0), part(&setup, &runs, 1000));
    bencher.with_inputs(|| (first.clone(), second.clone())).bench_values(|(mut first, second)| {
        first.merge(second).unwrap();
        first
    });
}
