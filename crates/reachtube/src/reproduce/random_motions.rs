use nalgebra::DVector;
use rand_xoshiro::SplitMix64;
use reachtube_abstraction::{ExpansionPoint, linear_model};
use reachtube_reach::LinearSystem;
use reachtube_recordings::{MemoryRuns, Run};
use reachtube_robot::Robot;

use crate::error::Result;
use crate::random::uniform;

/// Time between two samples, s.
const STEP: f64 = 0.02;

/// Number of samples of a run.
const SAMPLES: usize = 20;

/// Runs of one motion.
const RUNS: usize = 2;

const ROBOT: &str = r#"
schema_version = 1
name = "two joints"
[[joint]]
name = "shoulder"
dh = { a = 0.3, alpha = 0.0, theta = 0.0, d = 0.0 }
mass = 2.0
com = [-0.15, 0.0, 0.0]
inertia = [0.01, 0.0, 0.0, 0.02, 0.0, 0.02]
armature = 0.3
friction = { viscous = [2.0, 0.0, 0.0] }
[[joint]]
name = "elbow"
dh = { a = 0.25, alpha = 0.0, theta = 0.0, d = 0.0 }
mass = 1.5
com = [-0.12, 0.0, 0.0]
inertia = [0.01, 0.0, 0.0, 0.02, 0.0, 0.02]
armature = 0.2
friction = { viscous = [1.0, 0.0, 0.0] }
"#;

/// Returns a small virtual arm.
pub(super) fn two_joints() -> Result<Robot> {
    Ok(Robot::from_toml(ROBOT, "two joints")?)
}

/// Records motions M0, M1, ... of the arm's linear model, each with an input and an unmodelled
/// torque of its own, which are drawn independently from one distribution. A motion is a suite of
/// two runs, which differ in their start and in a small noise of the input.
pub(super) fn random_motions(
    robot: &Robot,
    count: usize,
    random: &mut SplitMix64,
) -> Result<MemoryRuns> {
    let system = linear_model(robot, &ExpansionPoint::zero(2))?;
    let mut motions = MemoryRuns::default();
    for motion in 0..count {
        let name = format!("M{motion}");
        let mut draw = |radius: f64| uniform(random, -radius, radius);
        // The cube makes small torques frequent and large ones rare, as friction errors are.
        let torque: [f64; 2] = std::array::from_fn(|_| draw(1.0).powi(3));
        let (size, frequency): ([f64; 2], f64) = (std::array::from_fn(|_| draw(3.0)), draw(8.0));
        for run in 0..RUNS {
            let mut x = DVector::from_fn(4, |_, _| draw(0.005));
            let (mut states, mut inputs) = (Vec::new(), Vec::new());
            for k in 0..SAMPLES {
                let input = size.map(|size| size * (frequency * STEP * k as f64).cos());
                states.extend(x.iter());
                inputs.extend(input);
                let acting = DVector::from_fn(2, |j, _| input[j] + torque[j] + draw(0.05));
                x = step(&system, &x, &acting);
            }
            let times = (0..SAMPLES).map(|k| STEP * k as f64).collect();
            let recorded = Run::new(2, times, states, inputs).expect("the sizes fit");
            motions.push(&format!("{name}_{run}"), Some(&name), Some(&name), recorded);
        }
    }
    Ok(motions)
}

/// Moves the linear system over one sample under a held input, by the Runge-Kutta method. Its error
/// is part of what the sets must cover.
fn step(system: &LinearSystem, x: &DVector<f64>, u: &DVector<f64>) -> DVector<f64> {
    let slope = |x: DVector<f64>| system.a() * x + system.b() * u;
    let k1 = slope(x.clone());
    let k2 = slope(x + &k1 * (0.5 * STEP));
    let k3 = slope(x + &k2 * (0.5 * STEP));
    let k4 = slope(x + &k3 * STEP);
    x + (k1 + (k2 + k3) * 2.0 + k4) * (STEP / 6.0)
}
