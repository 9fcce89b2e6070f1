//! Conformance at the paper's size: 152 suites x 15 runs x 5 s at 250 Hz of a 6-joint arm.

use divan::counter::BytesCount;
use divan::{Bencher, black_box};
use rayon::prelude::*;
use reachtube_abstraction::{ExpansionPoint, linear_model};
use reachtube_arm::{ArmSettings, setup};
use reachtube_conform::data::Envelope;
use reachtube_conform::{
    Check, Keep, Model, Problem, Settings, Silent, Tube, check, conform, reach,
};
use reachtube_reach::{Disturbance, Propagation, TimeGrid};
use reachtube_recordings::{DataSet, Torque};
use reachtube_robot::Robot;

const SAMPLES: usize = 1251;
const STATES: usize = 12;
const RUNS: usize = 152 * 15;

fn main() {
    divan::main();
}

/// Deviations like a drifting arm's: a smooth growth of its own in each run and state, with some
/// noise.
fn deviations(run: usize) -> Vec<f64> {
    let mut noise = 0x9E37_79B9_7F4A_7C15u64.wrapping_mul(run as u64 + 1);
    let mut random = move || {
        noise ^= noise << 13;
        noise ^= noise >> 7;
        noise ^= noise << 17;
        (noise >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let rates: Vec<f64> = (0..STATES).map(|_| random()).collect();
    (0..SAMPLES * STATES)
        .map(|at| {
            let (t, i) = ((at / STATES) as f64 * 0.004, at % STATES);
            let growth =
                if i < 6 { 0.002 + 0.1 * t } else { 0.01 + 0.1 * (1.0 - (-5.0 * t).exp()) };
            growth * (rates[i] + 0.05 * random())
        })
        .collect()
}

fn recordings() -> Vec<Vec<f64>> {
    (0..RUNS).map(deviations).collect()
}

#[divan::bench(sample_count = 10)]
fn envelope_of_2280_runs(bencher: Bencher) {
    let runs = recordings();
    let bytes = runs.iter().map(|run| run.len() * 8).sum::<usize>();
    bencher.counter(BytesCount::new(bytes)).bench(|| {
        let mut envelope = Envelope::new(STATES);
        runs.iter()
            .enumerate()
            .for_each(|(run, states)| envelope.include(run as u32, black_box(states)));
        envelope
    });
}

/// The same with one envelope a core, merged: how recordings are read.
#[divan::bench(sample_count = 10)]
fn envelope_of_2280_runs_on_all_cores(bencher: Bencher) {
    let runs = recordings();
    let bytes = runs.iter().map(|run| run.len() * 8).sum::<usize>();
    let part = RUNS.div_ceil(rayon::current_num_threads());
    bencher.counter(BytesCount::new(bytes)).bench(|| {
        let envelope_of = |(at, runs): (usize, &[Vec<f64>])| {
            let mut envelope = Envelope::new(STATES);
            runs.iter()
                .enumerate()
                .for_each(|(run, states)| envelope.include((at * part + run) as u32, states));
            envelope
        };
        let merge = |mut a: Envelope, b: Envelope| {
            a.merge(&b);
            a
        };
        runs.par_chunks(part).enumerate().map(envelope_of).reduce_with(merge)
    });
}

/// The same bytes read and added up: what the envelope is measured against.
#[divan::bench(sample_count = 10)]
fn reading_2280_runs(bencher: Bencher) {
    let runs = recordings();
    let bytes = runs.iter().map(|run| run.len() * 8).sum::<usize>();
    bencher.counter(BytesCount::new(bytes)).bench(|| {
        let mut sums = [0.0; 8];
        for run in &runs {
            for chunk in black_box(run).chunks_exact(8) {
                sums.iter_mut().zip(chunk).for_each(|(sum, x)| *sum += x);
            }
        }
        sums
    });
}

/// e^{At}, Γ(t) and κ(t) of one grid.
#[divan::bench(sample_count = 10)]
fn matrices_of_5_s(bencher: Bencher) {
    let system = linear_model(&Robot::lwa4p(), &ExpansionPoint::zero(6)).unwrap();
    let grid = TimeGrid::uniform(0.004, SAMPLES);
    bencher.bench(|| {
        let propagation = Propagation::new(&system, &grid).unwrap();
        let input_gains = Disturbance::Sample.input_gains(&propagation);
        (propagation, input_gains)
    });
}

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/schunk_lwa4p");

/// Reads all suites of the paper's arm, where its recordings are beside the repository.
fn schunk(keep: Keep) -> Option<Problem> {
    let source = Box::new(DataSet::open(FOLDER).ok()?);
    let arm = ArmSettings::new(Torque::Compensated, 6);
    let setup = setup(Robot::lwa4p(), arm, Settings::default()).unwrap();
    Some(Problem::read(setup, source, &[], keep, &Silent).unwrap())
}

/// Reading and the sets.
#[divan::bench(sample_count = 10)]
fn conform_schunk(bencher: Bencher) {
    if schunk(Keep::Needed).is_none() {
        println!("skipped: {FOLDER} does not exist");
        return;
    }
    bencher.bench(|| conform(&schunk(Keep::Needed).unwrap(), &Silent, None).unwrap());
}

/// What `conform --report` computes for its page: everything from one problem.
#[divan::bench(sample_count = 10)]
fn conform_and_page_from_one_problem(bencher: Bencher) {
    if schunk(Keep::All).is_none() {
        return;
    }
    bencher.bench(|| {
        let problem = schunk(Keep::All).unwrap();
        let found = conform(&problem, &Silent, None).unwrap();
        let model = Model::new(&problem, &found);
        let answer = Check::new(&model, &problem, found.verdict.clone());
        (answer, reach(&problem, &found.tube).unwrap())
    });
}

/// The same with a problem for each step, as it was when steps took a folder and settings.
#[divan::bench(sample_count = 10)]
fn conform_and_page_from_three_problems(bencher: Bencher) {
    if schunk(Keep::All).is_none() {
        return;
    }
    bencher.bench(|| {
        let problem = schunk(Keep::Needed).unwrap();
        let found = conform(&problem, &Silent, None).unwrap();
        let model = Model::new(&problem, &found);
        let problem = schunk(Keep::Needed).unwrap();
        let tube = Tube::new(&problem, model.sets()).unwrap();
        let answer = check(&model, &problem, &tube).unwrap();
        let problem = schunk(Keep::All).unwrap();
        let tube = Tube::new(&problem, model.sets()).unwrap();
        (answer, reach(&problem, &tube).unwrap())
    });
}
