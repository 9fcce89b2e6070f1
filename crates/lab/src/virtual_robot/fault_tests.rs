//! How soon a monitor finds faults of the virtual arm, and whether it is quiet without one.

use reachtube_arm::{ArmModel, ArmSettings, Equations, setup};
use reachtube_conform::monitor::{HealthyMotion, Monitor, Schedule};
use reachtube_conform::{Keep, Model, Problem, Settings, Silent, conform};
use reachtube_recordings::{MemoryRuns, ReadOptions, Run, RunSource, Torque};
use reachtube_robot::Robot;

use super::controller::Controller;
use super::parameters::VirtualRobotParameters;
use super::plant::Plant;
use super::sensors::Sensors;
use super::truth::VirtualRobot;
use crate::motion::{Motion, SAMPLE_TIME};
use crate::random::{SeedableRng, SplitMix64, uniform};

/// A fault of the arm.
#[derive(Debug, Clone, Copy)]
enum Fault {
    None,
    /// More mass at the tip, kg, from the beginning.
    Payload(f64),
    /// A brake of joint 2 that drags, N m.
    Drag(f64),
    /// Encoder 2 slips by an angle, rad.
    Slip(f64),
    /// A force on the tip over 50 ms, N, from the middle of the next motion on.
    Push(f64, Direction),
    /// The same at any time, be the arm at rest.
    PushAnyTime(f64, Direction),
}

/// Where a force on the tip points to, in the base frame, as long as it lasts.
#[derive(Debug, Clone, Copy)]
enum Direction {
    /// Against the velocity that the tip has when the force begins, as an obstacle pushes.
    Against,
    /// Any direction, all equally probable.
    Random,
    Down,
}

/// The tip of an arm, where its payload is.
struct Tip {
    /// Two arms that differ by 1 kg there.
    arms: [Robot; 2],
}

impl Tip {
    fn new(robot: &VirtualRobot, usual: &VirtualRobotParameters) -> Self {
        let mass = robot.parameters().payload_mass + 1.0;
        let heavier = VirtualRobotParameters { payload_mass: mass, ..usual.clone() };
        let heavier = VirtualRobot::new(&Robot::lwa4p(), heavier).unwrap();
        Self { arms: [robot, &heavier].map(|arm| arm.truth().clone()) }
    }

    /// Returns the joint torques of a force, N, as its weight on 1 kg.
    fn torque(&self, q: &[f64], force: [f64; 3]) -> Vec<f64> {
        let [own, heavier] = [0, 1].map(|k| self.arms[k].with_gravity(force).gravity_torque(q));
        (own - heavier).as_slice().to_vec()
    }

    fn push(&self, direction: Direction, plant: &Plant, random: &mut SplitMix64) -> [f64; 3] {
        let axis = |i: usize| std::array::from_fn(|k| f64::from(u8::from(i == k)));
        let speed = |i: usize| {
            let torque = self.torque(&plant.q, axis(i));
            torque.iter().zip(&plant.qd).map(|(torque, qd)| torque * qd).sum::<f64>()
        };
        let along = match direction {
            Direction::Down => [0.0, 0.0, -1.0],
            Direction::Against => [0, 1, 2].map(|i| -speed(i)),
            Direction::Random => [0.0; 3],
        };
        let square = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>();
        let mut point = along;
        // A tip at rest is met from any direction, too: points of a ball are drawn from a cube.
        while square(&point) == 0.0 || along == [0.0; 3] && square(&point) > 1.0 {
            point = std::array::from_fn(|_| uniform(random, -1.0, 1.0));
        }
        let length = square(&point).sqrt();
        point.map(|x| x / length)
    }
}

/// A recording, and the cycle in which its fault began.
struct Trial {
    run: Run,
    begins: usize,
}

/// Records one run of motions between random poses in closed loop, with a fault from cycle `from`
/// on; at least `cycles` from there.
fn record(fault: Fault, cycles: usize, from: usize, seed: u64) -> Trial {
    let usual = VirtualRobotParameters::default();
    let more = match fault {
        Fault::Payload(mass) => mass,
        _ => 0.0,
    };
    let parameters =
        VirtualRobotParameters { payload_mass: usual.payload_mass + more, ..usual.clone() };
    let robot = VirtualRobot::new(&Robot::lwa4p(), parameters).unwrap();
    let tip = Tip::new(&robot, &usual);
    let mut random = SplitMix64::seed_from_u64(seed);
    let start = Motion::random_pose(robot.nominal(), &mut random);
    let n = start.len();
    let temperatures = vec![robot.parameters().nominal_temperature; n];
    let mut plant = Plant::at_rest(&robot, &start, &temperatures);
    let mut sensors = Sensors::at_rest(robot.parameters(), &start);
    let mut controller = Controller::at_rest(&robot, &start);
    let [mut times, mut states, mut torques] = [vec![], vec![], vec![]];
    let (mut pose, mut pushed) = (start, [0.0; 3]);
    let mut begins = if matches!(fault, Fault::Push(..)) { usize::MAX } else { from };
    while times.len() < begins.saturating_add(cycles) {
        let end = Motion::random_pose(robot.nominal(), &mut random);
        let peak = uniform(&mut random, 0.5, 1.0);
        let motion = Motion::between(robot.nominal(), pose, &end, peak);
        pose = end;
        for k in 0..motion.cycles() {
            let cycle = times.len();
            if begins == usize::MAX && cycle >= from && k == motion.cycles() / 2 {
                begins = cycle;
            }
            controller.follow(&sensors.q, &sensors.qd, &motion.at(k as f64 * SAMPLE_TIME));
            times.push(cycle as f64 * SAMPLE_TIME);
            states.extend(sensors.q.iter().chain(&sensors.qd));
            torques.extend(&controller.input);
            let (mut outside, mut offset) = (vec![0.0; n], vec![0.0; n]);
            match fault {
                _ if cycle < begins => {}
                Fault::None | Fault::Payload(_) => {}
                Fault::Drag(torque) => outside[1] = -torque * (plant.qd[1] / 1e-2).tanh(),
                Fault::Slip(angle) => offset[1] = angle,
                Fault::Push(force, direction) | Fault::PushAnyTime(force, direction) => {
                    if cycle == begins {
                        pushed = tip.push(direction, &plant, &mut random).map(|x| force * x);
                    }
                    if (cycle - begins) as f64 * SAMPLE_TIME < 0.05 {
                        outside = tip.torque(&plant.q, pushed);
                    }
                }
            }
            let ([before, after], part) = controller.acting();
            for (torque, part) in [(before, part), (after, 1.0 - part)] {
                let torque: Vec<f64> =
                    torque.iter().zip(&outside).map(|(own, more)| own + more).collect();
                plant.advance(&torque, part * SAMPLE_TIME);
            }
            plant.warm_up(SAMPLE_TIME);
            let read: Vec<f64> = plant.q.iter().zip(&offset).map(|(q, more)| q + more).collect();
            sensors.measure(&read);
        }
    }
    Trial { run: Run::new(n, times, states, torques).unwrap(), begins }
}

fn record_healthy(cycles: usize, seed: u64) -> Run {
    record(Fault::None, cycles, 0, seed).run
}

/// Finds the smallest sets of the windows of a motion.
fn model(cycles: usize, horizon: f64) -> Model {
    let run = record_healthy(cycles, 1);
    let steps = (horizon / SAMPLE_TIME).round() as usize;
    let mut runs = MemoryRuns::default();
    let times: Vec<f64> = (0..=steps).map(|k| k as f64 * SAMPLE_TIME).collect();
    for window in 0..(run.len() - 1) / steps {
        let rows = |of: &[f64], n: usize| {
            of[window * steps * n..(window * steps + steps + 1) * n].to_vec()
        };
        let (states, torques) = (rows(&run.states, 12), rows(&run.torques, 6));
        let piece = Run::new(6, times.clone(), states, torques).unwrap();
        runs.push(&format!("{window}"), Some(&format!("w{window}")), None, piece);
    }
    let settings =
        ArmSettings { equations: Equations::Robot, ..ArmSettings::new(Torque::Compensated, 6) };
    let setup = setup(Robot::lwa4p(), settings, Settings::default()).unwrap();
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap();
    Model::new(&problem, &conform(&problem, &Silent, None).unwrap())
}

/// Lets the sets of windows grow until they enclose other recordings, whose windows follow each
/// other, as `conform --horizon --calibrate` does; returns the growth.
fn calibrate(model: &mut Model, recordings: &MemoryRuns, horizon: f64) -> f64 {
    let growth = |index: usize| {
        let run = recordings.read(index, &ReadOptions::default()).unwrap();
        let schedule = Schedule { every: horizon, ..Schedule::with_horizon(horizon, SAMPLE_TIME) };
        watch((model, schedule), None, &run, 0).used
    };
    let growth = (0..recordings.runs().len()).map(growth).fold(1.0, f64::max);
    for set in [&mut model.initial_set, &mut model.input_set] {
        set.radius.iter_mut().for_each(|radius| *radius *= growth);
    }
    // Its digest is made anew.
    *model = reachtube_arm::parse(&model.to_json(), "model".as_ref()).unwrap().0;
    growth
}

fn recordings(count: u64, cycles: usize) -> MemoryRuns {
    let mut runs = MemoryRuns::default();
    for seed in 0..count {
        runs.push(&format!("{seed}"), None, None, record_healthy(cycles, 1000 + seed));
    }
    runs
}

/// The result of a monitor.
#[derive(Debug, Default)]
struct Watched {
    /// Time to the first window that is left, s.
    left: Option<f64>,
    /// Time to the first alarm, s, and what it is.
    alarm: Option<(f64, String)>,
    /// Number of alarms, and number of alarms before the fault.
    alarms: usize,
    early: usize,
    /// The largest part of the sets that was used.
    used: f64,
}

/// Watches a recording, whose fault begins at the sample `from`.
fn watch(
    (model, schedule): (&Model, Schedule),
    healthy: Option<&HealthyMotion>,
    run: &Run,
    from: usize,
) -> Watched {
    let mut monitor = Monitor::new(model, model.setup().unwrap(), schedule).unwrap();
    healthy.iter().for_each(|healthy| monitor.watch(healthy).unwrap());
    let mut found = Watched::default();
    for (k, &time) in run.times.iter().enumerate() {
        let left = !monitor.push(time, run.q(k), run.qd(k), run.torque(k)).unwrap().is_empty();
        let after = time - run.times[from];
        if left && k >= from {
            found.left = found.left.or(Some(after));
        }
        for alarm in monitor.alarms() {
            found.alarms += 1;
            found.early += usize::from(k < from);
            let what = || (after, alarm.finding(&model.signals).text);
            if k >= from {
                found.alarm = found.alarm.take().or_else(|| Some(what()));
            }
        }
    }
    found.used = monitor.largest_used().iter().copied().fold(0.0, f64::max);
    found
}

/// Watches some trials of a fault; pushes are followed for half a second, other faults for half a
/// minute.
fn trials(
    model: &Model,
    healthy: Option<&HealthyMotion>,
    fault: Fault,
    horizon: f64,
    trials: u64,
) -> Vec<Watched> {
    let schedule = Schedule::with_horizon(horizon, SAMPLE_TIME);
    let trial = |trial: u64| {
        let from = match fault {
            Fault::Payload(_) => 0,
            _ => 500 + 61 * trial as usize,
        };
        let cycles = match fault {
            Fault::Push(..) | Fault::PushAnyTime(..) => 125,
            _ => 7500,
        };
        let Trial { mut run, begins } = record(fault, cycles, from, 100 + trial);
        run.times.truncate(begins + cycles);
        watch((model, schedule), healthy, &run, begins)
    };
    (0..trials).map(trial).collect()
}

/// Returns how many trials were found, and the median and the longest time, s.
fn summary(times: impl Iterator<Item = Option<f64>>) -> String {
    let mut known: Vec<f64> = times.flatten().collect();
    known.sort_by(f64::total_cmp);
    let at = |place: usize| known.get(place).copied().unwrap_or(f64::NAN);
    let last = known.len().saturating_sub(1);
    format!("{} (median {:.3} s, longest {:.3} s)", known.len(), at(known.len() / 2), at(last))
}

#[test]
fn faults_are_found_and_a_healthy_minute_is_quiet() {
    let horizon = 0.2;
    let schedule = Schedule::with_horizon(horizon, SAMPLE_TIME);
    let (mut model, known) = (model(15_000, horizon), recordings(8, 7500));
    let growth = calibrate(&mut model, &known, horizon);
    let healthy = HealthyMotion::learn(&model, model.setup().unwrap(), schedule, &known).unwrap();
    let quiet = watch((&model, schedule), Some(&healthy), &record_healthy(15_000, 3), 0);
    assert!(quiet.left.is_none() && quiet.alarms == 0, "{quiet:?} {growth}");
    for fault in [Fault::Slip(0.02), Fault::Drag(15.0)] {
        let found = trials(&model, None, fault, horizon, 2);
        assert!(found.iter().all(|found| found.left.is_some()), "{fault:?} {found:?} {growth}");
    }
    // Sets do not distinguish these faults from healthy motion; the calibrated alarm does.
    let push = Fault::Push(10.0, Direction::Against);
    for fault in [Fault::Payload(0.5), Fault::Drag(3.0), Fault::Slip(0.002), push] {
        let found = trials(&model, Some(&healthy), fault, horizon, 2);
        assert!(found.iter().all(|found| found.alarm.is_some()), "{fault:?} {found:?}");
    }
}

/// Prints the table of docs/monitor.md.
#[test]
#[ignore = "takes long: two hours of motion, and ten trials of each fault"]
fn the_table_of_faults() {
    let horizon = 0.2;
    let schedule = Schedule::with_horizon(horizon, SAMPLE_TIME);
    let mut model = model(75_000, horizon);
    let growth = calibrate(&mut model, &recordings(40, 30_000), horizon);
    let healthy =
        HealthyMotion::learn(&model, model.setup().unwrap(), schedule, &recordings(20, 30_000))
            .unwrap();
    println!("{healthy:?}\n{:?}", healthy.ranges());
    for seed in [3, 4, 5, 6] {
        let found = watch((&model, schedule), Some(&healthy), &record_healthy(150_000, seed), 0);
        println!("growth {growth:.3}, seed {seed}: {found:?}");
        assert!(found.left.is_none() && found.alarms == 0);
    }
    let push = |direction| Fault::Push(10.0, direction);
    let any_time = |direction| Fault::PushAnyTime(10.0, direction);
    for fault in [
        push(Direction::Against),
        push(Direction::Random),
        push(Direction::Down),
        any_time(Direction::Against),
        any_time(Direction::Random),
        any_time(Direction::Down),
        Fault::Slip(0.002),
        Fault::Slip(0.005),
        Fault::Payload(0.5),
        Fault::Payload(2.0),
        Fault::Drag(1.0),
        Fault::Drag(3.0),
        Fault::Drag(10.0),
    ] {
        let found = trials(&model, Some(&healthy), fault, horizon, 10);
        let left = summary(found.iter().map(|found| found.left));
        let alarm = summary(found.iter().map(|found| Some(found.alarm.as_ref()?.0)));
        let early: usize = found.iter().map(|found| found.early).sum();
        let either = found.iter().filter(|f| f.left.is_some() || f.alarm.is_some()).count();
        println!("{fault:?}: left {left}; alarm {alarm}; either {either}; early {early}");
        let first = found.iter().filter_map(|found| found.alarm.as_ref());
        first.for_each(|(_, text)| println!("    {text}"));
    }
}
