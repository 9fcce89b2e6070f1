//! Tests of each effect of the virtual robot.

use reachtube_robot::{DrivenBy, Robot, RobotField};

use super::arm::{Arm, Logged};
use super::parameters::VirtualRobotParameters;
use super::plant::Plant;
use super::recording::Recording;
use super::suite::{PreRecorded, Scatter, SuiteRuns, record_suite};
use super::truth::VirtualRobot;
use crate::motion::{Motion, SAMPLE_TIME};
use crate::random::{SeedableRng, SplitMix64};
use reachtube_ode::{DormandPrince, Tolerance};

const POSE: [f64; 6] = [0.3, -0.4, 0.5, 0.2, -0.7, 0.1];

fn robot(parameters: VirtualRobotParameters) -> VirtualRobot {
    VirtualRobot::new(&Robot::lwa4p(), parameters).unwrap()
}

fn defaults() -> VirtualRobotParameters {
    VirtualRobotParameters::default()
}

fn motion(seed: u64) -> Motion {
    Motion::random(&Robot::lwa4p(), 2.0, &mut SplitMix64::seed_from_u64(seed))
}

/// Returns a torque \[N m\] that moves each joint forward from `POSE`.
fn pushing(robot: &VirtualRobot) -> Vec<f64> {
    let truth = robot.truth();
    let holding = truth.gravity_torque(&POSE) + truth.coulomb_torque(&POSE, &[1.0; 6]);
    holding.iter().map(|torque| torque + 3.0).collect()
}

fn suite(robot: &VirtualRobot, motion: &Motion, seed: u64) -> Vec<Recording> {
    let mut random = SplitMix64::seed_from_u64(seed);
    let scatter = (0..4).map(|_| Scatter::random(robot, &mut random)).collect();
    let first = motion.start_cycle(1, 4);
    let runs = SuiteRuns { name: "A".into(), first, samples: motion.cycles() + 1 - first, scatter };
    record_suite(robot, motion, &PreRecorded::new(robot, motion), &runs).unwrap()
}

#[test]
fn a_stuck_joint_does_not_move_at_all() {
    let robot = robot(defaults());
    let mut plant = Plant::at_rest(&robot, &POSE, &[22.0; 6]);
    let mut torque: Vec<f64> = robot.truth().gravity_torque(&POSE).as_slice().to_vec();
    // Joint 6 has 2.33 N m of Coulomb friction, a tenth more at breakaway, and some more when cold.
    torque[5] += 2.4;
    plant.advance(&torque, 2.0);
    assert_eq!((&plant.q[..], &plant.qd[..]), (&POSE[..], &[0.0; 6][..]));
    torque[5] += 0.5;
    plant.advance(&torque, 0.5);
    assert!(plant.q[5] > POSE[5] + 1e-3, "{:?}", plant.q);
}

#[test]
fn a_moving_joint_comes_to_rest_without_chatter() {
    let robot = robot(VirtualRobotParameters { ripple_ratio: 0.0, ..defaults() });
    let mut plant = Plant::at_rest(&robot, &POSE, &[32.0; 6]);
    let gravity = robot.truth().gravity_torque(&POSE);
    let push = pushing(&robot);
    plant.advance(&push, 0.2);
    assert!(plant.qd.iter().all(|qd| *qd > 0.02), "{:?} rad/s", plant.qd);
    let mut forward = true;
    for _ in 0..1000 {
        plant.advance(gravity.as_slice(), 1e-3);
        forward &= plant.qd.iter().all(|qd| *qd >= 0.0);
    }
    assert!(forward && plant.qd.iter().all(|qd| *qd == 0.0), "{:?} rad/s", plant.qd);
}

/// The oracle is an adaptive integrator on the robot's own forward dynamics.
#[test]
fn a_motion_without_reversal_is_that_of_the_true_robot() {
    let robot =
        robot(VirtualRobotParameters { breakaway_ratio: 0.0, ..VirtualRobotParameters::ideal() });
    let torque = pushing(&robot);
    let mut plant = Plant::at_rest(&robot, &POSE, &[32.0; 6]);
    plant.advance(&torque, 0.1);
    let mut x = [&plant.q[..], &plant.qd[..]].concat();
    plant.advance(&torque, 0.4);
    let mut field = RobotField::new(robot.truth(), DrivenBy::Motor);
    let fine = Tolerance { relative: 1e-10, absolute: 1e-10 };
    let mut method = DormandPrince::new(12, fine);
    assert!(method.integrate(&mut field, [0.0, 0.4], &mut x, &torque).is_reached());
    for i in 0..6 {
        let off = [plant.q[i] - x[i], plant.qd[i] - x[6 + i]];
        assert!(off.iter().all(|off| off.abs() < 2e-4), "joint {}: {off:?}", i + 1);
        assert!(plant.qd[i] > 0.1, "joint {} rests", i + 1);
    }
}

#[test]
fn breakaway_and_the_stribeck_effect_slow_a_slow_joint() {
    let way = |breakaway_ratio: f64| {
        let robot =
            robot(VirtualRobotParameters { breakaway_ratio, ripple_ratio: 0.0, ..defaults() });
        let mut plant = Plant::at_rest(&robot, &POSE, &[32.0; 6]);
        let mut torque: Vec<f64> = robot.truth().gravity_torque(&POSE).as_slice().to_vec();
        torque[5] += 5.0;
        plant.advance(&torque, 0.1);
        let fast = plant.q[5] - POSE[5];
        torque[5] -= 5.0;
        plant.advance(&torque, 1.0);
        (fast, plant.q[5] - POSE[5])
    };
    let (plain, rising) = (way(0.0), way(0.3));
    assert!(rising.0 < plain.0 && rising.1 < 0.98 * plain.1, "{plain:?} {rising:?}");
}

#[test]
fn warm_joints_have_less_friction_and_go_further() {
    let way = |temperature: f64| {
        let robot = robot(defaults());
        let mut plant = Plant::at_rest(&robot, &POSE, &[temperature; 6]);
        let gravity = robot.truth().gravity_torque(&POSE);
        let torque: Vec<f64> = gravity.iter().map(|g| g + 9.0).collect();
        plant.advance(&torque, 0.5);
        plant.q.clone()
    };
    let (cold, warm) = (way(22.0), way(42.0));
    // The other joints drag joints 3 and 6 along, so the first and the fifth are compared.
    assert!([0, 4].iter().all(|i| warm[*i] > cold[*i] + 1e-3), "{cold:?} {warm:?}");
}

/// The balance of the model: work of friction over heat capacity, and first-order cooling.
#[test]
fn friction_work_heats_and_rest_cools() {
    let parameters =
        VirtualRobotParameters { cooling_time: 1e9, ..VirtualRobotParameters::ideal() };
    let robot = robot(parameters);
    let mut plant = Plant::at_rest(&robot, &POSE, &[32.0; 6]);
    let mut torque: Vec<f64> = robot.truth().gravity_torque(&POSE).as_slice().to_vec();
    torque[5] += 4.0;
    plant.advance(&torque, 1.0);
    // Joint 6 turns without load: 2.33 N m and viscous friction against 4 N m, minus what moves it.
    let (way, speed) = (plant.q[5] - POSE[5], plant.qd[5]);
    let work = 4.0 * way - 0.5 * 0.643 * speed * speed;
    plant.warm_up(1.0);
    let heat = (2.33 + 3.53) * (plant.temperatures[5] - 32.0);
    assert!(way > 0.1 && (heat / work - 1.0).abs() < 0.05, "{heat} J of {work} J");

    let robot = VirtualRobot::new(&Robot::lwa4p(), defaults()).unwrap();
    let mut plant = Plant::at_rest(&robot, &POSE, &[42.0; 6]);
    (0..8_000).for_each(|_| plant.warm_up(0.01));
    let expected = 22.0 + 20.0 * (-1.0f64).exp();
    assert!((plant.temperatures[0] - expected).abs() < 0.01, "{:?}", plant.temperatures);
}

#[test]
fn the_payload_shows_in_gravity() {
    let payload = VirtualRobotParameters {
        payload_mass: 0.5,
        payload_position: [0.0, 0.0, 0.1],
        ..VirtualRobotParameters::ideal()
    };
    let (with, without) = (robot(payload), robot(VirtualRobotParameters::ideal()));
    // Stretched out level: joint 2 holds the payload at 0.35 + 0.3012 + 0.1548 + 0.1 m.
    let mut q = [0.0; 6];
    q[1] = std::f64::consts::FRAC_PI_2;
    let torque = |robot: &VirtualRobot| robot.truth().gravity_torque(&q)[1];
    let difference = torque(&with) - torque(&without);
    let arm = 0.35 + 0.3012 + 0.1548 + 0.1;
    assert!((difference.abs() - 0.5 * 9.81 * arm).abs() < 1e-9, "{difference} N m");
    // It has inertia as well.
    let inertia = |robot: &VirtualRobot| robot.truth().mass_matrix(&q)[(1, 1)];
    assert!((inertia(&with) - inertia(&without) - 0.5 * arm * arm).abs() < 1e-9);
}

#[test]
fn links_and_motors_have_their_ratios() {
    let parameters = VirtualRobotParameters { payload_mass: 0.0, ..defaults() };
    let robot = robot(parameters);
    let (truth, nominal) = (robot.truth(), robot.nominal());
    let gravity = truth.gravity_torque(&POSE) - nominal.gravity_torque(&POSE) * 1.02;
    assert!(gravity.amax() < 1e-7, "{gravity} N m");
    // One set of bodies: the gravity torque agrees with the inertial parameters.
    assert!(truth.description().joints.iter().all(|joint| joint.gravity_moments.is_none()));
    let mass = truth.mass_matrix(&POSE) - nominal.mass_matrix(&POSE);
    assert!(mass.amax() < 0.12 && mass.amax() > 0.03, "{mass} kg m²");
    assert!((truth.joints()[2].armature - 1.03 * 1.78).abs() < 1e-12);
}

/// A step of the command acts after the delay, at the resolution of the simulation.
#[test]
fn the_delay_delays_by_the_stated_time() {
    let first_motion = |delay_cycles: f64| {
        let robot = robot(VirtualRobotParameters {
            delay_cycles,
            encoder_step: 1e-12,
            ..VirtualRobotParameters::ideal()
        });
        let mut arm = Arm::at_rest(&robot, &[0.0; 6], &[32.0; 6]);
        let recorded =
            arm.open_loop(&[[0.0, 0.0, 0.0, 0.0, 0.0, 9.0]; 60].concat(), |_| vec![0.0; 6]);
        // Position follows (τ - τ_c) t² / (2 J) soon after the step.
        let samples: Vec<f64> = recorded.q.iter().skip(5).step_by(6).copied().collect();
        let k = samples.iter().position(|q| *q > 2e-3).unwrap();
        let part = (2e-3 - samples[k - 1]) / (samples[k] - samples[k - 1]);
        (k as f64 - 1.0 + part) * SAMPLE_TIME
    };
    let prompt = first_motion(0.0);
    for cycles in [0.25, 0.5, 1.0, 2.0, 3.75] {
        let late = first_motion(cycles) - prompt;
        assert!((late - cycles * SAMPLE_TIME).abs() < 4e-4, "{cycles} cycles: {late} s");
    }
}

#[test]
fn ripple_has_the_period_of_a_motor_turn() {
    let speeds = |ripple_ratio: f64| {
        let robot =
            robot(VirtualRobotParameters { ripple_ratio, ..VirtualRobotParameters::ideal() });
        let mut plant = Plant::at_rest(&robot, &[0.0; 6], &[32.0; 6]);
        let mut torque = robot.truth().gravity_torque(&[0.0; 6]);
        torque[5] += 6.0;
        (0..1500)
            .map(|_| {
                plant.advance(torque.as_slice(), 1e-3);
                (plant.q[5], plant.qd[5])
            })
            .collect::<Vec<_>>()
    };
    // The deviation from the smooth motion changes sign twice in each motor turn.
    let (smooth, rough) = (speeds(0.0), speeds(0.05));
    let off: Vec<f64> = smooth.iter().zip(&rough).map(|(a, b)| b.1 - a.1).skip(500).collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let crossings = off.windows(2).filter(|w| (w[0] > mean) != (w[1] > mean)).count();
    let turns = (rough[1499].0 - rough[500].0) * 100.0 / std::f64::consts::TAU;
    assert!(turns > 8.0 && (crossings as f64 - 2.0 * turns).abs() <= 2.0, "{crossings} {turns}");
}

#[test]
fn computed_torque_control_follows_the_motion() {
    let motion = motion(3);
    let furthest = |parameters: VirtualRobotParameters| {
        let robot = robot(parameters);
        let mut arm = Arm::at_rest(&robot, &motion.start, &[32.0; 6]);
        let plan = |k: usize| motion.at(k as f64 * SAMPLE_TIME);
        let recorded = arm.follow(motion.cycles(), Logged::Motor, plan);
        let rows = recorded.q.chunks_exact(6).enumerate();
        rows.flat_map(|(k, q)| {
            let plan = motion.at(k as f64 * SAMPLE_TIME).q;
            q.iter().zip(plan).map(|(q, plan)| (q - plan).abs()).collect::<Vec<_>>()
        })
        .fold(0.0, f64::max)
    };
    let (ideal, real) = (furthest(VirtualRobotParameters::ideal()), furthest(defaults()));
    assert!(ideal < 0.01 && real < 0.03, "{ideal} rad, {real} rad");
    let loose = furthest(VirtualRobotParameters { natural_frequency: 2.0, ..defaults() });
    assert!(loose > 2.0 * real, "{loose} rad, {real} rad");
}

#[test]
fn the_ideal_robot_repeats_its_motion_open_loop() {
    let (motion, robot) = (motion(5), robot(VirtualRobotParameters::ideal()));
    let runs = suite(&robot, &motion, 1);
    assert!(runs.windows(2).all(|pair| pair[0].q == pair[1].q && pair[0].qd == pair[1].qd));
    let other = robot_runs_spread(&suite(&self::robot(defaults()), &motion, 1));
    assert!(other > 5e-3, "{other} rad");
}

/// Returns the largest spread of a position at the end of the runs \[rad\].
fn robot_runs_spread(runs: &[Recording]) -> f64 {
    let end = |run: &Recording, joint: usize| run.q[run.q.len() - 6 + joint];
    (0..6)
        .map(|joint| {
            let ends: Vec<f64> = runs.iter().map(|run| end(run, joint)).collect();
            let high = ends.iter().fold(f64::MIN, |a, b| a.max(*b));
            high - ends.iter().fold(f64::MAX, |a, b| a.min(*b))
        })
        .fold(0.0, f64::max)
}

#[test]
fn runs_warm_up_from_cold_and_have_one_input() {
    let runs = suite(&robot(defaults()), &motion(2), 1);
    let temperatures: Vec<f64> =
        runs.iter().map(|run| run.temperatures[..6].iter().sum::<f64>() / 6.0).collect();
    assert!((temperatures[0] - 22.0).abs() < 0.5, "{temperatures:?} °C");
    assert!(temperatures.windows(2).all(|pair| pair[0] < pair[1]), "{temperatures:?} °C");
    assert!(runs.iter().all(|run| run.torques == runs[0].torques));
}

#[test]
fn starts_scatter_as_far_as_the_parameters_say() {
    let motion = motion(4);
    // Without warming and noise, only the drawn deviation and what control makes of it remain.
    let exact = VirtualRobotParameters { encoder_step: 1e-9, ..VirtualRobotParameters::ideal() };
    let starts = |parameters: VirtualRobotParameters| {
        let runs = suite(&robot(parameters), &motion, 9);
        runs.iter().map(|run| run.q[..6].to_vec()).collect::<Vec<_>>()
    };
    let (planned, scattered) = (
        starts(exact.clone()),
        starts(VirtualRobotParameters { position_scatter: 1.5e-3, ..exact }),
    );
    let off = planned.iter().flatten().zip(scattered.iter().flatten()).map(|(a, b)| (a - b).abs());
    let furthest = off.fold(0.0, f64::max);
    assert!((0.8e-3..2.5e-3).contains(&furthest), "{furthest} rad");
}

#[test]
fn parameters_out_of_range_are_refused() {
    for (parameters, words) in [
        (VirtualRobotParameters { link_ratio: 0.0, ..defaults() }, "link_ratio = 0 is outside"),
        (VirtualRobotParameters { pause: f64::NAN, ..defaults() }, "pause = NaN is outside"),
        (
            VirtualRobotParameters { delay_cycles: 101.0, ..defaults() },
            "delay_cycles = 101 is outside [0e0, 1e2]; give a value inside",
        ),
    ] {
        let error = VirtualRobot::new(&Robot::lwa4p(), parameters).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}
