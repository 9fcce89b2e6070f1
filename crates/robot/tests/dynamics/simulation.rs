//! Simulated motions: energy, friction, and agreement of the ways to compute them.

use crate::random::robots_and_states;
use proptest::prelude::*;
use reachtube_ode::{
    DormandPrince, InitialValueProblem, Outcome, RungeKutta4, Tolerance, VectorField,
};
use reachtube_robot::{DrivenBy, Robot, RobotField};

const FINE: Tolerance = Tolerance { relative: 1e-10, absolute: 1e-10 };

fn double_pendulum() -> Robot {
    Robot::load(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/double_pendulum.toml")).unwrap()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let largest = a.iter().zip(b).map(|(a, b)| (a - b).abs()).max_by(f64::total_cmp).unwrap();
    assert!(!largest.is_nan(), "{a:?} {b:?}");
    largest
}

/// Returns the states at samples of a motion under motor torques, each held over a step.
pub(crate) fn simulate(robot: &Robot, start: &[f64], tau: &[Vec<f64>], step: f64) -> Vec<Vec<f64>> {
    let mut field = RobotField::new(robot, DrivenBy::Motor);
    let mut method = RungeKutta4::new(start.len());
    let mut states = vec![start.to_vec()];
    for (k, tau) in tau.iter().enumerate() {
        let mut x = states[k].clone();
        method.integrate(&mut field, [0.0, step], 8, &mut x, tau);
        states.push(x);
    }
    states
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn a_free_motion_keeps_its_energy_at_every_sample((robot, q, qd, _) in robots_and_states()) {
        let n = robot.joint_count();
        let energies = |x: &[f64]| {
            [robot.kinetic_energy(&x[..n], &x[n..]), robot.potential_energy(&x[..n])]
        };
        let (x, torques) = ([q, qd].concat(), vec![0.0; 100 * n]);
        let start: f64 = energies(&x).iter().sum();
        let times: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
        let mut sampled = Vec::new();
        let mut field = RobotField::new(&robot, DrivenBy::Motor);
        let mut solver = DormandPrince::new(2 * n, FINE);
        let run = InitialValueProblem { start: &x, inputs: &torques };
        let outcome = solver.simulate(&mut field, &times, run, |_, x| sampled.push(energies(x)));
        prop_assert!(outcome.is_reached() && sampled.len() == times.len());
        let largest = sampled.iter().flatten().fold(1.0_f64, |most, own| most.max(own.abs()));
        for energy in sampled.iter().map(|parts| parts[0] + parts[1]) {
            let change = (energy - start).abs();
            prop_assert!(change < 1e-6 * largest, "{} J of {} J", change, largest);
        }
    }

    /// Model (10) under the input (11) equals (4) with (5) under the motor torque.
    #[test]
    fn both_inputs_give_the_same_motion(
        x in prop::collection::vec(-1.2..1.2f64, 12),
        torque in prop::collection::vec(-50.0..50.0f64, 6),
    ) {
        let robot = Robot::lwa4p();
        let (q, qd) = x.split_at(6);
        let u = robot.input_from_motor_torque(q, qd, &torque);
        let rate = |driven_by, u: &[f64]| {
            let mut dx = vec![0.0; 12];
            RobotField::new(&robot, driven_by).rate(0.0, &x, u, &mut dx);
            dx
        };
        let by_motor = rate(DrivenBy::Motor, &torque);
        let scale = by_motor.iter().fold(1.0_f64, |a, b| a.max(b.abs()));
        prop_assert!(distance(&by_motor, &rate(DrivenBy::Input, u.as_slice())) < 1e-11 * scale);
        // Inverse dynamics (3) returns the torque.
        let friction = robot.coulomb_torque(q, qd) + robot.viscous_torque(qd);
        let back = robot.inverse_dynamics(q, qd, &by_motor[6..]) + friction;
        prop_assert!(distance(back.as_slice(), &torque) < 1e-10 * scale);
        prop_assert_eq!(&by_motor[..6], qd);
    }

    /// The input u, for which friction is smooth, is held between sample times with jitter.
    #[test]
    fn adaptive_steps_agree_with_small_fixed_steps(
        start in prop::collection::vec(-0.5..0.5f64, 12),
        inputs in prop::collection::vec(-20.0..20.0f64, 6 * 25),
        jitter in prop::collection::vec(-1e-3..1e-3f64, 26),
    ) {
        let robot = Robot::lwa4p();
        let times: Vec<f64> =
            jitter.iter().enumerate().map(|(k, jitter)| 0.004 * k as f64 + jitter).collect();
        let mut field = RobotField::new(&robot, DrivenBy::Input);
        let (mut method, mut x) = (RungeKutta4::new(12), start.clone());
        let mut fixed = vec![start.clone()];
        for (k, u) in inputs.chunks_exact(6).enumerate() {
            method.integrate(&mut field, [times[k], times[k + 1]], 20, &mut x, u);
            fixed.push(x.clone());
        }
        let (mut worst, mut size) = (0.0_f64, 1.0_f64);
        let run = InitialValueProblem { start: &start, inputs: &inputs };
        let outcome = DormandPrince::new(12, FINE).simulate(&mut field, &times, run, |k, x| {
            worst = worst.max(distance(x, &fixed[k]));
            size = x.iter().fold(size, |a, x| a.max(x.abs()));
        });
        prop_assert!(outcome.is_reached());
        prop_assert!(worst < 1e-8 * size, "{}", worst);
    }
}

/// A controller is a closure around the field. This one holds the joints against gravity.
#[test]
fn a_generated_input_holds_the_robot() {
    let robot = double_pendulum();
    let mut body = RobotField::new(&robot, DrivenBy::Motor).regularised_below(1e-3);
    let wanted = [1.0, -0.5];
    let mut held = |t: f64, x: &[f64], _: &[f64], dx: &mut [f64]| {
        let gravity = robot.gravity_torque(&x[..2]);
        let torque = [0, 1].map(|i| gravity[i] + 20.0 * (wanted[i] - x[i]) - 2.0 * x[i + 2]);
        body.rate(t, x, &torque, dx);
    };
    let mut x = [0.0; 4];
    let outcome =
        DormandPrince::new(4, Tolerance::default()).integrate(&mut held, [0.0, 4.0], &mut x, &[]);
    assert!(outcome.is_reached());
    // The steady-state error is at most Coulomb friction over stiffness: 0.16 N m / (20 N m/rad).
    assert!(
        distance(&x[..2], &wanted) < 0.16 / 20.0 + 1e-3 && distance(&x[2..], &[0.0; 2]) < 1e-3,
        "{x:?}"
    );
}

/// The motion goes from a swing to rest and each joint changes direction many times.
#[test]
fn regularised_joints_come_to_rest_in_few_steps() {
    let robot = double_pendulum();
    let times = [0.0, 5.0, 10.0, 20.0];
    let mut evaluations = 0;
    let mut body = RobotField::new(&robot, DrivenBy::Motor).regularised_below(1e-2);
    let mut counted = |t: f64, x: &[f64], u: &[f64], dx: &mut [f64]| {
        evaluations += 1;
        body.rate(t, x, u, dx);
    };
    let (mut end, mut energies) = ([0.0; 4], Vec::new());
    let run = InitialValueProblem { start: &[2.0, -1.0, 0.0, 0.0], inputs: &[0.0; 6] };
    let mut solver = DormandPrince::new(4, Tolerance::default());
    let outcome = solver.simulate(&mut counted, &times, run, |_, x| {
        end.copy_from_slice(x);
        energies.push(robot.kinetic_energy(&x[..2], &x[2..]) + robot.potential_energy(&x[..2]));
    });
    assert!(outcome.is_reached());
    assert!(
        energies.is_sorted_by(|a, b| a >= b) && energies[0] - energies[3] > 1.0,
        "{energies:?} J"
    );
    assert!(distance(&end[2..], &[0.0; 2]) < 1e-2, "{end:?}");
    assert!(evaluations < 60_000, "{evaluations} evaluations");
}

/// Without regularisation, the solver reports in bounded time that it cannot proceed.
#[test]
fn chatter_is_reported() {
    let robot = double_pendulum();
    let mut field = RobotField::new(&robot, DrivenBy::Motor);
    let mut solver = DormandPrince::new(4, Tolerance::default()).within_steps(5000);
    let outcome = solver.integrate(&mut field, [0.0, 20.0], &mut [0.01, 0.0, 0.0, 0.0], &[0.0; 2]);
    assert!(matches!(outcome, Outcome::Diverged { time, .. } if time < 20.0), "{outcome:?}");
}
