//! Dry friction of joints that may come to rest, beside U.

use reachtube_arm::ArmSettings;
use reachtube_conform::{
    Answer, Code, Error, Job, Keep, Model, Problem, Settings, Silent, Stiction, Tube,
    UncertaintySets, reach, stiction,
};
use reachtube_finding::{FrontEnd, Severity};
use reachtube_reach::{Disturbance, Hyperrectangle};
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::Robot;

use crate::common::{grid, setup};

/// Returns the joints of the LWA 4P at rest that may come to rest under U of `radius`, and the
/// position that it rests at.
fn at_rest(torque: Torque, radius: f64) -> (Vec<Stiction>, Vec<f64>) {
    let q = [0.3, 0.9, -0.4, 0.2, -0.7, 0.5];
    let states = [q, [0.0; 6]].concat().repeat(3);
    let run = Run::new(6, vec![0.0, 0.004, 0.008], states, vec![0.0; 18]).unwrap();
    let mut runs = MemoryRuns::default();
    runs.push("rest", Some("A"), None, run);
    let setup = setup(&Robot::lwa4p(), |arm, _| arm.torque = torque);
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::All, &Silent).unwrap();
    let set = |n, radius| Hyperrectangle { centre: vec![0.0; n], radius: vec![radius; n] };
    let sets =
        UncertaintySets { initial_set: set(12, 1e-3), input_set: set(6, radius), noise_set: None };
    let tube = Tube::new(&problem, sets.clone()).unwrap();
    (stiction(&problem, &sets, &[], &reach(&problem, &tube).unwrap()), q.to_vec())
}

#[test]
fn friction_at_rest_is_covered_by_a_wide_u_only() {
    let robot = Robot::lwa4p();
    let (narrow, q) = at_rest(Torque::Compensated, 0.5);
    assert_eq!(narrow.len(), 6);
    let load = robot.gravity_torque(&q);
    for rest in &narrow {
        // Both limits of standstill, at the load of the recorded position.
        let friction = &robot.joints()[rest.part - 1].friction;
        let limit = |sign: f64| friction.dry_torque(load[rest.part - 1], sign * 1e-9);
        let apart = (limit(1.0) - limit(-1.0)).abs();
        assert!(apart > 1.0 && rest.torque >= apart && rest.torque < 1.2 * apart, "{rest:?}");
        assert!(!rest.is_covered() && rest.steps == 2 && rest.room == 0.5, "{rest:?}");
    }
    let (wide, _) = at_rest(Torque::Compensated, 50.0);
    assert!(wide.len() == 6 && wide.iter().all(Stiction::is_covered), "{wide:?}");
}

const SAMPLES: usize = 250;
const STEP: f64 = 0.004;
/// Steps of the simulation per sample.
const PARTS: usize = 40;

/// A wheel of 1 kg m² whose dry friction rises from 1 to 2 N m toward standstill.
fn wheel() -> Robot {
    let text = "schema_version = 1\nname = \"wheel\"\n[[joint]]\nname = \"hub\"\nmass = 1.0\n\
         com = [0.0, 0.0, 0.0]\ninertia = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]\n\
         placement = { translation = [0.0, 0.0, 0.0] }\n\
         friction = { viscous = [1.0, 0.0, 0.0], coulomb = [1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0, \
         0.0], stribeck = { excess = 1.0, speed = 0.05 } }\n";
    Robot::from_toml(text, "wheel").unwrap()
}

/// Returns the motor torque of every motion at sample `k`, N m. For a while it is so low that a
/// wheel at rest would stay at rest.
fn motor(k: usize) -> f64 {
    let t = k as f64 * STEP;
    0.97 + 1.5 * (8.0 * t).cos()
}

/// Returns the states of the wheel at the samples, from `start`, under the motor torque and a
/// disturbance for each part of a sample. It sticks as long as friction can hold it.
fn turned(start: [f64; 2], disturbance: impl Fn(usize) -> f64) -> Vec<f64> {
    let friction = wheel().joints()[0].friction;
    let ([mut q, mut qd], h) = (start, STEP / PARTS as f64);
    let mut states = vec![q, qd];
    for part in 0..(SAMPLES - 1) * PARTS {
        let driving = motor(part / PARTS) + disturbance(part) - qd;
        // The velocity after the step without friction decides in which direction friction acts.
        let free = qd + h * driving;
        let limit = friction.dry_torque(0.0, if qd == 0.0 { free * 1e-9 } else { qd }).abs();
        let next = if free.abs() <= h * limit { 0.0 } else { free - h * limit * free.signum() };
        q += 0.5 * h * (qd + next);
        qd = next;
        if (part + 1) % PARTS == 0 {
            states.extend([q, qd]);
        }
    }
    states
}

/// A small torque that differs between runs.
fn ripple(run: usize) -> impl Fn(usize) -> f64 {
    move |part| 0.02 * (part as f64 * (0.003 + 0.001 * run as f64) + run as f64).sin()
}

fn conformed(stiction: bool) -> Answer {
    let mut runs = MemoryRuns::default();
    for run in 0..3 {
        let states = turned([0.0, 0.5 + 0.01 * run as f64], ripple(run));
        let torques = (0..SAMPLES).map(motor).collect();
        let run_of = Run::new(1, grid(STEP, SAMPLES), states, torques).unwrap();
        runs.push(&format!("run{run}"), Some("A"), Some("A"), run_of);
    }
    let setup = setup(&wheel(), |arm, sets| {
        arm.torque = Torque::Motor;
        (sets.disturbance, sets.stiction) = (Disturbance::Measurable, stiction);
    });
    Job::new(setup, runs).run(&Silent).unwrap()
}

/// Returns how far the motions leave the reachable set at samples \[rad; rad/s\] that start in X0
/// of `smallest` under a torque in U of `smallest`, here at its ends.
fn furthest_outside(smallest: &Model, reached: &Answer) -> f64 {
    let reach = &reached.reach().unwrap()[0];
    let inside =
        |set: &Hyperrectangle, i: usize, part: f64| set.centre[i] + 0.999 * part * set.radius[i];
    let mut furthest = f64::NEG_INFINITY;
    for [a, b, w] in [[-1.0, -1.0, -1.0], [0.0, -1.0, -1.0], [0.0, 0.0, -0.5], [1.0, 1.0, 1.0]] {
        let x0 = &smallest.initial_set;
        let start = [reach.nominal[0] + inside(x0, 0, a), reach.nominal[1] + inside(x0, 1, b)];
        let states = turned(start, |_| inside(&smallest.input_set, 0, w));
        assert!(states.len() == reach.lower.len() && states.iter().all(|x| x.is_finite()));
        for (i, x) in states.iter().enumerate() {
            assert!(reach.lower[i] <= reach.upper[i], "{} {}", reach.lower[i], reach.upper[i]);
            furthest = furthest.max(reach.lower[i] - x).max(x - reach.upper[i]);
        }
    }
    furthest
}

#[test]
fn a_wheel_that_sticks_is_covered_by_u_that_was_widened_for_it() {
    let [smallest, wider] = [false, true].map(conformed);
    assert!(smallest.holds() && wider.holds());
    let (small, wide) = (&smallest.model, &wider.model);
    assert!(small.stiction.is_empty() && small.allowance.is_empty());
    assert!(wide.allowance[2] >= 4.0 && wide.allowance[2] < 4.2, "{:?}", wide.allowance);
    assert_eq!(wide.allowance[..2], [0.0; 2]);
    assert_eq!(wide.input_set.centre, small.input_set.centre);
    let grown = wide.input_set.radius[0] - small.input_set.radius[0];
    assert!((grown - wide.allowance[2]).abs() < 1e-12);
    assert!(wide.stiction.iter().all(Stiction::is_covered) && wide.stiction.len() == 1);

    // A wheel that sticks in the valley of the torque leaves the smallest sets.
    let [outside, inside] = [&smallest, &wider].map(|answer| furthest_outside(small, answer));
    assert!(outside > 0.01, "{outside}");
    assert!(inside <= 0.0, "{inside}");

    let said = |answer: &Answer| {
        answer.findings().into_iter().find(|finding| finding.code == Code::Stiction)
    };
    assert!(said(&smallest).is_none());
    let finding = said(&wider).unwrap();
    assert_eq!(finding.severity, Severity::Info);
    assert!(finding.text.contains("U was widened by up to 4."), "{finding}");
    assert_eq!(finding.numbers["uncovered"], 0.0);
    // The file keeps it, and a check computes with the wider sets.
    let (read, _) = reachtube_arm::parse(&wide.to_json(), "wheel.json".as_ref()).unwrap();
    assert_eq!(read.stiction, wide.stiction);
    // The finding about the smallest sets names the setting that helps.
    let rests = stiction(&smallest.problem, &small.sets(), &[], &smallest.reach().unwrap());
    let finding = small.finding_of_stiction(&rests).unwrap();
    assert_eq!((finding.severity, finding.numbers["uncovered"]), (Severity::Warning, 1.0));
    let written = finding.written_for(FrontEnd::Python);
    assert!(written.contains("`stiction=True` of `conform` widens U"), "{written}");
}

#[test]
fn stiction_needs_motor_torques_and_a_disturbance_that_changes() {
    let of = |torque, disturbance| {
        let settings = Settings { stiction: true, disturbance, ..Settings::default() };
        match reachtube_arm::setup(wheel(), ArmSettings::new(torque, 1), settings) {
            Err(Error::Stiction(why)) => why,
            other => panic!("{other:?}"),
        }
    };
    assert!(of(Torque::Link, Disturbance::Sample).contains("at the links"));
    assert!(of(Torque::Motor, Disturbance::Constant).contains("at each sample"));
}
