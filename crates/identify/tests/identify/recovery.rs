//! Identification recovers the robot of simulated recordings, with the errors that theory predicts.

use crate::lab::{Lab, geometry, lwa4p, simple_friction};
use crate::virtual_robot::{Random, Recorder, excitation, slow};
use reachtube_identify::{CoulombForm, Identification, IdentifySettings, identify};
use reachtube_robot::{BaseParameters, Robot};
use std::path::PathBuf;

/// Returns the shares of the base parameters within one and three standard errors of the truth.
fn rates(found: &Identification, truth: &Robot) -> [f64; 2] {
    let base = BaseParameters::of_robot(truth, &found.inertia.columns);
    let values = base.reduce(&truth.parameter_values(&found.inertia.columns));
    let off: Vec<f64> = found
        .inertia
        .parameters
        .iter()
        .zip(values.iter())
        .map(|(p, value)| (p.least_squares - value).abs() / p.standard_error)
        .collect();
    [1.0, 3.0].map(|limit| off.iter().filter(|off| **off < limit).count() as f64 / off.len() as f64)
}

/// Checks the standard errors of friction that the robot file has.
fn friction_lies_within_its_errors(found: &Identification, truth: &Robot) {
    let read = Robot::from_toml(&found.robot_toml(), "found").unwrap();
    for (found, truth) in read.description().joints.iter().zip(&truth.description().joints) {
        let (friction, truth) = (found.friction, truth.friction);
        let errors = friction.standard_errors.unwrap();
        for (value, truth, error) in [
            (friction.viscous[0], truth.viscous[0], errors.viscous[0]),
            (friction.coulomb[0], truth.coulomb[0], errors.coulomb[0]),
        ] {
            assert!(error > 0.0 && error < 0.2 * truth.abs(), "{friction:?} for {truth}");
            assert!((value - truth).abs() < 4.0 * error, "{friction:?} for {truth}");
        }
    }
}

#[test]
fn base_parameters_of_the_lwa_4p_lie_within_their_errors() {
    let truth = simple_friction(&lwa4p());
    let lab = Lab::new();
    lab.excite(&truth, 0.5, &[1.0; 6]);
    let mut settings = lab.settings();
    settings.model.physical = Some(false);
    let found = lab.identify(&geometry(&truth), &settings);
    let [one, three] = rates(&found, &truth);
    // Normal errors give 68.3 % and 99.7 %. With 59 parameters the share of 68 % has a standard
    // deviation of 6 %.
    assert!(three > 0.96 && (0.5..0.87).contains(&one), "{one} within one, {three} within three");
    friction_lies_within_its_errors(&found, &truth);
    assert!(found.inertia.condition < 1e3, "{}", found.inertia.condition);
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    assert!(
        found.held_out
            && found.validation[0].joints.iter().all(|joint| joint.relative.unwrap() < 0.05)
    );
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn the_ur5_is_recovered_with_physically_consistent_links() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/oracle/ur5.urdf");
    let truth = simple_friction(&Robot::load(path).unwrap());
    let lab = Lab::new();
    lab.excite(&truth, 0.5, &[1.0; 6]);
    let found = lab.identify(&geometry(&truth), &lab.settings());
    let [one, three] = rates(&found, &truth);
    assert!(three > 0.96 && (0.5..0.87).contains(&one), "{one} within one, {three} within three");
    let physical = found.inertia.physical.as_ref().unwrap();
    // The true links are physically consistent, so that the nearest links cost no more than they
    // do: about the number of parameters.
    assert!(physical.cost < 120.0 && physical.balls.len() == 6, "{physical:?}");
    let robot = Robot::from_description(&found.description).unwrap();
    assert!(matches!(robot.check_physical(), Ok(reachtube_robot::Physicality::Links { .. })));
    assert!(
        found.validation[0].joints.iter().all(|joint| joint.relative.unwrap() < 0.1),
        "{:?}",
        found.validation
    );
    assert!(
        found.gains.iter().all(|gain| (gain.gain - 1.0).abs() < 5.0 * gain.standard_error + 0.02),
        "{:?}",
        found.gains
    );
    let again = Robot::from_toml(&found.robot_toml(), "found").unwrap();
    assert!((again.mass_matrix(&[0.3; 6]) - robot.mass_matrix(&[0.3; 6])).amax() < 1e-12);
}

#[test]
fn gravity_and_friction_quadrants_are_recovered() {
    let truth = lwa4p();
    let lab = Lab::new();
    lab.excite(&truth, 0.1, &[1.0; 6]);
    let mut settings = lab.settings();
    lab.record_slowly(&truth, &mut settings);
    settings.model.physical = Some(false);
    let found = lab.identify(&geometry(&truth), &settings);
    let gravity = found.gravity.as_ref().unwrap();
    assert_eq!(gravity.rests, 20);
    let q = [0.4, -0.7, 0.5, 0.3, -0.2, 0.9];
    let off = (gravity.robot.gravity_torque(&q) - truth.gravity_torque(&q)).amax();
    assert!(off < 0.2, "{off} N m");
    for (joint, form) in [(1, CoulombForm::Quadrants), (2, CoulombForm::Quadrants)] {
        let fit = &found.friction[joint].joint;
        assert!(fit.form == form && fit.r2 > 0.99, "{fit:?}");
        let true_values = truth.description().joints[joint].friction;
        for (a, b) in fit.coefficients.coulomb.chunks(2).zip(true_values.coulomb.chunks(2)) {
            assert!((a[0] - b[0]).abs() < 0.3 && (a[1] - b[1]).abs() < 0.03, "{fit:?}");
        }
        assert!((fit.coefficients.viscous[0] - true_values.viscous[0]).abs() < 0.5, "{fit:?}");
    }
    // What exciting motions do not correct keeps the standard errors of the slow ones.
    let slopes = found.description.joints[1].friction.standard_errors.unwrap().coulomb;
    assert_eq!(slopes[1], found.friction[1].joint.standard_errors.coulomb[1]);
    assert!(slopes[1] > 0.0, "{slopes:?}");
    assert!(
        found.validation[0].joints.iter().all(|joint| joint.relative.unwrap() < 0.05),
        "{:?}",
        found.validation[0]
    );
}

#[test]
fn friction_of_slow_motions_is_dropped_where_exciting_motions_contradict_it() {
    // The slow motions show friction that depends on the load, the exciting motions do not.
    let truth = simple_friction(&lwa4p());
    let lab = Lab::new();
    lab.excite(&truth, 0.1, &[1.0; 6]);
    let mut settings = lab.settings();
    settings.model.physical = Some(false);
    settings.model.windows = vec![];
    settings.model.cubic = Some(true);
    // Both fits use the same samples.
    settings.model.slow = Some(0.02);
    let plain = lab.identify(&geometry(&truth), &settings);
    lab.record_slowly(&lwa4p(), &mut settings);
    let found = lab.identify(&geometry(&truth), &settings);
    assert_eq!(found.friction.len(), 6);
    let [joints, plain] = [&found, &plain].map(|found| &found.validation[0].joints);
    assert_eq!([joints.len(), plain.len()], [6; 2]);
    for (joint, plain) in joints.iter().zip(plain) {
        assert!(joint.residual < 1.03 * plain.residual, "{joint:?} {plain:?}");
    }
}

#[test]
fn a_wrong_sign_and_a_wrong_gain_give_warnings() {
    let truth = simple_friction(&lwa4p());
    let lab = Lab::new();
    lab.excite(&truth, 0.3, &[1.0, 1.0, -1.0, 1.0, 1.0, 1.0]);
    let mut settings = lab.settings();
    settings.model.windows = vec![];
    settings.model.physical = Some(true);
    let found = lab.identify(&geometry(&truth), &settings);
    let wrong_sign = |w: &String| w.contains("joint3") && w.contains("sign of its torque");
    assert!(found.warnings.iter().any(wrong_sign), "{:?}", found.warnings);
    // Without physical links the error names the same cause.
    settings.model.physical = None;
    let error =
        identify(&geometry(&truth), &settings, lab.path(), &|_, _| {}).unwrap_err().to_string();
    assert!(error.contains("cannot exist") && wrong_sign(&error), "{error}");
    let lab = Lab::new();
    lab.excite(&truth, 0.3, &[1.0, 1.0, 1.6, 1.0, 1.0, 1.0]);
    let mut settings = lab.settings();
    settings.model.windows = vec![];
    settings.model.physical = Some(false);
    let found = lab.identify(&geometry(&truth), &settings);
    let gain = &found.gains[2];
    assert!((gain.gain - 1.0 / 1.6).abs() < 0.05, "{:?}", found.gains);
    assert!(
        found.warnings.iter().any(|w| w.contains("the torque of joint3 contradicts")),
        "{:?}",
        found.warnings
    );
}

/// A joint that moves one way only does not tell dry friction from an offset.
#[test]
fn friction_that_the_recordings_do_not_bound_stays_small() {
    let truth = simple_friction(&lwa4p());
    let lab = Lab::new();
    let mut recorder =
        Recorder { robot: &truth, noise: 0.1, gains: vec![1.0; 6], random: Random::new(5) };
    let forward = |motion: &dyn Fn(f64) -> [Vec<f64>; 3], t: f64| {
        let [mut q, mut qd, qdd] = motion(t);
        // Joint 3 swings about a steady motion that is faster than its swings.
        q[2] += 2.5 * t;
        qd[2] += 2.5;
        [q, qd, qdd]
    };
    let motion = excitation(6, 1);
    recorder.record(&lab.path().join("one_way.csv"), 24.0, |t| forward(&motion, t));
    let mut settings = lab.settings();
    settings.excitation = vec![PathBuf::from("one_way.csv").into()];
    settings.validate = vec![];
    settings.model.windows = vec![];
    settings.model.physical = Some(true);
    let found = lab.identify(&geometry(&truth), &settings);
    let warned = |w: &String| w.contains("the prior decides") && w.contains("fc3; o3");
    assert!(found.warnings.iter().any(warned), "{:?}", found.warnings);
    let friction = &found.description.joints[2].friction;
    assert!(friction.coulomb.iter().all(|value| value.abs() < 20.0), "{friction:?}");
}

#[test]
fn undetermined_parameters_are_named() {
    let truth = simple_friction(&lwa4p());
    let lab = Lab::new();
    let mut recorder =
        Recorder { robot: &truth, noise: 0.1, gains: vec![1.0; 6], random: Random::new(5) };
    recorder.record(&lab.path().join("one.csv"), 20.0, slow(6, 1, 0.3));
    let mut settings = IdentifySettings {
        excitation: vec![PathBuf::from("one.csv").into()],
        ..IdentifySettings::default()
    };
    settings.model.physical = Some(false);
    let error =
        identify(&geometry(&truth), &settings, lab.path(), &|_, _| {}).unwrap_err().to_string();
    assert!(
        error.contains("the recordings do not determine")
            && error.contains("J6")
            && error.contains("move all joints"),
        "{error}"
    );
    settings.model.physical = Some(true);
    let found = lab.identify(&geometry(&truth), &settings);
    assert!(
        found.warnings.iter().any(|w| w.contains("the prior decides") && w.contains("J6")),
        "{:?}",
        found.warnings
    );
    // Joint 6 rests, so that nothing shows the inertia of its motor.
    let [rest, moves] = ["motor of joint6 moves (nothing shows it)", "motor of joint2 moves"];
    let open = |part: &str| found.warnings.iter().any(|warning| warning.contains(part));
    assert!(open(rest) && !open(moves), "{:?}", found.warnings);
    let inertia = &found.inertia.diagonal;
    assert!(inertia[5].standard_error.is_infinite(), "{inertia:?}");
    assert!(inertia[1].standard_error < 0.5 * inertia[1].least_squares, "{inertia:?}");
}
