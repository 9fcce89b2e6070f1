//! Motions that start where the samples before them tell.

use crate::common::{grid, setup};
use reachtube_arm::{ArmModel, Equations};
use reachtube_conform::monitor::{Monitor, Schedule};
use reachtube_conform::settings::NominalStart;
use reachtube_conform::{Answer, Check, CheckJob, Job, Result, Silent};
use reachtube_recordings::{MemoryRuns, Run, SampleError};
use reachtube_robot::Robot;

/// Where each motion starts, rad, and its constant velocity, rad/s.
const START: [f64; 2] = [0.2, -0.5];

const STEP: f64 = 0.004;

/// Six joints at a constant velocity, of which the samples before tell the start up to an error,
/// rad and rad/s.
fn run([q, qd]: [f64; 2]) -> Run {
    let times = grid(STEP, 60);
    let state = |t: &f64| [[START[0] + START[1] * t; 6], [START[1]; 6]].concat();
    let states = times.iter().flat_map(state).collect();
    let torques = vec![0.0; 6 * times.len()];
    let told = [[START[0] - q; 6], [START[1] - qd; 6], [0.0; 6]].concat();
    Run { before: told, ..Run::new(6, times, states, torques).unwrap() }
}

fn runs(all: Vec<Run>) -> MemoryRuns {
    let mut recordings = MemoryRuns::default();
    for (index, run) in all.into_iter().enumerate() {
        let name = format!("run{index}");
        recordings.push(&name, Some(&name), Some(&name), run);
    }
    recordings
}

fn answer(all: Vec<Run>) -> Result<Answer> {
    let setup = setup(&Robot::lwa4p(), |arm, settings| {
        arm.equations = Equations::Velocity;
        settings.sensor_noise = Some(vec![1e-9; 12]);
        settings.nominal = NominalStart::Past;
    });
    Job::new(setup, runs(all)).run(&Silent)
}

/// Motions with both signs of an error of 0.01 rad and 0.1 rad/s.
fn known() -> Answer {
    answer(vec![run([0.01, 0.1]), run([-0.01, -0.1])]).unwrap()
}

fn check(answer: &Answer, error: [f64; 2]) -> Check {
    let model = answer.model.clone();
    let setup = model.setup().unwrap();
    CheckJob::new(model, setup, runs(vec![run(error)])).run(&Silent).unwrap()
}

#[test]
fn the_error_of_the_start_is_in_its_set_and_nowhere_else() {
    let answer = known();
    assert!(answer.holds());
    let [initial, input] = [&answer.model.initial_set, &answer.model.input_set];
    for joint in 0..6 {
        let radii = [initial.radius[joint], initial.radius[6 + joint], input.radius[joint]];
        for (radius, known) in radii.iter().zip([0.01, 0.1, 0.0]) {
            assert!((radius - known).abs() < 1e-5, "{radii:?}");
        }
    }
    // The model file has the kind of the start, and no nominal start of a suite.
    assert_eq!(answer.model.settings.nominal, NominalStart::Past);
    assert!(answer.model.data.suites.iter().all(|suite| suite.nominal_start.is_none()));
}

#[test]
fn other_motions_are_compared_from_where_they_are_told_to_start() {
    let answer = known();
    assert!(check(&answer, [0.009, -0.09]).holds());
    // X0 grows in the state that needs it, and U does not: the sets become wider by that.
    let end = STEP * 59.0;
    for [q, qd] in [[0.02, 0.1], [0.01, -0.2], [-0.03, 0.0]] {
        let outside = check(&answer, [q, qd]);
        assert!(!outside.holds());
        let wider = (q.abs().max(0.01) + end * qd.abs().max(0.1)) / (0.01 + end * 0.1);
        let parts = outside.growth.unwrap().parts;
        assert!(parts.iter().all(|part| (part.unwrap() - wider).abs() < 1e-4), "{parts:?}");
    }
}

#[test]
fn a_recording_without_samples_before_it_is_refused() {
    let unknown = Run { before: Vec::new(), ..run([0.0; 2]) };
    let refused = answer(vec![run([0.01, 0.1]), unknown]).unwrap_err().to_string();
    assert!(refused.contains("run1") && refused.contains("none before"), "{refused}");
}

#[test]
fn a_monitor_starts_its_windows_where_it_is_told() {
    let answer = known();
    let model = &answer.model;
    let left = |error: [f64; 2]| {
        let schedule = Schedule::new(model, STEP);
        let mut monitor = Monitor::new(model, model.setup().unwrap(), schedule).unwrap();
        let run = run(error);
        for (k, time) in run.times.iter().enumerate() {
            let told: Vec<f64> = (0..12)
                .map(|i| run.state(k)[i] - if i < 6 { error[0] } else { error[1] })
                .collect();
            let sample = (run.q(k), run.qd(k), run.torque(k));
            if k == 0 {
                let early = monitor.push(*time, sample.0, sample.1, sample.2).unwrap_err();
                assert_eq!(early, SampleError::NotTold);
            }
            monitor.tell(&told);
            monitor.push(*time, sample.0, sample.1, sample.2).unwrap();
        }
        monitor.totals().outside
    };
    assert_eq!(left([0.009, -0.09]), 0);
    assert!(left([0.02, 0.0]) > 0);
}
