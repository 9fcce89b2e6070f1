//! The smallest uncertainty sets of a linear model for runs in memory.

use reachtube::arm::{ArmSettings, setup};
use reachtube::{Keep, MemoryRuns, Problem, Robot, Run, Settings, Silent, Torque, conform};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Five runs of one suite: the arm drifts from rest, a little differently each time.
    let (samples, step) = (100, 0.004);
    let mut runs = MemoryRuns::default();
    for run in 0..5 {
        let acceleration = 0.02 * f64::from(run);
        let times: Vec<f64> = (0..samples).map(|k| f64::from(k) * step).collect();
        let state = |t: &f64| {
            let (q, qd) = (0.5 * acceleration * t * t, acceleration * t);
            [vec![q; 6], vec![qd; 6]].concat()
        };
        let states = times.iter().flat_map(state).collect();
        let torques = vec![0.0; 6 * times.len()];
        let recorded = Run::new(6, times, states, torques)?;
        runs.push(&format!("run {run}"), Some("A"), Some("drift"), recorded);
    }
    let arm = ArmSettings::new(Torque::Compensated, 6);
    let setup = setup(Robot::lwa4p(), arm, Settings::default())?;
    let problem = Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent)?;
    let found = conform(&problem, &Silent, None)?;
    println!("{}", found.verdict.claim);
    println!("cost {:.6}, lower bound {:.6}", found.cost, found.lower_bound.unwrap_or_default());
    for joint in 0..6 {
        let (low, high) = found.sets.input_set.bounds(joint);
        println!("joint {}: U = [{low:.4}, {high:.4}] N m", joint + 1);
    }
    Ok(())
}
