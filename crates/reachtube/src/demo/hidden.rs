//! What the virtual robot has and its nominal model has not. All numbers are here, chosen so that
//! the recordings spread as those of the real LWA 4P do; none was identified.

use reachtube_robot::{FrictionDescription, JointDescription, Robot};

use crate::error::Result;

/// Temperature of the joints before the first run of a suite, °C.
pub(super) const COLD: f64 = 22.0;

/// Temperature at which the nominal friction was identified, °C.
pub(super) const IDENTIFIED_AT: f64 = 32.0;

/// Warming of a joint by moving, K/rad.
pub(super) const WARMING: f64 = 1.2;

/// Part of the excess over [`COLD`] that a joint loses from one run to the next.
pub(super) const COOLING: f64 = 0.12;

/// Change of Coulomb friction with temperature, 1/K.
pub(super) const COULOMB_PER_KELVIN: f64 = -0.006;

/// Change of viscous friction with temperature, 1/K.
pub(super) const VISCOUS_PER_KELVIN: f64 = -0.012;

/// Masses, mass moments and inertias of the links, over the nominal ones.
pub(super) const LINK_SHARE: f64 = 1.02;

/// Inertias of the motors, over the nominal ones.
pub(super) const ARMATURE_SHARE: f64 = 1.03;

/// Amplitude of the torque ripple over the motor's torque; one period a motor turn.
pub(super) const RIPPLE_SHARE: f64 = 0.05;

/// Speed at which Coulomb friction has come to tanh 1 of its value, rad/s.
pub(super) const STICKING_SPEED: f64 = 0.01;

/// The same for its compensation. It comes later than the friction, so a joint that turns or rests
/// sticks.
pub(super) const COMPENSATION_SPEED: f64 = 0.015;

/// Half the width of the scatter of a run's start about the planned one, rad.
pub(super) const SCATTER_Q: f64 = 1.5e-3;

/// The same for the velocity, rad/s.
pub(super) const SCATTER_QD: f64 = 0.015;

/// Resolution of the position encoders (17 bit a turn), rad.
pub(super) const ENCODER_STEP: f64 = std::f64::consts::TAU / 131_072.0;

/// Time constant of the low-pass over the differences of the encoder's positions that is recorded
/// as velocity, s.
pub(super) const VELOCITY_FILTER: f64 = 0.01;

/// Temperature of each joint, °C, when run `run` (from 0) of a suite begins. `travel` is what a run
/// moves each joint, rad: there and back.
///
/// Each run adds the same heat and loses the same part of the excess: the sum of a geometric
/// series.
pub(super) fn temperatures(travel: &[f64], run: usize) -> Vec<f64> {
    let kept = (1.0 - COOLING).powi(run as i32);
    travel.iter().map(|travel| COLD + WARMING * travel.abs() * (1.0 - kept) / COOLING).collect()
}

/// Friction at `temperature` over the nominal friction.
pub(super) fn friction_share(temperature: f64, per_kelvin: f64) -> f64 {
    1.0 + per_kelvin * (temperature - IDENTIFIED_AT)
}

/// The rigid bodies and viscous friction of the virtual robot at `temperatures`. It has no Coulomb
/// friction: that is the drive's.
pub(super) fn body(nominal: &Robot, temperatures: &[f64]) -> Result<Robot> {
    let mut description = nominal.description().clone();
    for (joint, temperature) in description.joints.iter_mut().zip(temperatures) {
        let share = friction_share(*temperature, VISCOUS_PER_KELVIN);
        let viscous = joint.friction.viscous.map(|v| v * share);
        joint.friction = FrictionDescription { coulomb: [0.0; 8], viscous };
        add_weight(joint);
    }
    Ok(Robot::from_description(&description)?)
}

fn add_weight(joint: &mut JointDescription) {
    joint.mass *= LINK_SHARE;
    joint.inertia = joint.inertia.map(|i| i * LINK_SHARE);
    joint.first_moment = joint.first_moment.map(|h| h.map(|x| x * LINK_SHARE));
    if let Some(gravity) = &mut joint.gravity_moments {
        gravity.mass *= LINK_SHARE;
        gravity.first_moment = gravity.first_moment.map(|x| x * LINK_SHARE);
    }
    joint.armature = joint.armature.map(|a| a * ARMATURE_SHARE);
    joint.rotor_inertia = joint.rotor_inertia.map(|i| i * ARMATURE_SHARE);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_body_is_heavier_in_every_torque() {
        let nominal = Robot::lwa4p();
        let cold = body(&nominal, &[COLD; 6]).unwrap();
        let (q, qd) = ([0.3, -0.4, 0.5, 0.2, -0.7, 0.1], [0.5; 6]);
        let close =
            |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{a} is not {b}");
        for i in 0..6 {
            close(cold.gravity_torque(&q)[i], LINK_SHARE * nominal.gravity_torque(&q)[i]);
            close(
                cold.coriolis_torque(&q, &qd)[i],
                LINK_SHARE * nominal.coriolis_torque(&q, &qd)[i],
            );
            close(cold.viscous_torque(&qd)[i], 1.12 * nominal.viscous_torque(&qd)[i]);
            close(cold.joints()[i].armature, ARMATURE_SHARE * nominal.joints()[i].armature);
        }
        assert_eq!(cold.coulomb_torque(&q, &qd).amax(), 0.0);
    }

    #[test]
    fn joints_warm_up_with_what_they_move() {
        let runs: Vec<Vec<f64>> = (0..30).map(|run| temperatures(&[2.0, -1.0, 0.0], run)).collect();
        assert_eq!(runs[0], [COLD; 3]);
        assert!(runs.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        for run in &runs {
            assert!((run[0] - COLD - 2.0 * (run[1] - COLD)).abs() < 1e-12 && run[2] == COLD);
            assert!(run[0] < COLD + WARMING * 2.0 / COOLING);
        }
        let step = runs[5][0] - COLD;
        assert!((runs[6][0] - COLD - (step * (1.0 - COOLING) + WARMING * 2.0)).abs() < 1e-12);
    }

    #[test]
    fn friction_is_nominal_where_it_was_identified_and_falls_with_warmth() {
        assert_eq!(friction_share(IDENTIFIED_AT, VISCOUS_PER_KELVIN), 1.0);
        assert!(
            friction_share(40.0, COULOMB_PER_KELVIN) < 1.0
                && friction_share(COLD, COULOMB_PER_KELVIN) > 1.0
        );
    }
}
