//! The monitor beside `check`: the same rows, sample by sample, without allocation.

use std::path::Path;

use reachtube_arm::{ArmModel, Equations, InputCorrection, JointCorrection, OfArm};
use reachtube_conform::monitor::{HealthyMotion, Leave, Monitor, Schedule};
use reachtube_conform::settings::Centre;
use reachtube_conform::{Check, CheckJob, Error, Model, Result, Settings, Setup, Silent};
use reachtube_recordings::{DataSet, MemoryRuns, ReadOptions, Run, RunSource, SampleError, Torque};
use reachtube_robot::Robot;

use crate::common::{
    Disturbed, Random, Recorded, bent, conform_all, grid, read, read_with, setup, shared,
    write_data_set,
};

const STEP: f64 = 0.01;

/// A model of recordings of an arm without disturbance beyond small ones.
fn model(setup: Setup, correction: Option<InputCorrection>) -> Model {
    let folder = tempfile::tempdir().unwrap();
    let times = grid(STEP, 41);
    let quiet = Disturbed { robot: setup.robot(), times: &times, start: 1e-3, input: 0.02 };
    let mut random = Random(7);
    let runs: Vec<Recorded> = (0..6).map(|_| quiet.record(&mut random)).collect();
    write_data_set(folder.path(), &[("A", runs)]);
    let problem = read_with(setup, folder.path(), &[]);
    let found = conform_all(&problem);
    let mut model = Model::new(&problem, &found);
    let mut drive = model.arm();
    drive.correction = correction;
    model.drive = serde_json::to_value(drive).unwrap();
    // Its digest is made anew.
    reachtube_arm::parse(&model.to_json(), Path::new("model")).unwrap().0
}

/// Motions with disturbances that the sets do not cover.
fn faulty(robot: &Robot, samples: usize) -> Vec<Run> {
    let times = grid(STEP, samples);
    let faulty = Disturbed { robot, times: &times, start: 2e-3, input: 0.3 };
    let mut random = Random(11);
    let run = |Recorded { times, states, torques }| Run::new(2, times, states, torques).unwrap();
    (0..4).map(|_| run(faulty.record(&mut random))).collect()
}

/// Checks each run as a suite of its own.
fn check_alone(model: &Model, run: &Run) -> Check {
    let mut runs = MemoryRuns::default();
    runs.push("run", Some("alone"), None, run.clone());
    CheckJob::new(model.clone(), model.setup().unwrap(), runs).run(&Silent).unwrap()
}

fn monitor_of(model: &Model, schedule: Schedule) -> Result<Monitor> {
    Monitor::new(model, model.setup()?, schedule)
}

/// Pushes a run into a monitor, and returns what left the set.
fn replay(monitor: &mut Monitor, run: &Run) -> Vec<Leave> {
    let mut all = Vec::new();
    for (k, &time) in run.times.iter().enumerate() {
        all.extend_from_slice(monitor.push(time, run.q(k), run.qd(k), run.torque(k)).unwrap());
    }
    monitor.finish();
    all
}

/// Asserts that one window over a run has the rows of `check`, and returns how many do not hold.
fn assert_same(model: &Model, run: &Run, step: f64) -> usize {
    let check = check_alone(model, run);
    let verdict = &check.verdict;
    let horizon = step * (run.len() - 1) as f64;
    let schedule = Schedule { every: horizon, ..Schedule::with_horizon(horizon, step) };
    let mut monitor = monitor_of(model, schedule).unwrap();
    let mut leaves = replay(&mut monitor, run);
    let totals = monitor.totals();
    // A second window begins at the last sample.
    let states = verdict.rows / run.len();
    assert_eq!(
        [totals.samples, totals.windows, totals.outside],
        [run.len() as u64, 1, leaves.len() as u64]
    );
    // Where U grows with the motion, a window is judged at its end.
    let begun = if model.settings.input_doubling.is_some() { 0 } else { states };
    assert_eq!(totals.rows as usize, verdict.rows + begun);
    leaves.retain(|leave| leave.window == run.times[0]);
    assert_eq!(leaves.len(), verdict.violations.count);
    for worst in &check.worst_by_state {
        let of_state = leaves.iter().filter(|leave| leave.state == worst.state);
        let excess = of_state.map(|leave| leave.excess).fold(0.0, f64::max);
        assert_eq!(excess, worst.excess, "{}", worst.state);
    }
    assert_eq!(verdict.conformant, leaves.is_empty());
    assert!(leaves.iter().all(|leave| leave.proved || leave.excess < 1e-9));
    leaves.len()
}

#[test]
fn the_rows_are_those_of_a_check_whatever_the_input_is() {
    let robot = bent();
    let of = |torque| setup(&robot, |arm, _| arm.torque = torque);
    let by_robot = setup(&robot, |arm, _| {
        (arm.torque, arm.equations) = (Torque::Motor, Equations::Robot);
    });
    let growing = |torque| {
        setup(&robot, |arm, settings| {
            (arm.torque, arm.equations) = (torque, Equations::Robot);
            settings.input_doubling = Some(vec![0.7, 1.1]);
        })
    };
    let friction = JointCorrection { quadratic: 0.1, cubic: 0.02, ..Default::default() };
    let correction =
        InputCorrection { joints: vec![friction; 2], payload: 0.1, ..InputCorrection::default() };
    let models = [
        model(of(Torque::Compensated), None),
        model(of(Torque::Motor), None),
        model(of(Torque::Link), None),
        model(of(Torque::Compensated), Some(correction)),
        model(by_robot, None),
        model(growing(Torque::Motor), None),
        model(growing(Torque::Compensated), None),
    ];
    for (index, model) in models.iter().enumerate() {
        let outside: usize =
            faulty(&robot, 41).iter().map(|run| assert_same(model, run, STEP)).sum();
        assert!(outside > 0, "model {index}");
    }
}

#[test]
fn windows_overlap_and_each_says_first_that_it_is_left() {
    let robot = bent();
    let model = model(setup(&robot, |_, _| ()), None);
    let schedule = Schedule { every: 0.05, ..Schedule::with_horizon(0.2, STEP) };
    let mut monitor = monitor_of(&model, schedule).unwrap();
    assert_eq!(monitor.horizon(), 0.2);
    let run = &faulty(&robot, 81)[0];
    let leaves = replay(&mut monitor, run);
    // Windows begin at samples 0, 5, ..., 80; the last that ends began at 60.
    let totals = monitor.totals();
    assert_eq!((totals.samples, totals.windows), (81, 13));
    let first: Vec<f64> = leaves.iter().filter(|l| l.first).map(|l| l.window).collect();
    assert_eq!(first.len() as u64, totals.left);
    let mut distinct = first.clone();
    distinct.dedup();
    assert!(totals.left > 2 && distinct.len() == first.len());
    let begins = |window: &f64| (window / 0.05 - (window / 0.05).round()).abs() < 1e-9;
    assert!(first.iter().all(begins) && monitor.largest_used().iter().any(|used| *used > 1.0));
    // A window of its own tells what each of them tells.
    let begin = 10;
    let piece = run.len().min(begin + 21);
    let rows = |of: &[f64], n: usize| of[begin * n..piece * n].to_vec();
    let times = grid(STEP, 21);
    let alone = Run::new(2, times, rows(&run.states, 4), rows(&run.torques, 2)).unwrap();
    let count = check_alone(&model, &alone).verdict.violations.count;
    let of_window = leaves.iter().filter(|leave| (leave.window - 0.1).abs() < 1e-9);
    assert_eq!(of_window.count(), count);
}

/// Some of the motions as a source.
fn healthy(robot: &Robot, count: usize) -> MemoryRuns {
    let mut runs = MemoryRuns::default();
    for (index, run) in faulty(robot, 300).into_iter().take(count).enumerate() {
        runs.push(&format!("{index}"), None, None, run);
    }
    runs
}

#[test]
fn alarms_are_calibrated_by_healthy_motion_and_leave_the_windows_as_they_are() {
    let robot = bent();
    let model = model(setup(&robot, |_, _| ()), None);
    let schedule = Schedule::with_horizon(0.2, STEP);
    let learn =
        |count| HealthyMotion::learn(&model, model.setup()?, schedule, &healthy(&robot, count));
    assert!(matches!(learn(1), Err(Error::TooFewHealthy { count: 1 })));
    let known = learn(4).unwrap();
    assert_eq!((known.bound(), known.ranges().len()), (2.0 / 3.0, 5));
    assert!(known.ranges().iter().flatten().all(|[low, high]| low < high));
    // No joint feels a payload, because all turn about vertical axes.
    assert!(known.ranges()[..4].iter().all(Option::is_some), "{known:?}");
    for run in faulty(&robot, 300) {
        let mut alone = monitor_of(&model, schedule).unwrap();
        let mut watching = monitor_of(&model, schedule).unwrap();
        watching.watch(&known).unwrap();
        assert_eq!(replay(&mut alone, &run), replay(&mut watching, &run));
        // These motions are the healthy ones.
        assert_eq!(watching.totals(), alone.totals());
        assert_eq!(watching.used(), alone.used());
    }
    let other = known.ranges()[0].map_or(0.0, |[_, high]| high);
    assert!(other > 0.0, "{known:?}");
}

#[test]
fn samples_between_the_even_times_are_interpolated() {
    let robot = bent();
    let model = model(setup(&robot, |_, sets| sets.centre = Centre::Zero), None);
    let mut monitor = monitor_of(&model, Schedule::with_horizon(0.1, STEP)).unwrap();
    // At rest under no input, at times that jitter.
    for k in 0..100 {
        let time = 5.0 + STEP * f64::from(k) + 1e-3 * f64::from(k % 3);
        assert!(monitor.push(time, &[0.1; 2], &[0.0; 2], &[0.0; 2]).unwrap().is_empty());
    }
    assert!(monitor.totals().samples == 100 && monitor.totals().windows > 5);
    // It stays at the centre of the sets.
    let drift = monitor.drift();
    assert!(drift.len() == 4 && drift.iter().all(|drift| drift.abs() < 1e-9), "{drift:?}");
}

#[test]
fn the_gauge_leaves_out_the_first_sample_of_a_window_which_is_compared_all_the_same() {
    let robot = bent();
    let model = model(setup(&robot, |_, _| ()), None);
    // Pushes samples at rest; the least deviation at the start is `least`, in its radii.
    let rest = |least: f64| {
        let (radius, mut model) = (1e-9, model.clone());
        model.initial_set.radius.fill(radius);
        model.initial_set.centre.fill((1.0 + least) * radius);
        let model = reachtube_arm::parse(&model.to_json(), Path::new("model")).unwrap().0;
        let mut monitor = monitor_of(&model, Schedule::with_horizon(0.1, STEP)).unwrap();
        for k in 0..40 {
            monitor.push(STEP * f64::from(k), &[0.1; 2], &[0.0; 2], &[0.0; 2]).unwrap();
        }
        let used = monitor.largest_used().iter().copied().fold(0.0, f64::max);
        (used, monitor.totals())
    };
    // No deviation is at the edge of X0.
    let (used, totals) = rest(0.0);
    assert!(totals.windows > 5 && used < 0.9, "{used}");
    let (used, totals) = rest(1.0);
    assert!(totals.left > totals.windows && used < 0.9, "{used}");
}

#[test]
fn a_sample_that_cannot_be_used_is_refused_and_changes_nothing() {
    let robot = bent();
    let model = model(setup(&robot, |_, _| ()), None);
    let mut monitor = monitor_of(&model, Schedule::with_horizon(0.1, STEP)).unwrap();
    let zeros = [0.0; 2];
    monitor.push(1.0, &zeros, &zeros, &zeros).unwrap();
    let mut refused =
        |time: f64, q: &[f64], tau: &[f64]| monitor.push(time, q, &zeros, tau).unwrap_err();
    let count = refused(1.01, &[0.0; 3], &zeros);
    assert_eq!(count, SampleError::Count { what: "positions", given: 3, needed: 2 });
    let text = refused(1.01, &zeros, &[0.0, f64::NAN]).to_string();
    assert_eq!(text, "tau2 is NaN; give finite numbers, or leave the sample out");
    assert!(matches!(refused(f64::INFINITY, &zeros, &zeros), SampleError::NotFinite { .. }));
    assert!(matches!(refused(1.0, &zeros, &zeros), SampleError::Order { .. }));
    assert!(matches!(refused(1.02, &zeros, &zeros), SampleError::Gap { .. }));
    assert!(monitor.push(1.01, &zeros, &zeros, &zeros).unwrap().is_empty());
    assert_eq!(monitor.totals().samples, 2);
    // After an end, any time may follow.
    monitor.finish();
    assert!(monitor.push(0.0, &zeros, &zeros, &zeros).unwrap().is_empty());
    let impossible = [
        Schedule { every: 0.2, ..Schedule::with_horizon(0.1, STEP) },
        Schedule::with_horizon(0.001, STEP),
        Schedule::with_horizon(0.1, f64::NAN),
    ];
    for schedule in impossible {
        monitor_of(&model, schedule).unwrap_err();
    }
}

#[test]
fn a_sample_allocates_nothing() {
    let robot = bent();
    for torque in [Torque::Compensated, Torque::Motor, Torque::Link] {
        let own = setup(&robot, |arm, _| (arm.torque, arm.equations) = (torque, Equations::Robot));
        let friction = JointCorrection { quadratic: 0.1, ..Default::default() };
        let correction = InputCorrection {
            joints: vec![friction; 2],
            payload: 0.1,
            ..InputCorrection::default()
        };
        let model = model(own, Some(correction));
        let schedule = Schedule::with_horizon(0.2, STEP);
        let mut monitor = monitor_of(&model, schedule).unwrap();
        let (setup, healthy) = (model.setup().unwrap(), healthy(&robot, 4));
        let healthy = HealthyMotion::learn(&model, setup, schedule, &healthy).unwrap();
        monitor.watch(&healthy).unwrap();
        let run = &faulty(&robot, 100)[0];
        let mut outside = 0;
        let allocations = allocation_counter::measure(|| {
            for (k, &time) in run.times.iter().enumerate() {
                let left = monitor.push(time, run.q(k), run.qd(k), run.torque(k));
                outside += left.map_or(0, <[Leave]>::len);
            }
        });
        assert_eq!(allocations.count_total, 0, "{torque:?}");
        assert!(outside > 0 && monitor.totals().windows > 0);
    }
}

/// Runs of the suites D and E, which were held out, one by one.
#[test]
#[ignore = "needs the recordings in ../shared"]
fn replayed_schunk_recordings_have_the_verdicts_of_a_check() {
    let folder = shared("schunk_lwa4p");
    let problem = read(&Robot::lwa4p(), &folder, &["A", "B"], &Settings::default());
    let found = conform_all(&problem);
    let model = Model::new(&problem, &found);
    let data = DataSet::open(&folder).unwrap();
    let options = ReadOptions::of(6);
    let (suites, mut left) = (data.suites(), [0; 2]);
    for (name, left) in ["D", "E"].into_iter().zip(&mut left) {
        let suite = suites.iter().find(|suite| suite.name == name).unwrap();
        for &run in &suite.runs {
            let run = data.read(run, &options).unwrap();
            *left += usize::from(assert_same(&model, &run, 0.004) > 0);
        }
    }
    assert!(left.iter().sum::<usize>() > 0, "{left:?}");
}
