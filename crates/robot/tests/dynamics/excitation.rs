//! Exciting motions: they are within the limits everywhere, reproducible, and better than the
//! motions that the search starts at.

use reachtube_robot::{Criterion, ExcitationSettings, Parameter, ParameterKind, Robot};

fn parameters() -> Vec<Parameter> {
    Parameter::of_joints(
        6,
        &[&ParameterKind::INERTIAL[..], &[ParameterKind::MotorInertia, ParameterKind::Viscous1]]
            .concat(),
    )
}

fn settings() -> ExcitationSettings {
    ExcitationSettings { starts: 2, trials: 300, acceleration: vec![6.0], ..Default::default() }
}

#[test]
fn limits_hold_at_all_times() {
    let robot = Robot::lwa4p();
    let motion = robot.excitation(&parameters(), &settings()).unwrap().trajectory;
    for (i, joint) in robot.joints().iter().enumerate() {
        let ([low, high], [from, to]) = (joint.position_limits, motion.position_range(i));
        let (speed, acceleration) = (motion.speed_bound(i), motion.acceleration_bound(i));
        assert!(
            low <= from && to <= high && speed <= 0.9 * 1.2 + 1e-12 && acceleration <= 6.0 + 1e-12
        );
        // One of the bounds reaches its limit.
        let used = [(to - from) / (0.9 * (high - low)), speed / (0.9 * 1.2), acceleration / 6.0];
        assert!(used.iter().any(|u| *u > 1.0 - 1e-9), "{used:?}");
        for sample in motion.samples(1000.0) {
            assert!(
                (from..=to).contains(&sample.q[i])
                    && sample.qd[i].abs() <= speed
                    && sample.qdd[i].abs() <= acceleration
            );
        }
    }
}

#[test]
fn velocities_and_accelerations_are_derivatives_of_the_positions() {
    let motion = Robot::lwa4p()
        .excitation(&parameters(), &ExcitationSettings { trials: 1, ..settings() })
        .unwrap()
        .trajectory;
    let samples: Vec<_> = motion.samples(1000.0).collect();
    assert_eq!(samples.len(), 10_001);
    for ends in [&samples[0], &samples[10_000]] {
        assert!(ends.qd.iter().chain(&ends.qdd).all(|x| x.abs() < 1e-12), "{ends:?}");
    }
    for w in samples.windows(3).step_by(97) {
        for i in 0..6 {
            let slope = |x: fn(&reachtube_robot::MotionSample) -> &Vec<f64>| {
                (x(&w[2])[i] - x(&w[0])[i]) / 2e-3
            };
            assert!(
                (slope(|s| &s.q) - w[1].qd[i]).abs() < 1e-5
                    && (slope(|s| &s.qd) - w[1].qdd[i]).abs() < 1e-4
            );
        }
    }
}

#[test]
fn the_result_is_reproducible_and_better_than_its_start() {
    let robot = Robot::lwa4p();
    let found = robot.excitation(&parameters(), &settings()).unwrap();
    assert_eq!(found, robot.excitation(&parameters(), &settings()).unwrap());
    // The gain is at least one nat for each of the 46 base parameters.
    assert!(
        found.quality.log_determinant > found.initial_quality.log_determinant + 46.0,
        "{found:?}"
    );
    let other =
        robot.excitation(&parameters(), &ExcitationSettings { seed: 2, ..settings() }).unwrap();
    assert_ne!(found.trajectory, other.trajectory);
    let conditioned = ExcitationSettings { criterion: Criterion::Condition, ..settings() };
    let found = robot.excitation(&parameters(), &conditioned).unwrap();
    assert!(
        found.quality.condition < 0.5 * found.initial_quality.condition,
        "{:?} {:?}",
        found.quality,
        found.initial_quality
    );
}

#[test]
fn settings_outside_their_range_are_refused() {
    let error = |change: fn(&mut ExcitationSettings)| {
        let mut settings = settings();
        change(&mut settings);
        Robot::lwa4p().excitation(&parameters(), &settings).unwrap_err().to_string()
    };
    assert_eq!(error(|s| s.period = 0.0), "period = 0 s is not positive; give a positive time");
    assert_eq!(error(|s| s.harmonics = 1), "harmonics = 1 is too few; give 2 or more");
    assert!(error(|s| s.margin = 1.5).contains("margin = 1.5"));
    assert!(error(|s| s.torque_noise = vec![1.0, 2.0]).contains("give no standard deviation or 6"));
}
