//! Robots whose friction depends on the run or on the temperature of the joints.

use crate::common::{Disturbed, Random, conform_all, grid, setup, step, two_joints};
use nalgebra::DVector;
use reachtube_abstraction::{ExpansionPoint, linear_model};
use reachtube_conform::{Keep, Model, Problem, Silent};
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::Robot;
use reachtube_robot::friction::{Warming, WarmingBy};

const SAMPLES: usize = 100;
const RUNS: u64 = 6;

/// The robot with a law of warming for both joints.
fn warming(by: WarmingBy) -> Robot {
    let mut description = two_joints().description().clone();
    let (reference, viscous) = match by {
        WarmingBy::Temperature => (25.0, 0.03),
        _ => (1.0, 0.3),
    };
    let law = Warming { by, reference, viscous, ..Warming::default() };
    description.joints.iter_mut().for_each(|joint| joint.friction.warming = Some(law));
    Robot::from_description(&description).unwrap()
}

fn temperatures(place: u64) -> Vec<f64> {
    vec![20.0 + 2.0 * place as f64, 22.0 + place as f64]
}

/// Runs of a robot that is as warm as its law says, or of one that is warm in another order.
fn record(robot: &Robot, order: impl Fn(u64) -> u64) -> MemoryRuns {
    let (times, mut random) = (grid(0.01, SAMPLES), Random(3));
    let mut runs = MemoryRuns::default();
    for place in 1..=RUNS {
        let warm = robot.at_run(place as f64).at_temperature(&temperatures(place));
        let system = linear_model(&warm, &ExpansionPoint::zero(2)).unwrap();
        let mut x = DVector::from_fn(4, |_, _| 1e-4 * random.signed());
        let (mut states, mut torques) = (Vec::new(), Vec::new());
        for &t in &times {
            let u = DVector::from_fn(2, |j, _| 2.0 * (4.0 * t + j as f64).sin());
            states.extend(x.iter());
            torques.extend(u.iter());
            x = step(&system, 0.01, &x, &u.map(|u| u + 0.01 * random.signed()));
        }
        let run = Run::new(2, times.clone(), states, torques).unwrap();
        let told = order(place);
        let all = temperatures(told).repeat(SAMPLES);
        let run = run.with_temperatures(all).unwrap();
        runs.push(&format!("run{place}"), Some("A"), None, run).order = told;
    }
    runs
}

fn problem(robot: &Robot, runs: MemoryRuns) -> Problem {
    Problem::read(setup(robot, |_, _| ()), Box::new(runs), &[], Keep::Needed, &Silent).unwrap()
}

#[test]
fn each_run_has_the_friction_of_its_order_or_temperature() {
    for by in [WarmingBy::Runs, WarmingBy::Temperature] {
        let robot = warming(by);
        let known = problem(&robot, record(&robot, |place| place));
        let found = conform_all(&known);
        assert!(found.verdict.conformant);
        // In the wrong order, or with temperatures of other runs, the sets are larger.
        let wrong = problem(&robot, record(&robot, |place| RUNS + 1 - place));
        let wrong = conform_all(&wrong);
        assert!(wrong.cost > 2.0 * found.cost, "{by:?}: {} for {}", wrong.cost, found.cost);
        // If the run is unknown, one nominal motion serves all of them.
        let any = found.any_run.clone().unwrap();
        assert!(any.verified && any.cost > 1.5 * found.cost && any.cost < wrong.cost, "{any:?}");
        // The file says both.
        let model = Model::new(&known, &found);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.json");
        std::fs::write(&path, model.to_json()).unwrap();
        assert_eq!(reachtube_arm::open(&path).unwrap().0.any_run.unwrap(), any);
    }
}

#[test]
fn a_temperature_that_was_not_recorded_is_remarked() {
    let robot = warming(WarmingBy::Temperature);
    let mut runs = MemoryRuns::default();
    let run = Run::new(2, vec![0.0, 0.01], vec![0.0; 8], vec![0.0; 4]).unwrap();
    runs.push("cold", Some("A"), None, run);
    let notes = problem(&robot, runs).recordings().notes.join("\n");
    assert!(notes.contains("1 of the 1 recordings have no columns temp1"), "{notes}");
}

#[test]
fn a_robot_that_does_not_warm_has_no_sets_for_any_run() {
    let robot = two_joints();
    let found = conform_all(&problem(&robot, record(&robot, |place| place)));
    assert!(found.any_run.is_none());
}

#[test]
fn the_sets_for_any_run_take_all_friction_in_one_condition() {
    let robot_with = |coulomb: f64, warming| {
        let mut description = two_joints().description().clone();
        for joint in &mut description.joints {
            let f = coulomb;
            joint.friction.coulomb = [f, 0.0, -f, 0.0, -f, 0.0, f, 0.0];
            joint.friction.warming = warming;
        }
        Robot::from_description(&description).unwrap()
    };
    let law = Warming { by: WarmingBy::Runs, reference: 1.0, coulomb: 0.3, ..Warming::default() };
    // Each run is a suite of its own, at the first and at the ninth place: the third is the middle.
    let times = grid(0.01, SAMPLES);
    let disturbed =
        Disturbed { robot: &robot_with(0.0, None), times: &times, start: 1e-4, input: 0.01 };
    let recorded: Vec<_> =
        [3, 4].into_iter().map(|seed| disturbed.record(&mut Random(seed))).collect();
    let conformed = |robot: Robot| {
        let mut runs = MemoryRuns::default();
        for (place, run) in [1, 9].into_iter().zip(recorded.clone()) {
            let run = Run::new(2, run.times, run.states, run.torques).unwrap();
            runs.push(&format!("run{place}"), Some(&format!("S{place}")), None, run).order = place;
        }
        let setup = setup(&robot, |arm, _| arm.torque = Torque::Motor);
        let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap();
        conform_all(&problem)
    };
    let any = conformed(robot_with(1.0, Some(law))).any_run.unwrap();
    assert_eq!(any.condition.place, 3);
    let third = conformed(robot_with(law.factors(3.0)[0], None));
    assert!((any.cost - third.cost).abs() < 1e-6 * third.cost, "{} {}", any.cost, third.cost);
}
