//! How soon a monitor finds faults of the virtual arm, and whether it is quiet without one.

use reachtube_conform::monitor::{Monitor, Schedule};
use reachtube_conform::settings::Equations;
use reachtube_conform::{Keep, Model, Problem, Settings, Setup, Silent, conform};
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::Robot;

use super::controller::Controller;
use super::parameters::VirtualRobotParameters;
use super::plant::Plant;
use super::sensors::Sensors;
use super::truth::VirtualRobot;
use crate::motion::{Motion, SAMPLE_TIME};
use crate::random::{SeedableRng, SplitMix64, uniform};

/// Growth of the smallest sets beyond what the motion that calibrates them needs.
const ROOM: f64 = 1.2;

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
    /// A force downward on the tip over 50 ms, N.
    Push(f64),
}

/// Records one run of motions between random poses in closed loop, with a fault from cycle `from`
/// on; at least `cycles`.
fn record(fault: Fault, cycles: usize, from: usize, seed: u64) -> Run {
    let usual = VirtualRobotParameters::default();
    let more = match fault {
        Fault::Payload(mass) => mass,
        _ => 0.0,
    };
    let parameters =
        VirtualRobotParameters { payload_mass: usual.payload_mass + more, ..usual.clone() };
    let robot = VirtualRobot::new(&Robot::lwa4p(), parameters).unwrap();
    // The weight of 1 kg more at the tip is the torque of its force.
    let heavier = VirtualRobotParameters { payload_mass: usual.payload_mass + more + 1.0, ..usual };
    let heavier = VirtualRobot::new(&Robot::lwa4p(), heavier).unwrap();
    let mut random = SplitMix64::seed_from_u64(seed);
    let start = Motion::random_pose(robot.nominal(), &mut random);
    let n = start.len();
    let temperatures = vec![robot.parameters().nominal_temperature; n];
    let mut plant = Plant::at_rest(&robot, &start, &temperatures);
    let mut sensors = Sensors::at_rest(robot.parameters(), &start);
    let mut controller = Controller::at_rest(&robot, &start);
    let [mut times, mut states, mut torques] = [vec![], vec![], vec![]];
    let mut pose = start;
    while times.len() < cycles {
        let end = Motion::random_pose(robot.nominal(), &mut random);
        let peak = uniform(&mut random, 0.5, 1.0);
        let motion = Motion::between(robot.nominal(), pose, &end, peak);
        pose = end;
        for k in 0..motion.cycles() {
            let cycle = times.len();
            controller.follow(&sensors.q, &sensors.qd, &motion.at(k as f64 * SAMPLE_TIME));
            times.push(cycle as f64 * SAMPLE_TIME);
            states.extend(sensors.q.iter().chain(&sensors.qd));
            torques.extend(&controller.input);
            let (mut outside, mut offset) = (vec![0.0; n], vec![0.0; n]);
            match fault {
                _ if cycle < from => {}
                Fault::None | Fault::Payload(_) => {}
                Fault::Drag(torque) => outside[1] = -torque * (plant.qd[1] / 1e-2).tanh(),
                Fault::Slip(angle) => offset[1] = angle,
                Fault::Push(force) => {
                    let lasts = (cycle - from) as f64 * SAMPLE_TIME < 0.05;
                    let weight = heavier.truth().gravity_torque(&plant.q)
                        - robot.truth().gravity_torque(&plant.q);
                    let part = if lasts { force / 9.81 } else { 0.0 };
                    outside.iter_mut().zip(&weight).for_each(|(own, w)| *own = -part * w);
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
    Run::new(n, times, states, torques).unwrap()
}

/// Finds the sets of windows of a motion, and lets them grow until they enclose another one, with
/// room.
fn model(cycles: usize, horizon: f64) -> (Model, f64) {
    let run = record(Fault::None, cycles, 0, 1);
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
        Settings { equations: Equations::Robot, ..Settings::new(Torque::Compensated, 6) };
    let setup = Setup::new(Robot::lwa4p(), settings).unwrap();
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap();
    let mut model = Model::new(&problem, &conform(&problem, &Silent, None).unwrap());
    let calibrating = record(Fault::None, cycles, 0, 2);
    let used = watch(&model, &calibrating, horizon, 0).1;
    let growth = ROOM * used.max(1.0);
    for set in [&mut model.initial_set, &mut model.input_set] {
        set.radius.iter_mut().for_each(|radius| *radius *= growth);
    }
    // Its digest is made anew.
    (Model::parse(&model.to_json(), "model".as_ref()).unwrap().0, growth)
}

/// Returns the time from the sample `from` to the first window that is left afterwards, s, and the
/// largest part of the sets that was used.
fn watch(model: &Model, run: &Run, horizon: f64, from: usize) -> (Option<f64>, f64) {
    let schedule = Schedule::with_horizon(horizon, SAMPLE_TIME);
    let mut monitor = Monitor::new(model, schedule).unwrap();
    let mut found = None;
    for (k, &time) in run.times.iter().enumerate() {
        let left = !monitor.push(time, run.q(k), run.qd(k), run.torque(k)).unwrap().is_empty();
        if left && k >= from {
            found = found.or(Some(time - run.times[from]));
        }
    }
    (found, monitor.largest_used().iter().copied().fold(0.0, f64::max))
}

/// Returns the times to detection in some trials, s; a fault that is not found within 10 s has
/// none.
fn times(model: &Model, fault: Fault, horizon: f64, trials: u64) -> Vec<Option<f64>> {
    let trial = |trial: u64| {
        let from = 500 + 61 * trial as usize;
        let begins = if matches!(fault, Fault::Payload(_)) { 0 } else { from };
        let run = record(fault, from + 2500, begins, 100 + trial);
        watch(model, &run, horizon, begins).0
    };
    (0..trials).map(trial).collect()
}

#[test]
fn faults_are_found_and_a_healthy_minute_is_quiet() {
    let horizon = 0.2;
    let (model, growth) = model(15_000, horizon);
    let (alarm, used) = watch(&model, &record(Fault::None, 15_000, 0, 3), horizon, 0);
    assert!(alarm.is_none(), "{alarm:?} {used} {growth}");
    for fault in [Fault::Slip(0.02), Fault::Drag(15.0)] {
        let found = times(&model, fault, horizon, 2);
        assert!(found.iter().all(Option::is_some), "{fault:?} {found:?} {growth}");
    }
}

/// Prints the table of docs/monitor.md.
#[test]
#[ignore = "takes long: ten minutes of motion, and ten trials of each fault"]
fn the_table_of_faults() {
    for horizon in [0.1, 0.2, 0.4] {
        let (model, growth) = model(75_000, horizon);
        let (alarm, used) = watch(&model, &record(Fault::None, 150_000, 0, 3), horizon, 0);
        println!("horizon {horizon}: growth {growth:.2}, used {used:.2}, first alarm {alarm:?}");
        assert!(horizon > 0.2 || alarm.is_none());
        for (fault, sizes) in [
            (Fault::Payload as fn(f64) -> Fault, [0.5, 1.0, 2.0, 4.0, 8.0]),
            (Fault::Drag, [3.0, 5.0, 10.0, 15.0, 20.0]),
            (Fault::Slip, [0.001, 0.002, 0.005, 0.01, 0.02]),
            (Fault::Push, [10.0, 30.0, 100.0, 200.0, 400.0]),
        ] {
            for size in sizes {
                let found = times(&model, fault(size), horizon, 10);
                let mut known: Vec<f64> = found.iter().copied().flatten().collect();
                known.sort_by(f64::total_cmp);
                let [median, worst] =
                    [known.len() / 2, known.len().saturating_sub(1)].map(|at| known.get(at));
                println!(
                    "{:?}: {} of 10, median {median:?} s, worst {worst:?} s",
                    fault(size),
                    known.len()
                );
            }
        }
    }
}
