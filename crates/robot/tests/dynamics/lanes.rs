//! The dynamics over lanes equals the dynamics over `f64` to the last bit.

use crate::random::robots_and_states;
use crate::simulation::simulate;
use proptest::prelude::*;
use reachtube_ode::{Ensemble, InitialValueProblem, VectorField};
use reachtube_robot::{DrivenBy, Robot, RobotField, Workspace};
use reachtube_scalar::{Lanes, Lanewise};

/// Returns lanes that hold the numbers scaled and shifted by different amounts.
fn spread<const N: usize>(x: &[f64]) -> Vec<Lanes<N>> {
    x.iter().map(|x| Lanes::from_lanes(|k| x * (1.0 + 0.37 * k as f64) - 0.1 * k as f64)).collect()
}

fn lane<const N: usize>(x: &[Lanes<N>], k: usize) -> Vec<f64> {
    x.iter().map(|x| x.lane(k)).collect()
}

/// Runs the algorithms for [sin, cos, q̇, q̈ or torque] and returns all results in one vector.
fn dynamics<S: Lanewise>(robot: &Robot, [sin, cos, qd, load]: [&[S]; 4]) -> Vec<S> {
    let (n, mut ws) = (robot.joint_count(), Workspace::new(robot));
    let mut out = vec![S::zero(); 5 * n + n * n];
    let (vectors, mass_matrix) = out.split_at_mut(5 * n);
    let mut vectors = vectors.chunks_exact_mut(n);
    let mut next = || vectors.next().unwrap();
    robot.rnea(sin, cos, qd, load, &mut ws, next());
    robot.aba(sin, cos, qd, load, &mut ws, next());
    robot.forward_dynamics(sin, cos, qd, load, &mut ws, next());
    robot.gravity(sin, cos, &mut ws, next());
    robot.coriolis(sin, cos, qd, &mut ws, next());
    robot.crba(sin, cos, &mut ws, mass_matrix);
    out
}

fn bits(x: &[f64]) -> Vec<u64> {
    x.iter().map(|x| x.to_bits()).collect()
}

fn same_in_every_lane<const N: usize>(
    robot: &Robot,
    state: [&[f64]; 3],
) -> Result<(), TestCaseError> {
    let [q, qd, load] = state.map(spread::<N>);
    let (sin, cos) = robot.sin_cos(&q);
    let all = dynamics(robot, [&sin, &cos, &qd, &load]);
    for k in 0..N {
        let [sin, cos, qd, load] = [&sin, &cos, &qd, &load].map(|x| lane(x, k));
        prop_assert_eq!(bits(&lane(&all, k)), bits(&dynamics(robot, [&sin, &cos, &qd, &load])));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn algorithms_agree((robot, q, qd, load) in robots_and_states()) {
        same_in_every_lane::<8>(&robot, [&q, &qd, &load])?;
        same_in_every_lane::<3>(&robot, [&q, &qd, &load])?;
    }

    /// The lanes are in different quadrants of friction.
    #[test]
    fn motions_with_friction_agree(
        x in prop::collection::vec(-1.5..1.5f64, 12),
        torque in prop::collection::vec(-40.0..40.0f64, 6),
        speed in prop_oneof![Just(0.0), 0.01..1.0f64],
        driven_by in prop_oneof![Just(DrivenBy::Motor), Just(DrivenBy::Input)],
    ) {
        let robot = Robot::lwa4p();
        let (state, torques) = (spread::<8>(&x), spread::<8>(&torque));
        let mut rate = vec![Lanes::from(0.0); 12];
        RobotField::new(&robot, driven_by)
            .regularised_below(speed)
            .rate(0.0, &state, &torques, &mut rate);
        let mut field = RobotField::new(&robot, driven_by).regularised_below(speed);
        for k in 0..8 {
            let mut alone = vec![0.0; 12];
            field.rate(0.0, &lane(&state, k), &lane(&torques, k), &mut alone);
            prop_assert_eq!(bits(&lane(&rate, k)), bits(&alone));
        }
    }
}

#[test]
fn an_ensemble_equals_its_runs_alone() {
    let robot = Robot::lwa4p();
    let starts: Vec<Vec<f64>> = (0..21)
        .map(|r| (0..12).map(|i| (1.3 * f64::from(r) + f64::from(i)).sin()).collect())
        .collect();
    let torques: Vec<Vec<f64>> =
        (0..20).map(|k| (0..6).map(|i| 20.0 * f64::from(k + i).cos()).collect()).collect();
    let inputs = torques.concat();
    let runs: Vec<_> =
        starts.iter().map(|start| InitialValueProblem { start, inputs: &inputs }).collect();
    let times: Vec<f64> = (0..=20).map(|k| 0.004 * f64::from(k)).collect();
    let mut field = RobotField::<Lanes<8>>::new(&robot, DrivenBy::Motor);
    let mut ends = vec![Vec::new(); 21];
    let outcomes = Ensemble::new(12)
        .integrate(&mut field, &times, 8, &runs, |run, _, x| ends[run] = x.to_vec());
    assert!(outcomes.iter().all(|outcome| outcome.is_reached()));
    for (start, end) in starts.iter().zip(&ends) {
        let alone = &simulate(&robot, start, &torques, 0.004)[20];
        // The ensemble's steps are differences of sample times; here they are 4 ms.
        assert!(
            alone.iter().zip(end).all(|(a, b)| (a - b).abs() < 1e-9),
            "{alone:?} is not {end:?}"
        );
    }
}
