//! Models that know neither the robot nor its torque, and models without motors.

use crate::common::{bent, grid, setup};
use reachtube_arm::{ArmModel, Equations};
use reachtube_conform::monitor::{Monitor, Schedule};
use reachtube_conform::settings::NominalStart;
use reachtube_conform::{Answer, CheckJob, Job, Noise, Silent};
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::{JointDescription, Robot};

/// Six joints from the same start; the acceleration of all of them is what `motion` says at a time:
/// the distance that it leads to, and the velocity.
fn run(before: f64, motion: impl Fn(f64) -> [f64; 2]) -> Run {
    let times = grid(0.004, 60);
    let [start, speed] = [0.2, -0.5];
    let state = |t: &f64| {
        let [moved, faster] = motion(*t);
        [[start + speed * t + moved; 6], [speed + faster; 6]].concat()
    };
    let states = times.iter().flat_map(state).collect();
    let count = times.len();
    let run = Run::new(6, times, states, vec![17.0; 6 * count]).unwrap();
    Run { before: [vec![0.0; 12], vec![before; 6]].concat(), ..run }
}

fn answer(equations: Equations, runs: Vec<Run>) -> Answer {
    let mut recordings = MemoryRuns::default();
    for (index, run) in runs.into_iter().enumerate() {
        let name = format!("run{index}");
        recordings.push(&name, Some(&name), Some(&name), run);
    }
    let setup = setup(&Robot::lwa4p(), |arm, settings| {
        arm.equations = equations;
        settings.noise = Noise::Fitted;
        settings.sensor_noise = Some(vec![1e-9; 12]);
        settings.nominal = NominalStart::Own;
    });
    Job::new(setup, recordings).run(&Silent).unwrap()
}

#[test]
fn the_least_box_of_accelerations_is_found() {
    let constant = |a: f64| run(0.0, move |t| [0.5 * a * t * t, a * t]);
    let answer = answer(Equations::Velocity, vec![constant(-1.0), constant(2.0), constant(0.3)]);
    assert!(answer.holds());
    for joint in 0..6 {
        let (low, high) = answer.model.input_set.bounds(joint);
        assert!((low + 1.0).abs() < 1e-4 && (high - 2.0).abs() < 1e-4, "[{low}, {high}]");
        assert_eq!(answer.model.signals.inputs[joint].unit, "rad/s²");
    }
    // A check of a motion within and of one beyond, with the model as its file has it.
    let model = &answer.model;
    let outside = |a: f64| {
        let mut other = MemoryRuns::default();
        other.push("other", Some("other"), Some("other"), constant(a));
        let setup = model.setup().unwrap();
        let check = CheckJob::new(model.clone(), setup, other).run(&Silent).unwrap();
        check.verdict.violations.count
    };
    assert_eq!(outside(1.9), 0);
    assert!(outside(2.2) > 0);
}

#[test]
fn an_acceleration_that_dies_out_leaves_hardly_any() {
    let decaying = |a: f64| {
        let decay: f64 = 0.2;
        run(a, move |t| {
            let left = (-t / decay).exp();
            [a * decay * (t - decay * (1.0 - left)), a * decay * (1.0 - left)]
        })
    };
    let motions = || vec![decaying(-1.0), decaying(2.0)];
    let radius = |equations| answer(equations, motions()).model.input_set.radius[0];
    let [decaying, velocity] = [Equations::Decaying, Equations::Velocity].map(radius);
    // Inputs are held from each sample to the next: 2 % of the acceleration at the start.
    assert!(decaying < 0.025 && velocity > 0.9, "{decaying} {velocity}");
    let held = |a: f64| run(a, move |t| [0.5 * a * t * t, a * t]);
    let held = answer(Equations::Held, vec![held(-1.0), held(2.0)]);
    assert!(held.model.input_set.radius[0] < 1e-4);
}

#[test]
fn a_monitor_needs_a_start_without_acceleration() {
    let still = || run(0.0, |_| [0.0; 2]);
    let monitor = |equations| {
        let model = answer(equations, vec![still(), still()]).model;
        let setup = model.setup().unwrap();
        Monitor::new(&model, setup, Schedule::new(&model, 0.004)).map(|_| ())
    };
    monitor(Equations::Velocity).unwrap();
    let refused = monitor(Equations::Held).unwrap_err().to_string();
    assert!(refused.contains("acceleration at the start"), "{refused}");
}

/// Two joints under torques that are measured behind the gears, moved by no law at all.
fn behind_the_gears(change: impl Fn(&mut JointDescription)) -> Answer {
    let mut description = bent().description().clone();
    description.joints.iter_mut().for_each(change);
    let robot = Robot::from_description(&description).unwrap();
    let times = grid(0.004, 60);
    let mut runs = MemoryRuns::default();
    for (name, pace) in [("slow", 3.0), ("fast", 4.0)] {
        let state = |t: &f64| {
            let (sin, cos) = (pace * t).sin_cos();
            [0.3 * sin, 0.2 * cos, 0.3 * pace * cos, -0.2 * pace * sin]
        };
        let states = times.iter().flat_map(state).collect();
        let torque = |t: &f64| [4.0 * (pace * t).cos(), 1.0 - pace * t];
        let torques = times.iter().flat_map(torque).collect();
        let run = Run::new(2, times.clone(), states, torques).unwrap();
        runs.push(name, Some(name), Some(name), run);
    }
    let setup = setup(&robot, |arm, _| {
        (arm.torque, arm.equations) = (Torque::Link, Equations::Robot);
    });
    Job::new(setup, runs).run(&Silent).unwrap()
}

#[test]
fn motors_behind_the_gears_change_no_digit_of_the_sets() {
    let sets = |change: fn(&mut JointDescription)| {
        let model = behind_the_gears(change).model;
        (model.initial_set, model.input_set, model.settings)
    };
    let without = sets(|joint| joint.armature = None);
    assert_eq!(sets(|joint| joint.armature = Some(20.0)), without);
    assert_eq!(sets(|joint| joint.armature = Some(0.3)), without);
    let geared = sets(|joint| {
        (joint.armature, joint.gear_ratio) = (None, Some(160.0));
        joint.rotor_inertia = Some(1e-3);
    });
    assert_eq!(geared, without);
}
