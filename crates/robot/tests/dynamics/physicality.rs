//! Checks for a positive definite mass matrix, and the errors of robots without one.

use crate::shared::{description, oracle, oracle_robot};
use reachtube_robot::{
    GravityMoments, JointDescription, ParameterSet, Physicality, Robot, RobotError,
};

#[test]
fn lwa4p_is_proved_over_its_position_limits() {
    let robot = Robot::lwa4p();
    let Physicality::Searched { joint, pivot, .. } = robot.check_physical().unwrap() else {
        panic!("links with base parameters are no bodies")
    };
    // The last pivot is J6 + Izz6 at all positions.
    assert_eq!(joint, 5);
    assert!((pivot - (0.637 + 0.00569)).abs() < 1e-12);
    assert!(robot.prove_positive_definite(60_000).is_some());
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn robots_of_bodies_are_proved_by_their_links() {
    for name in ["ur5", "dh6"] {
        let robot = oracle_robot(name);
        let known = robot.check_physical().unwrap();
        assert!(
            matches!(known, Physicality::Links { least_pivot } if least_pivot > 0.0),
            "{known:?}"
        );
    }
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn a_violation_is_found_and_named() {
    let oracle = oracle("oracle/dh6.json");
    let mut description = description(&oracle);
    description.parameters = ParameterSet::Base;
    description.joints[2].mass = -12.0;
    let robot = Robot::from_description(&description).unwrap();
    let pivots_at = |q: &[f64]| {
        let mut m = robot.mass_matrix(q);
        reachtube_robot::ltdl::factor(m.as_mut_slice(), 6);
        m.diagonal()
    };
    assert!(pivots_at(&[0.0; 6]).min() > 0.1, "the mass matrix at q = 0 shows no violation");
    let Err(RobotError::NotPhysical { joint, q, pivot, .. }) = robot.check_physical() else {
        panic!("the violation was not found")
    };
    let at = robot.joints().iter().position(|j| j.name == joint).unwrap();
    assert!(pivot <= 0.0 && pivots_at(&q)[at] == pivot);
    assert!(robot.prove_positive_definite(2_000).is_none());
}

#[test]
fn gravity_parameters_do_not_enter_the_mass_matrix() {
    let mut description = Robot::lwa4p().description().clone();
    let heavier = |j: &mut JointDescription| {
        j.gravity_moments = Some(GravityMoments { mass: -3.0, first_moment: [1.0, 2.0, 3.0] });
    };
    description.joints.iter_mut().for_each(heavier);
    let robot = Robot::from_description(&description).unwrap();
    assert_eq!(robot.mass_matrix(&[0.4; 6]), Robot::lwa4p().mass_matrix(&[0.4; 6]));
    assert_ne!(robot.gravity_torque(&[0.4; 6]), Robot::lwa4p().gravity_torque(&[0.4; 6]));
}

/// Checks that sampled eigenvalues lie within the bounds. Returns how far the bounds are from the
/// samples' extremes, as a part of these.
fn slack_of_bounds(robot: &Robot, boxes: usize) -> [f64; 2] {
    let [least, largest] = robot.mass_matrix_bounds(boxes);
    let mut seen = [f64::INFINITY, 0.0_f64];
    let mut state = 1_u64;
    let mut unit = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for _ in 0..20_000 {
        let limits = robot.joints().iter().map(|joint| joint.position_limits);
        let q: Vec<f64> = limits.map(|[low, high]| low + (high - low) * unit()).collect();
        let values = robot.mass_matrix(&q).symmetric_eigenvalues();
        seen = [seen[0].min(values.min()), seen[1].max(values.max())];
    }
    assert!(least <= seen[0] && seen[1] <= largest, "{least} {largest} {seen:?}");
    [1.0 - least / seen[0], largest / seen[1] - 1.0]
}

#[test]
fn bounds_of_the_mass_matrix_hold_sampled_eigenvalues() {
    let text = include_str!("../../examples/double_pendulum.toml");
    let pendulum = Robot::from_toml(text, "double pendulum").unwrap();
    let slack = slack_of_bounds(&pendulum, 3000);
    assert!(slack.iter().all(|slack| *slack < 0.005), "{slack:?}");
    // Links that are no bodies have no floor for the least eigenvalue.
    let [few, more] = [50, 500].map(|boxes| slack_of_bounds(&Robot::lwa4p(), boxes));
    assert!(more[0] < few[0] && more[1] < few[1], "{few:?} {more:?}");
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn the_armatures_are_a_floor_of_the_mass_matrix_of_bodies() {
    for name in ["ur5", "dh6"] {
        let mut description = oracle_robot(name).description().clone();
        for joint in &mut description.joints {
            joint.gear_ratio = None;
            joint.rotor_inertia = None;
            joint.armature = Some(2.0);
        }
        let robot = Robot::from_description(&description).unwrap();
        let [few, more] = [50, 500].map(|boxes| slack_of_bounds(&robot, boxes));
        assert!(more[0] < 0.1 && more[1] < few[1], "{name}: {few:?} {more:?}");
        assert!(robot.mass_matrix_bounds(1)[0] >= 2.0, "{name}");
    }
}
