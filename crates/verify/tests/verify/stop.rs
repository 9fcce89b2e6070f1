//! Simulated stops end within the enclosed ones. The simulation solves for the impulses of brakes
//! and dry friction in each of its steps (Moreau), and shares no code with the enclosure.

use nalgebra::DVector;
use rayon::prelude::*;
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_verify::{Brakes, Stop, stop_0};

use crate::common::Random;

/// Step of the simulation, s.
const STEP: f64 = 1e-4;

/// Rounds of the projection of the impulses.
const ROUNDS: usize = 100;

/// The way and the time to standstill of each joint.
struct Simulated {
    way: Vec<f64>,
    time: Vec<f64>,
}

/// One arm: positions, velocities, brake torques and the time from which they hold.
struct Case {
    q: Vec<f64>,
    qd: Vec<f64>,
    torque: Vec<f64>,
    delay: f64,
}

fn simulate(robot: &Robot, case: &Case) -> Simulated {
    let n = robot.joint_count();
    let (mut q, mut v) = (case.q.clone(), DVector::from_column_slice(&case.qd));
    let mut stopped = Simulated { way: vec![0.0; n], time: vec![0.0; n] };
    let mut impulse = vec![0.0; n];
    let mut inverse = robot.mass_matrix(&q);
    let mut load = robot.gravity_torque(&q);
    for k in 0..20_000 {
        let time = STEP * f64::from(k);
        let held = time >= case.delay;
        // Mass and gravity change little in a few steps.
        if k % 5 == 0 {
            inverse = robot.mass_matrix(&q).try_inverse().unwrap();
            load = robot.gravity_torque(&q);
        }
        let bias = robot.inverse_dynamics(&q, v.as_slice(), &vec![0.0; n]);
        let viscous = robot.viscous_torque(v.as_slice());
        let mut next = &v - STEP * (&inverse * (bias + viscous));
        let limit = |j: usize, sign: f64| {
            let brake = if held { case.torque[j] } else { 0.0 };
            let dry = robot.joints()[j].friction.dry_torque(load[j], sign * 1e-300);
            STEP * (sign * brake + dry)
        };
        let limits: Vec<_> = (0..n).map(|j| (limit(j, -1.0), limit(j, 1.0))).collect();
        (0..n).for_each(|j| next.axpy(-impulse[j], &inverse.column(j), 1.0));
        for _ in 0..ROUNDS {
            let mut largest = 0.0f64;
            for j in 0..n {
                let wanted: f64 = impulse[j] + next[j] / inverse[(j, j)];
                let change = wanted.clamp(limits[j].0, limits[j].1) - impulse[j];
                impulse[j] += change;
                next.axpy(-change, &inverse.column(j), 1.0);
                largest = largest.max(change.abs());
            }
            if largest < 1e-14 {
                break;
            }
        }
        for j in 0..n {
            let way = STEP * 0.5 * (v[j] + next[j]);
            q[j] += way;
            stopped.way[j] += way;
            if next[j].abs() > 1e-7 {
                stopped.time[j] = time + STEP;
            }
        }
        v = next;
        if held && v.amax() < 1e-7 {
            break;
        }
    }
    stopped
}

fn brakes() -> Brakes {
    let large = [45.0, 60.0];
    Brakes {
        torque: vec![large, large, large, large, [22.0, 30.0], [22.0, 30.0]],
        delay: [0.01, 0.03],
        error: vec![0.0; 6],
    }
}

/// A random state within the arm's limits of speed.
fn state(random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    (random.vector(6, 1.5), random.vector(6, 1.2))
}

/// Draws arms that the brakes stop from a box about a state, and compares them with its enclosure.
/// Returns, for each joint, the enclosed way over the largest simulated one.
fn compare(robot: &Robot, seed: u64, radius: f64, arms: usize) -> Vec<f64> {
    let mut random = Random::new(seed);
    let (q, qd) = state(&mut random);
    let side = |x: &f64| Interval::centred(*x, radius);
    let start: Vec<Interval> = q.iter().chain(&qd).map(side).collect();
    let brakes = brakes();
    let Stop { stands, joints, .. } = stop_0(robot, &brakes, &start);
    assert!(stands, "seed {seed}: {joints:?}");
    let mut furthest = [0.0f64; 6];
    for _ in 0..arms {
        let mut between =
            |[low, high]: [f64; 2]| low + (high - low) * (0.5 + 0.5 * random.signed());
        let torque = brakes.torque.iter().map(|range| between(*range)).collect();
        let delay = between(brakes.delay);
        let near = |x: &f64, part: f64| x + radius * part;
        let q = q.iter().map(|x| near(x, random.signed())).collect();
        let qd = qd.iter().map(|x| near(x, random.signed())).collect();
        let Simulated { way, time } = simulate(robot, &Case { q, qd, torque, delay });
        for (j, joint) in joints.iter().enumerate() {
            // The simulation is of first order at standstill: off by its step.
            let (slack, [low, high]) = (2.0 * STEP, joint.way);
            assert!(
                low - 1e-5 <= way[j] && way[j] <= high + 1e-5,
                "seed {seed}, {j}: {} {joint:?}",
                way[j]
            );
            let [early, late] = joint.time;
            assert!(
                early - slack <= time[j] && time[j] <= late + slack,
                "seed {seed}, {j}: {} {joint:?}",
                time[j]
            );
            furthest[j] = furthest[j].max(way[j].abs());
        }
    }
    let enclosed = |way: [f64; 2]| way[1].max(-way[0]);
    joints.iter().zip(furthest).map(|(joint, far)| enclosed(joint.way) / far).collect()
}

fn statistics(ratios: Vec<f64>) -> [f64; 3] {
    let mut sorted = ratios;
    sorted.sort_by(f64::total_cmp);
    [sorted[0], sorted[sorted.len() / 2], sorted[sorted.len() - 1]]
}

#[test]
fn simulated_stops_lie_in_the_enclosed_ones() {
    let robot = Robot::lwa4p();
    let all: Vec<f64> =
        (0..30u64).into_par_iter().flat_map(|seed| compare(&robot, seed, 1e-3, 10)).collect();
    let [_, median, worst] = statistics(all);
    println!("enclosed over worst simulated way: median {median:.2}, worst {worst:.2}");
    assert!(median < 2.0, "{median} {worst}");
}

#[test]
#[ignore = "takes long"]
fn ten_thousand_simulated_stops_lie_in_the_enclosed_ones() {
    let robot = Robot::lwa4p();
    for radius in [0.0, 1e-3, 0.01] {
        let all: Vec<f64> = (0..100u64)
            .into_par_iter()
            .flat_map(|seed| compare(&robot, seed, radius, 34))
            .collect();
        let [least, median, worst] = statistics(all);
        println!(
            "radius {radius}: enclosed over worst simulated way: least {least:.3}, median {median:.2}, worst {worst:.2}"
        );
    }
}

#[test]
fn a_brake_below_the_load_is_not_proved_to_hold() {
    let robot = Robot::lwa4p();
    let weak = Brakes { torque: vec![[10.0, 20.0]; 6], delay: [0.0, 0.0], error: vec![0.0; 6] };
    let mut stretched = [Interval::ZERO; 12];
    stretched[1] = Interval::point(1.5);
    let stop = stop_0(&robot, &weak, &stretched);
    assert!(!stop.stands && stop.joints[1].time[1] == f64::INFINITY, "{:?}", stop.joints);
    let strong = Brakes { torque: vec![[50.0, 60.0]; 6], ..weak };
    let stop = stop_0(&robot, &strong, &stretched);
    assert!(stop.stands && stop.joints[1].way[1] < 1e-3, "{:?}", stop.joints);
}
