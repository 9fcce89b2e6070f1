//! Nominal motions that satisfy the robot's own equations.

use std::path::Path;

use crate::common::{Random, bent, conform_all, grid, setup};
use reachtube_abstraction::{Abstraction, ModelKind};
use reachtube_arm::{ArmSettings, Equations, OfArm};
use reachtube_conform::settings::Method;
use reachtube_conform::{
    Conformance, Error, FitSettings, Group, Keep, Model, Problem, Settings, Silent, check, fit,
    reach,
};
use reachtube_finding::FrontEnd;
use reachtube_ode::{DormandPrince, InitialValueProblem as Simulated, Tolerance};
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::{DrivenBy, Parameter, ParameterKind, Robot, RobotField};

const SAMPLES: usize = 250;

/// Runs of `real`, two motions of three runs, with the inputs that were asked of it; `error` is the
/// radius of the error of the inputs, N m.
fn recorded(real: &Robot, error: f64) -> MemoryRuns {
    let (times, n) = (grid(0.004, SAMPLES), real.joint_count());
    let (mut runs, mut random) = (MemoryRuns::default(), Random(3));
    for motion in 0..2 {
        let name = format!("motion{motion}");
        for run in 0..3 {
            let pace = 3.0 + f64::from(motion);
            let input = |&t: &f64| (0..n).map(move |j| 4.0 * (pace * t + j as f64).cos());
            let asked: Vec<f64> = times.iter().flat_map(input).collect();
            let had: Vec<f64> = asked.iter().map(|u| u + error * random.signed()).collect();
            // The elbow is bent by 1 rad, so that the inertia is not that at q = 0.
            let start: Vec<f64> = (0..2 * n).map(|i| if i == 1 { 1.0 } else { 0.0 }).collect();
            let states = simulated(real, &start, &times, &had);
            let run_name = format!("{name}_{run}");
            let run = Run::new(n, times.clone(), states, asked).unwrap();
            runs.push(&run_name, Some(&name), Some(&name), run);
        }
    }
    runs
}

/// The motion of a robot under inputs that are held from each sample to the next, samples x 2n.
fn simulated(robot: &Robot, start: &[f64], times: &[f64], inputs: &[f64]) -> Vec<f64> {
    let mut field = RobotField::new(robot, DrivenBy::Input);
    let mut solver = DormandPrince::new(start.len(), Tolerance::default());
    let mut states = Vec::new();
    let inputs = &inputs[..inputs.len() - robot.joint_count()];
    let run = Simulated { start, inputs };
    let outcome = solver.simulate(&mut field, times, run, |_, x| states.extend_from_slice(x));
    assert!(outcome.is_reached());
    states
}

fn problem(robot: Robot, runs: MemoryRuns, equations: Equations) -> Problem {
    let setup = setup(&robot, |arm, _| arm.equations = equations);
    Problem::read(setup, Box::new(runs), &[], Keep::All, &Silent).unwrap()
}

#[test]
fn the_nominal_motion_is_that_of_the_robot_and_the_sets_hold_what_is_left() {
    let robot = bent();
    let found = |equations| {
        let problem = problem(robot.clone(), recorded(&robot, 0.05), equations);
        let found = conform_all(&problem);
        assert!(found.verdict.conformant, "{equations:?}");
        (problem, found)
    };
    let (_, by_model) = found(Equations::Model);
    let (problem, by_robot): (Problem, Conformance) = found(Equations::Robot);
    assert!(by_robot.cost < 0.2 * by_model.cost, "{} {}", by_robot.cost, by_model.cost);
    assert!(by_robot.sets.input_set.radius.iter().all(|radius| *radius < 0.3));
    let parts: Vec<f64> = by_robot.nominal_explains.iter().flatten().copied().collect();
    assert!(parts.len() == 4 && parts.iter().all(|part| *part > 0.99), "{parts:?}");

    // The file of the model says so, and checks as the model did.
    let model = Model::new(&problem, &by_robot);
    let (model, setup) = reachtube_arm::parse(&model.to_json(), Path::new("model.json")).unwrap();
    assert_eq!(setup.arm().settings.equations, Equations::Robot);
    let again = problem.with_setup(setup);
    let answer = check(&model, &again, &by_robot.tube).unwrap();
    assert!(answer.verdict.conformant);

    // The nominal motion, by another way: the robot under the recorded inputs, integrated.
    let times = grid(0.004, SAMPLES);
    let reached = reach(&problem, &by_robot.tube).unwrap();
    assert_eq!(reached.len(), 2);
    for (suite, pace) in reached.iter().zip([3.0f64, 4.0]) {
        let input = |&t: &f64| (0..2).map(move |j| 4.0 * (pace * t + f64::from(j)).cos());
        let inputs: Vec<f64> = times.iter().flat_map(input).collect();
        let expected = simulated(&robot, &[0.0, 1.0, 0.0, 0.0], &times, &inputs);
        assert_eq!(suite.nominal.len(), expected.len());
        let apart = suite.nominal.iter().zip(&expected).map(|(a, b)| (a - b).abs());
        let furthest = apart.max_by(f64::total_cmp).unwrap();
        assert!(furthest < 0.01, "{}: {furthest}", suite.suite);
    }
}

#[test]
fn a_robot_whose_equations_are_the_model_gives_the_same_sets() {
    // One joint: its inertia is the same everywhere, and its friction is linear.
    let mut description = bent().description().clone();
    description.joints.truncate(1);
    description.joints[0].friction.viscous = [2.0, 0.0, 0.0];
    let robot = Robot::from_description(&description).unwrap();
    let cost =
        |equations| conform_all(&problem(robot.clone(), recorded_of_one(&robot), equations)).cost;
    let [by_model, by_robot] = [Equations::Model, Equations::Robot].map(cost);
    assert!((by_robot / by_model - 1.0).abs() < 1e-9, "{by_model} {by_robot}");
}

/// A run of a robot of one joint, with errors of the input.
fn recorded_of_one(robot: &Robot) -> MemoryRuns {
    let (times, mut random) = (grid(0.004, SAMPLES), Random(5));
    let asked: Vec<f64> = times.iter().map(|t| (3.0 * t).sin()).collect();
    let had: Vec<f64> = asked.iter().map(|u| u + 0.05 * random.signed()).collect();
    let states = simulated(robot, &[0.0, 0.0], &times, &had);
    let mut runs = MemoryRuns::default();
    runs.push("one", Some("A"), Some("A"), Run::new(1, times, states, asked).unwrap());
    runs
}

#[test]
fn a_fit_moves_the_robot_whose_equations_count() {
    let robot = bent();
    let elbow = Parameter { joint: 1, kind: ParameterKind::Viscous1 };
    let described = robot.description().with_values(&[elbow], &[1.6]).unwrap();
    let real = Robot::from_description(&described).unwrap();
    let problem = problem(robot, recorded(&real, 0.02), Equations::Robot);
    let settings = FitSettings { groups: vec![Group::Viscous], pull: Some(0.001) };
    let fitted = fit(&problem, &settings, &Silent).unwrap();
    let found = conform_all(&fitted.problem);
    let record = &fitted.record;
    assert!(found.verdict.conformant && record.cost < 0.5 * record.identified_cost, "{record:?}");
    let elbow = record.parameters.iter().find(|parameter| parameter.part == 2).unwrap();
    assert!((elbow.fitted / 1.6 - 1.0).abs() < 0.05, "{elbow:?}");
}

#[test]
fn a_model_that_is_not_linear_has_equations_of_its_own() {
    let robot = bent();
    let with = |abstraction: Abstraction, method| {
        let arm = ArmSettings::new(Torque::Compensated, 2);
        let arm = ArmSettings { abstraction, equations: Equations::Robot, ..arm };
        reachtube_arm::setup(robot.clone(), arm, Settings { method, ..Settings::default() })
    };
    let cubic = Abstraction { model: ModelKind::One, order: 3 };
    for (abstraction, method) in
        [(cubic, Method::Program), (Abstraction::default(), Method::Bisection)]
    {
        let error = with(abstraction, method).unwrap_err();
        let written = error.written_for(FrontEnd::CommandLine);
        assert!(matches!(error, Error::Drive(_)) && written.ends_with("(--equations model)"));
    }
}
