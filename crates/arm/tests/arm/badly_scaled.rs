//! The linear program of an arm whose states differ by many orders of magnitude is solved.

use std::f64::consts::FRAC_PI_2;

use crate::common::{Random, grid, setup};
use reachtube_conform::settings::NominalStart;
use reachtube_conform::{Keep, Noise, Problem, Silent, conform};
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::Robot;

const JOINTS: usize = 7;

/// An arm with seven joints as an identification from poor data leaves it: wrists without inertia
/// and nearly without friction.
fn seven_joints() -> Robot {
    let mut text = String::from("schema_version = 1\nname = \"seven joints\"\n");
    for joint in 0..JOINTS {
        let alpha = [0.0, -FRAC_PI_2, FRAC_PI_2][joint % 3];
        let size = 10f64.powf(-0.75 * joint as f64);
        text += &format!(
            "[[joint]]\nname = \"joint{}\"\n\
             dh = {{ a = {}, alpha = {alpha}, theta = 0.0, d = {} }}\n\
             mass = {}\ncom = [{}, 0.01, -0.02]\n\
             inertia = [{}, 0.0, 0.0, {}, 0.0, {}]\n\
             friction = {{ viscous = [{}, 0.0, 0.0] }}\n",
            joint + 1,
            0.08 * (joint % 2) as f64,
            0.3 * ((joint + 1) % 2) as f64,
            4.0 * size,
            -0.02 * size,
            1e-2 * size,
            1.2e-2 * size,
            0.9e-2 * size,
            0.3 * size
        );
    }
    Robot::from_toml(&text, "seven joints").unwrap()
}

/// Motions that the model does not explain: smooth positions with noise, and other torques.
fn recorded(noise: f64) -> MemoryRuns {
    let times = grid(0.002, 300);
    let (mut runs, mut random) = (MemoryRuns::default(), Random(3));
    for suite in 0..6 {
        let (mut states, mut torques) = (Vec::new(), Vec::new());
        for t in &times {
            let angle = |j: usize| (1.0 + 0.3 * j as f64 + 0.1 * suite as f64) * t;
            let amplitude = |j: usize| 0.5 * 10f64.powi(-(j as i32 % 4));
            states.extend(
                (0..JOINTS).map(|j| amplitude(j) * angle(j).sin() + noise * random.signed()),
            );
            states.extend((0..JOINTS).map(|j| {
                let rate = 1.0 + 0.3 * j as f64 + 0.1 * suite as f64;
                amplitude(j) * rate * angle(j).cos() + 10.0 * noise * random.signed()
            }));
            torques.extend((0..JOINTS).map(|j| 10f64.powi(-(j as i32) / 2) * angle(j).cos()));
        }
        let run = Run::new(JOINTS, times.clone(), states, torques).unwrap();
        runs.push(&format!("run{suite}"), Some(&format!("S{suite}")), None, run);
    }
    runs
}

#[test]
fn sets_of_an_arm_with_tiny_inertias_are_the_smallest() {
    for noise in [0.0, 1e-5] {
        for (nominal, v) in [(NominalStart::Mean, Noise::None), (NominalStart::Own, Noise::Fitted)]
        {
            let setup = setup(&seven_joints(), |arm, sets| {
                arm.torque = Torque::Link;
                (sets.nominal, sets.noise) = (nominal, v);
            });
            let source = Box::new(recorded(noise));
            let problem = Problem::read(setup, source, &[], Keep::Needed, &Silent).unwrap();
            let found = conform(&problem, &Silent, None).unwrap();
            let gap = found.optimality_gap.unwrap();
            assert!(found.verdict.conformant);
            assert!(gap < 1e-8, "noise {noise}, {nominal:?}: gap {gap:e}");
            if nominal == NominalStart::Own {
                // The repair keeps the limits of X0.
                for (i, limit) in problem.sensor_noise().radius.iter().enumerate() {
                    let (low, high) = found.sets.initial_set.bounds(i);
                    let reach = high.max(-low);
                    assert!(reach < limit.max(1e-9) * (1.0 + 1e-4), "{i}: {reach} {limit}");
                }
            }
        }
    }
}
