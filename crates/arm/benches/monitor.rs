//! The monitor: one sample of six joints at 1 kHz, with windows of 0.25 s of which four are open.

use divan::Bencher;
use reachtube_arm::{ArmModel, ArmSettings, Equations, setup};
use reachtube_conform::monitor::{Monitor, Schedule};
use reachtube_conform::{Keep, Model, Problem, Settings, Silent, conform};
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::Robot;

const STEP: f64 = 1e-3;

fn main() {
    divan::main();
}

/// A model of two short runs at rest.
fn model(equations: Equations) -> Model {
    let mut runs = MemoryRuns::default();
    for offset in [0.0, 0.001] {
        let states = [vec![offset; 6], vec![0.0; 6]].concat().repeat(10);
        let times = (0..10).map(|k| f64::from(k) * STEP).collect();
        let run = Run::new(6, times, states, vec![0.0; 60]).unwrap();
        runs.push(&format!("run{offset}"), Some("A"), None, run);
    }
    let arm = ArmSettings { equations, ..ArmSettings::new(Torque::Motor, 6) };
    let setup = setup(Robot::lwa4p(), arm, Settings::default()).unwrap();
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap();
    Model::new(&problem, &conform(&problem, &Silent, None).unwrap())
}

#[divan::bench(args = [Equations::Model, Equations::Robot])]
fn sample_of_six_joints(bencher: Bencher, equations: Equations) {
    let schedule = Schedule::with_horizon(0.25, STEP);
    let model = model(equations);
    let mut monitor = Monitor::new(&model, model.setup().unwrap(), schedule).unwrap();
    let mut k = 0;
    let mut push = move || {
        k += 1;
        let time = f64::from(k) * STEP;
        let q = [0.1 * time.sin(); 6];
        monitor.push(time, &q, &[0.1 * time.cos(); 6], &[1.0; 6]).map(<[_]>::len)
    };
    // Until four windows are open.
    for _ in 0..1000 {
        push().unwrap();
    }
    bencher.bench_local(push);
}
