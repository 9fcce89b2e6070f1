//! Simulated stops end within the enclosed ones.

use rayon::prelude::*;
use reachtube_conform::SuiteReach;
use reachtube_reach::{Hyperrectangle, StepBounds};
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_verify::{
    Answer, Body, Brakes, Capsules, Category, Deceleration, Obstacle, Path, Scene, SimulatedStop,
    Solid, Stop, StopCase, StopRule, Verification,
};

use crate::common::{Random, distance, placed};

/// Step of the simulation, s.
const STEP: f64 = 1e-4;

/// Steps of the simulation in 2 ms.
const STEPS: usize = 20;

fn brakes() -> Brakes {
    let large = [45.0, 60.0];
    let torque = vec![large, large, large, large, [22.0, 30.0], [22.0, 30.0]];
    Brakes::new(torque, [0.01, 0.03])
}

/// A random state within the arm's limits of speed.
fn state(random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    (random.vector(6, 1.5), random.vector(6, 1.2))
}

/// Errors of the torque that the drives may make.
fn errors() -> Hyperrectangle {
    let radius = vec![2.0, 2.0, 1.0, 1.0, 0.5, 0.5];
    Hyperrectangle { centre: vec![0.2, 0.0, -0.1, 0.0, 0.0, 0.1], radius }
}

/// Draws the torques of the drives on a path: the controller's, with errors at the ends of
/// their range, which change in each cycle.
fn drive(random: &mut Random, path: &Path, limits: &[f64], set: &Hyperrectangle) -> Vec<f64> {
    let slow = Deceleration::along(&Robot::lwa4p(), path, 0.0, limits).unwrap();
    let Hyperrectangle { centre, radius } = set;
    let held = random.vector(6, 1.0);
    let mut error = |j: usize| {
        // Some errors keep their sign, which leads furthest.
        let part = if held[j].abs() < 0.5 { random.signed() } else { held[j] };
        centre[j] + part.signum() * radius[j]
    };
    slow.torques().iter().enumerate().map(|(at, torque)| torque + error(at % 6)).collect()
}

/// Draws arms that are stopped from a box about a state, and compares them with its enclosure.
/// Returns, for each joint, the enclosed way over the largest simulated one.
fn compare(robot: &Robot, category: &Category, seed: u64, radius: f64, arms: usize) -> Vec<f64> {
    let mut random = Random::new(seed);
    let state = state(&mut random);
    compare_from(robot, category, (seed, state), radius, arms)
}

fn compare_from(
    robot: &Robot,
    category: &Category,
    (seed, (q, qd)): (u64, (Vec<f64>, Vec<f64>)),
    radius: f64,
    arms: usize,
) -> Vec<f64> {
    let mut random = Random::new(seed + 1000);
    let side = |x: &f64| Interval::centred(*x, radius);
    let start: Vec<Interval> = q.iter().chain(&qd).map(side).collect();
    let brakes = brakes();
    let path = Path::straight(&q, &qd, 1.0);
    let stop = category.stop(robot, &brakes, (&path, 0.0), &start);
    let Stop { stands, joints, .. } = stop.unwrap();
    assert!(stands, "seed {seed}: {joints:?}");
    let mut furthest = [0.0f64; 6];
    for _ in 0..arms {
        let drive = match category {
            Category::Zero => Vec::new(),
            Category::One { limits, input_set } => drive(&mut random, &path, limits, input_set),
        };
        let mut between =
            |[low, high]: [f64; 2]| low + (high - low) * (0.5 + 0.5 * random.signed());
        let brake = brakes.torque.iter().map(|range| between(*range)).collect();
        let delay = between(brakes.delay);
        let near = |x: &f64, part: f64| x + radius * part;
        let q = q.iter().map(|x| near(x, random.signed())).collect();
        let qd = qd.iter().map(|x| near(x, random.signed())).collect();
        let case = StopCase { q, qd, brake, delay, error: vec![0.0; 6], drive };
        let SimulatedStop { way, time, .. } = case.simulate(robot, STEPS).unwrap();
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

/// Compares stops from random states.
fn compare_all(category: &Category, [states, arms]: [u64; 2], radius: f64) -> [f64; 3] {
    let robot = Robot::lwa4p();
    let of_state = |seed| compare(&robot, category, seed, radius, arms as usize);
    let [least, median, worst] =
        statistics((0..states).into_par_iter().flat_map(of_state).collect());
    println!(
        "{category:?}, radius {radius}: enclosed over worst simulated way: least {least:.3}, \
         median {median:.2}, worst {worst:.2}"
    );
    [least, median, worst]
}

fn category_1() -> Category {
    Category::One { limits: vec![4.0; 6], input_set: errors() }
}

fn statistics(ratios: Vec<f64>) -> [f64; 3] {
    let mut sorted = ratios;
    sorted.sort_by(f64::total_cmp);
    [sorted[0], sorted[sorted.len() / 2], sorted[sorted.len() - 1]]
}

#[test]
fn simulated_stops_lie_in_the_enclosed_ones() {
    let [_, median, worst] = compare_all(&Category::Zero, [30, 10], 1e-3);
    assert!(median < 2.0, "{median} {worst}");
}

#[test]
fn simulated_stops_of_category_1_lie_in_the_enclosed_ones() {
    let [_, median, worst] = compare_all(&category_1(), [12, 6], 1e-3);
    assert!(median < 2.0, "{median} {worst}");
}

/// The drives and dry friction hold all joints but one until the drives are off. Gravity then moves
/// the arm until the brakes hold.
#[test]
fn joints_that_the_drives_hold_may_move_before_the_brakes_hold() {
    let robot = Robot::lwa4p();
    let of_state = |seed: u64| {
        let mut random = Random::new(seed);
        let mut qd = vec![0.0; 6];
        qd[0] = random.signed();
        let state = (random.vector(6, 1.5), qd);
        // Torques that slow down more than they should.
        let mut set = errors();
        set.centre[0] = -2.0 * state.1[0].signum();
        let category = Category::One { limits: vec![4.0; 6], input_set: set };
        compare_from(&robot, &category, (seed, state), 0.0, 6);
    };
    (0..12).into_par_iter().for_each(of_state);
    let (q, mut qd) = (vec![0.0, 0.5, 0.0, 0.0, 0.0, 0.0], vec![0.0; 6]);
    qd[0] = 1.0;
    let brakes = Brakes::new(vec![[90.0, 100.0]; 6], [0.03, 0.05]);
    let centre = vec![-2.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let input_set = Hyperrectangle { centre: centre.clone(), radius: vec![0.2; 6] };
    let category = Category::One { limits: vec![4.0; 6], input_set };
    let path = Path::straight(&q, &qd, 1.0);
    let start: Vec<Interval> = q.iter().chain(&qd).map(|x| Interval::point(*x)).collect();
    let stop = category.stop(&robot, &brakes, (&path, 0.0), &start).unwrap();
    let slow = Deceleration::along(&robot, &path, 0.0, &[4.0; 6]).unwrap();
    let torques = slow.torques().iter().enumerate();
    let drive = torques.map(|(at, torque)| torque + centre[at % 6]).collect();
    let (brake, error) = (vec![90.0; 6], vec![0.0; 6]);
    let case = StopCase { q, qd, brake, delay: 0.05, error, drive };
    let SimulatedStop { way, .. } = case.simulate(&robot, STEPS).unwrap();
    let [low, high] = stop.joints[1].way;
    assert!(stop.stands && way[1].abs() > 1e-3, "{way:?}");
    assert!(low <= way[1] && way[1] <= high, "{way:?} {low} {high}");
}

#[test]
#[ignore = "takes long"]
fn ten_thousand_simulated_stops_lie_in_the_enclosed_ones() {
    for radius in [0.0, 1e-3, 0.01] {
        compare_all(&Category::Zero, [100, 34], radius);
    }
}

#[test]
#[ignore = "takes long"]
fn a_thousand_simulated_stops_of_category_1_lie_in_the_enclosed_ones() {
    for radius in [0.0, 1e-3] {
        compare_all(&category_1(), [50, 10], radius);
    }
}

#[test]
fn a_brake_below_the_load_is_not_proved_to_hold() {
    let robot = Robot::lwa4p();
    let weak = Brakes::new(vec![[10.0, 20.0]; 6], [0.0, 0.0]);
    let mut stretched = [Interval::ZERO; 12];
    stretched[1] = Interval::point(1.5);
    let stop_0 = reachtube_verify::stop_0;
    let stop = stop_0(&robot, &weak, &stretched);
    assert!(!stop.stands && stop.joints[1].time[1] == f64::INFINITY, "{:?}", stop.joints);
    let strong = Brakes { torque: vec![[50.0, 60.0]; 6], ..weak };
    let stop = stop_0(&robot, &strong, &stretched);
    assert!(stop.stands && stop.joints[1].way[1] < 1e-3, "{:?}", stop.joints);
}

/// A reachable set of two samples about a straight motion.
fn straight(q: &[f64], qd: &[f64], radius: f64) -> SuiteReach {
    let end: Vec<f64> = q.iter().zip(qd).map(|(q, qd)| q + 0.004 * qd).collect();
    let nominal = [q, qd, &end, qd].concat();
    let shifted = |by: f64| nominal.iter().map(|x| x + by).collect::<Vec<f64>>();
    let (lower, upper) = (shifted(-radius), shifted(radius));
    let side = |i: usize| {
        let all = [lower[i], lower[i + 12], upper[i], upper[i + 12]].map(Interval::point);
        all.into_iter().reduce(Interval::hull).unwrap()
    };
    let tube = StepBounds::from_boxes(12, (0..12).map(side).collect());
    SuiteReach {
        suite: "S".into(),
        run: None,
        times: vec![0.0, 0.004],
        nominal,
        lower,
        upper,
        tube,
        dimension: 12,
        lost: None,
    }
}

#[test]
fn simulated_stops_stay_as_far_from_an_obstacle_as_is_proved() {
    let robot = Robot::lwa4p();
    let capsules = Capsules::embedded(&robot).unwrap();
    let body = Body::new(&robot, &capsules);
    for seed in 0..3 {
        let mut random = Random::new(seed);
        let (q, qd) = state(&mut random);
        let tip = placed(&robot, capsules.as_slice().last().unwrap(), &q)[1];
        let ahead: Vec<f64> = q.iter().zip(&qd).map(|(q, qd)| q + 0.2 * qd).collect();
        let to = placed(&robot, capsules.as_slice().last().unwrap(), &ahead)[1];
        // The arm moves towards it.
        let centre = to + 0.15 * (to - tip).normalize();
        let solid = Solid::Capsule { from: centre.into(), to: centre.into(), radius: 0.01 };
        let obstacle = Obstacle { name: "ball".into(), solid, speed: 0.0, joints: None };
        let scene = Scene { obstacles: vec![obstacle], clearance: 0.0, refine: 1 };
        let rule = StopRule { brakes: brakes(), category: Category::Zero, distance: None };
        let before = Verification {
            case: "S".into(),
            answer: Answer::Safe,
            clearances: vec![],
            margins: vec![],
            closest: None,
            advice: None,
            stops: None,
            lost: None,
            reach: straight(&q, &qd, 1e-3),
        };
        let after = before.with_stops(&robot, (&body, &scene), &rule);
        let stops = after.stops.unwrap();
        assert_eq!((stops.samples, stops.proved, stops.skipped), (2, 2, 0));
        for _ in 0..6 {
            let near = |x: &f64, random: &mut Random| x + 1e-3 * random.signed();
            let start: Vec<f64> = q.iter().map(|x| near(x, &mut random)).collect();
            let speed = qd.iter().map(|x| near(x, &mut random)).collect();
            let case = StopCase {
                q: start.clone(),
                qd: speed,
                brake: brakes().torque.iter().map(|[least, _]| *least).collect(),
                delay: 0.03,
                error: vec![0.0; 6],
                drive: Vec::new(),
            };
            let way = case.simulate(&robot, STEPS).unwrap().way;
            let end: Vec<f64> = start.iter().zip(&way).map(|(q, way)| q + way).collect();
            for capsule in capsules.as_slice() {
                let name = body.joint_name(capsule.joint);
                let proved = stops.clearances.iter().find(|pair| pair.link == name).unwrap();
                let [first, last] = [&start, &end].map(|q| placed(&robot, capsule, q));
                let found = distance(centre, last) - capsule.radius - 0.01;
                assert!(found >= proved.distance - 1e-5, "{seed} {name} {found} {proved:?}");
                let moved = (last[0] - first[0]).norm().max((last[1] - first[1]).norm());
                let bound = stops.trigger.iter().find(|link| link.link == name).unwrap();
                assert!(moved <= bound.way + 1e-6, "{seed} {name} {moved} {bound:?}");
            }
        }
    }
}
