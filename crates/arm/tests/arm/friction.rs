//! Friction at speeds that it was not fitted on, and nominal motions that diverge by it.

use crate::common::{conform_all, grid, setup};
use reachtube_arm::{ArmModel, Equations, OfArm};
use reachtube_conform::{
    CheckJob, Code, Error, FitSettings, Group, Keep, Model, Problem, Silent, conform, fit,
};
use reachtube_finding::Severity;
use reachtube_ode::{DormandPrince, InitialValueProblem as Simulated, Tolerance};
use reachtube_recordings::{MemoryRuns, Run};
use reachtube_robot::{DrivenBy, Robot, RobotField};

const STEP: f64 = 0.004;
const SAMPLES: usize = 400;

/// A joint of 1 kg m² without gravity whose viscous friction was fitted up to 0.5 rad/s.
fn joint(viscous: [f64; 3], limit: f64) -> Robot {
    let text = format!(
        "schema_version = 1\nname = \"wheel\"\n[[joint]]\nname = \"hub\"\nmass = 1.0\n\
         com = [0.0, 0.0, 0.0]\ninertia = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]\n\
         placement = {{ translation = [0.0, 0.0, 0.0] }}\nvelocity_limit = {limit:?}\n\
         friction = {{ viscous = {viscous:?}, fitted_velocities = [-0.5, 0.5] }}\n"
    );
    Robot::from_toml(&text, "wheel.toml").unwrap()
}

/// Motions of a robot under swinging inputs of these sizes, N m.
fn swings(robot: &Robot, sizes: &[f64]) -> MemoryRuns {
    let (times, mut runs) = (grid(STEP, SAMPLES), MemoryRuns::default());
    for (number, size) in sizes.iter().enumerate() {
        let pace = 2.0 + 0.7 * number as f64;
        let inputs: Vec<f64> = times.iter().map(|t| size * (pace * t).cos()).collect();
        let mut field = RobotField::new(robot, DrivenBy::Input);
        let mut solver = DormandPrince::new(2, Tolerance::default());
        let mut states = Vec::new();
        let run = Simulated { start: &[0.0, 0.0], inputs: &inputs[..SAMPLES - 1] };
        let ended = solver.simulate(&mut field, &times, run, |_, x| states.extend_from_slice(x));
        assert!(ended.is_reached());
        let name = format!("swing{number}");
        let run = Run::new(1, times.clone(), states, inputs).unwrap();
        runs.push(&name, Some(&name), Some(&name), run);
    }
    runs
}

fn problem(robot: Robot, runs: MemoryRuns) -> Problem {
    let setup = setup(&robot, |arm, _| arm.equations = Equations::Robot);
    Problem::read(setup, Box::new(runs), &[], Keep::All, &Silent).unwrap()
}

/// A wheel that turns at a constant speed without any input.
fn turning(speed: f64) -> MemoryRuns {
    let (times, mut runs) = (grid(STEP, SAMPLES), MemoryRuns::default());
    let states = times.iter().flat_map(|t| [speed * t, speed]).collect();
    let run = Run::new(1, times, states, vec![0.0; SAMPLES]).unwrap();
    runs.push("fast", Some("fast"), Some("fast"), run);
    runs
}

#[test]
fn a_nominal_motion_that_runs_away_counts_as_outside() {
    // Friction falls beyond 0.58 rad/s and drives beyond 1 rad/s.
    let robot = joint([1.0, 0.0, -1.0], 3.0);
    let problem = problem(robot.clone(), swings(&robot, &[0.3, 0.2]));
    let found = conform_all(&problem);
    let model = Model::new(&problem, &found);
    assert!(found.verdict.conformant);
    let codes: Vec<Code> =
        model.findings().iter().filter_map(|finding| Code::of(&finding.code)).collect();
    assert!(codes.contains(&Code::FallingFriction) && !codes.contains(&Code::FrictionRange));

    let job = CheckJob::new(model.clone(), model.setup().unwrap(), turning(2.0));
    let check = job.run(&Silent).unwrap();
    assert!(!check.verdict.conformant);
    let lost = &check.verdict.lost[0];
    assert!(
        lost.nominal && lost.state.part == 0 && lost.time > 0.05 && lost.time < 1.0,
        "{lost:?}"
    );
    let after = 2 * (SAMPLES - 1 - (lost.time / STEP).round() as usize);
    assert!(check.verdict.violations.count >= after, "{:?}", check.verdict.violations);
    let of = |code| check.findings.iter().find(|finding| finding.code == code).unwrap();
    let runaway = of(Code::Unstable);
    assert_eq!(runaway.severity, Severity::Failure);
    assert!(runaway.text.contains("the nominal motion runs away after"), "{runaway}");
    assert!(of(Code::FrictionRange).text.contains("joint 1 2.00 rad/s, 0.50"));

    // No sets can be found for it.
    let setup = problem.setup().clone();
    let fast = Problem::read(setup, Box::new(turning(2.0)), &[], Keep::All, &Silent).unwrap();
    let found = conform(&fast, &Silent, None);
    assert!(matches!(found, Err(Error::RunsAway { .. })));
}

#[test]
fn fitted_friction_rises_up_to_the_velocity_limit() {
    // The wheel's friction saturates, and is described as falling beyond 1.05 rad/s.
    let real = joint([3.0, 0.0, -1.4], 0.8);
    let robot = joint([2.0, 0.0, -0.6], 2.0);
    let problem = problem(robot, swings(&real, &[1.6, 1.2, 1.4]));
    let settings = FitSettings { groups: vec![Group::Viscous, Group::Cubic], pull: Some(0.001) };
    let fitted = fit(&problem, &settings, &Silent).unwrap();
    let viscous = fitted.problem.robot().joints()[0].friction.viscous;
    assert_eq!(viscous.falls_beyond(2.0), None, "{viscous:?}");
    assert!(fitted.record.cost.is_finite());
}
