//! The nominal model chosen for small sets: a 6-joint arm whose viscous friction is not the
//! identified one, 4 motions of 2 s at 250 Hz.

use divan::Bencher;
use nalgebra::DVector;
use reachtube_abstraction::{ExpansionPoint, linear_model};
use reachtube_arm::{ArmSettings, setup};
use reachtube_conform::settings::NominalStart;
use reachtube_conform::{FitSettings, Group, Keep, Problem, Settings, Silent, fit};
use reachtube_reach::TimeGrid;
use reachtube_recordings::{MemoryRuns, Run, Torque};
use reachtube_robot::{Parameter, ParameterKind, Robot};

const JOINTS: usize = 6;
const SAMPLES: usize = 501;
const STEP: f64 = 0.004;
const MOTIONS: usize = 4;
const RUNS: usize = 5;

fn main() {
    divan::main();
}

/// The arm with half as much viscous friction again.
fn real_arm() -> Robot {
    let arm = Robot::lwa4p();
    let viscous = |joint| Parameter { joint, kind: ParameterKind::Viscous1 };
    let parameters: Vec<Parameter> = (0..JOINTS).map(viscous).collect();
    let values: Vec<f64> =
        arm.description().joints.iter().map(|joint| 1.5 * joint.friction.viscous[0]).collect();
    let description = arm.description().with_values(&parameters, &values).unwrap();
    Robot::from_description(&description).unwrap()
}

/// Runs of the linear model of the real arm under small changes of a motion's input.
fn recordings() -> MemoryRuns {
    let system = linear_model(&real_arm(), &ExpansionPoint::zero(JOINTS)).unwrap();
    let times = TimeGrid::uniform(STEP, SAMPLES).times().to_vec();
    let mut runs = MemoryRuns::default();
    for motion in 0..MOTIONS {
        let name = format!("motion{motion}");
        for run in 0..RUNS {
            let mut x = DVector::zeros(2 * JOINTS);
            let (mut states, mut torques) = (Vec::new(), Vec::new());
            for &t in &times {
                let phase = |j: usize| (2.0 + motion as f64) * t + j as f64;
                let u = DVector::from_fn(JOINTS, |j, _| 3.0 * phase(j).sin());
                let change = |j: usize| 0.1 * (7.0 * phase(j) + run as f64).sin();
                states.extend(x.iter());
                torques.extend(u.iter());
                let real = DVector::from_fn(JOINTS, |j, _| u[j] + change(j));
                // Good enough for a bench: ten steps of Euler in each sample.
                for _ in 0..10 {
                    x += (system.a() * &x + system.b() * &real) * (0.1 * STEP);
                }
            }
            let recorded = Run::new(JOINTS, times.clone(), states, torques).unwrap();
            runs.push(&format!("{name}_{run}"), Some(&name), Some(&name), recorded);
        }
    }
    runs
}

/// Runs that share a nominal motion, and runs with one each.
#[divan::bench(args = [NominalStart::Mean, NominalStart::Own], sample_count = 3)]
fn inertia_viscous_and_coulomb(bencher: Bencher, nominal: NominalStart) {
    let arm = ArmSettings::new(Torque::Compensated, JOINTS);
    let settings = Settings { nominal, ..Settings::default() };
    let setup = setup(Robot::lwa4p(), arm, settings).unwrap();
    let runs = Box::new(recordings());
    let problem = Problem::read(setup, runs, &[], Keep::All, &Silent).unwrap();
    let groups = vec![Group::Inertia, Group::Viscous, Group::Coulomb];
    let settings = FitSettings { groups, pull: Some(0.02) };
    bencher.bench(|| fit(&problem, &settings, &Silent).unwrap().record.cost);
}
