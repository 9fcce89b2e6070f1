//! Checks for a positive definite mass matrix, and the errors of robots without one.

use crate::shared::{description, oracle, oracle_robot};
use reachtube_robot::{
    GravityMoments, JointDescription, ParameterSet, Physicality, Robot, RobotError,
};

#[test]
fn no_position_of_lwa4p_is_found_where_its_mass_matrix_is_not_positive_definite() {
    let robot = Robot::lwa4p();
    let Physicality::Searched { joint, pivot, .. } = robot.check_physical().unwrap() else {
        panic!("links with base parameters are no bodies")
    };
    // The last pivot is J6 + Izz6 at all positions.
    assert_eq!(joint, 5);
    assert!((pivot - (0.637 + 0.00569)).abs() < 1e-12);
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
