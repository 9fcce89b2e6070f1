//! Effects of the virtual robot that its nominal model does not contain.
//!
//! All constants are here. They were chosen so that the recordings spread as those of the real
//! LWA 4P do; none was identified.

use reachtube_robot::{FrictionDescription, JointDescription, Robot};

use crate::error::Result;

/// Temperature of the joints before the first run of a suite \[°C\].
pub(super) const COLD_TEMPERATURE: f64 = 22.0;

/// Temperature at which the virtual robot has the nominal friction \[°C\].
pub(super) const NOMINAL_TEMPERATURE: f64 = 32.0;

/// Warming of a joint by its motion \[K/rad\].
pub(super) const WARMING: f64 = 1.2;

/// Part of the excess over [`COLD_TEMPERATURE`] that a joint loses from one run to the next \[-\].
pub(super) const COOLING: f64 = 0.12;

/// Relative change of Coulomb friction with temperature \[1/K\].
pub(super) const COULOMB_PER_KELVIN: f64 = -0.006;

/// Relative change of viscous friction with temperature \[1/K\].
pub(super) const VISCOUS_PER_KELVIN: f64 = -0.012;

/// Masses, first moments and inertias of the links over the nominal ones \[-\].
pub(super) const LINK_RATIO: f64 = 1.02;

/// Inertias of the motors over the nominal ones \[-\].
pub(super) const MOTOR_RATIO: f64 = 1.03;

/// Amplitude of the torque ripple over the motor torque \[-\]; its period is one motor turn.
pub(super) const RIPPLE_RATIO: f64 = 0.05;

/// Speed at which Coulomb friction reaches tanh(1) of its value \[rad/s\].
pub(super) const STICKING_SPEED: f64 = 0.01;

/// Rise of dry friction toward standstill over Coulomb friction \[-\], where it is asked for.
pub(super) const STRIBECK_RATIO: f64 = 0.3;

/// Stribeck speed of that rise \[rad/s\].
pub(super) const STRIBECK_SPEED: f64 = 0.05;

/// Speed at which the compensation of Coulomb friction reaches tanh(1) of its value \[rad/s\]. It
/// exceeds [`STICKING_SPEED`], so a joint that turns or rests sticks.
pub(super) const COMPENSATION_SPEED: f64 = 0.015;

/// Largest deviation of a run's start from the planned position \[rad\].
pub(super) const POSITION_SCATTER: f64 = 1.5e-3;

/// Largest deviation of a run's start from the planned velocity \[rad/s\].
pub(super) const VELOCITY_SCATTER: f64 = 0.015;

/// Resolution of the position encoders \[rad\]: 17 bit per turn.
pub(super) const ENCODER_STEP: f64 = std::f64::consts::TAU / 131_072.0;

/// Time constant of the low-pass filter \[s\] that turns differences of encoder positions into the
/// recorded velocity.
pub(super) const VELOCITY_FILTER_TIME: f64 = 0.01;

/// Returns the temperature of each joint \[°C\] when run `run` (from 0) of a suite begins. `travel`
/// is the path of each joint in a run and on the way back \[rad\].
///
/// Each run adds the same heat and loses the same part of the excess: the sum of a geometric
/// series.
pub(super) fn temperatures(travel: &[f64], run: usize) -> Vec<f64> {
    let kept = (1.0 - COOLING).powi(run as i32);
    let excess = |travel: &f64| WARMING * travel.abs() * (1.0 - kept) / COOLING;
    travel.iter().map(|travel| COLD_TEMPERATURE + excess(travel)).collect()
}

/// Returns the friction at `temperature` \[°C\] over the nominal friction, for a relative change of
/// `per_kelvin` \[1/K\].
pub(super) fn friction_ratio(temperature: f64, per_kelvin: f64) -> f64 {
    1.0 + per_kelvin * (temperature - NOMINAL_TEMPERATURE)
}

/// Returns the rigid bodies and the viscous friction of the virtual robot at the joints'
/// `temperatures` \[°C\]. Coulomb friction is zero here: the virtual robot adds it with stiction.
pub(super) fn body(nominal: &Robot, temperatures: &[f64]) -> Result<Robot> {
    let mut description = nominal.description().clone();
    for (joint, temperature) in description.joints.iter_mut().zip(temperatures) {
        let ratio = friction_ratio(*temperature, VISCOUS_PER_KELVIN);
        let viscous = joint.friction.viscous.map(|v| v * ratio);
        joint.friction = FrictionDescription { viscous, ..FrictionDescription::default() };
        add_weight(joint);
    }
    Ok(Robot::from_description(&description)?)
}

fn add_weight(joint: &mut JointDescription) {
    joint.mass *= LINK_RATIO;
    joint.inertia = joint.inertia.map(|i| i * LINK_RATIO);
    joint.first_moment = joint.first_moment.map(|h| h.map(|x| x * LINK_RATIO));
    if let Some(gravity) = &mut joint.gravity_moments {
        gravity.mass *= LINK_RATIO;
        gravity.first_moment = gravity.first_moment.map(|x| x * LINK_RATIO);
    }
    joint.armature = joint.armature.map(|a| a * MOTOR_RATIO);
    joint.rotor_inertia = joint.rotor_inertia.map(|i| i * MOTOR_RATIO);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_body_is_heavier_in_every_torque() {
        let nominal = Robot::lwa4p();
        let cold = body(&nominal, &[COLD_TEMPERATURE; 6]).unwrap();
        let (q, qd) = ([0.3, -0.4, 0.5, 0.2, -0.7, 0.1], [0.5; 6]);
        let close =
            |a: f64, b: f64| assert!((a - b).abs() < 1e-12 * (1.0 + b.abs()), "{a} is not {b}");
        for i in 0..6 {
            close(cold.gravity_torque(&q)[i], LINK_RATIO * nominal.gravity_torque(&q)[i]);
            close(
                cold.coriolis_torque(&q, &qd)[i],
                LINK_RATIO * nominal.coriolis_torque(&q, &qd)[i],
            );
            close(cold.viscous_torque(&qd)[i], 1.12 * nominal.viscous_torque(&qd)[i]);
            close(cold.joints()[i].armature, MOTOR_RATIO * nominal.joints()[i].armature);
        }
        assert_eq!(cold.coulomb_torque(&q, &qd).amax(), 0.0);
    }

    #[test]
    fn joints_warm_up_with_their_motion() {
        let runs: Vec<Vec<f64>> = (0..30).map(|run| temperatures(&[2.0, -1.0, 0.0], run)).collect();
        assert_eq!(runs[0], [COLD_TEMPERATURE; 3]);
        assert!(runs.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        for run in &runs {
            assert!(
                (run[0] - COLD_TEMPERATURE - 2.0 * (run[1] - COLD_TEMPERATURE)).abs() < 1e-12
                    && run[2] == COLD_TEMPERATURE
            );
            assert!(run[0] < COLD_TEMPERATURE + WARMING * 2.0 / COOLING);
        }
        let step = runs[5][0] - COLD_TEMPERATURE;
        assert!(
            (runs[6][0] - COLD_TEMPERATURE - (step * (1.0 - COOLING) + WARMING * 2.0)).abs()
                < 1e-12
        );
    }

    #[test]
    fn friction_is_nominal_at_its_temperature_and_falls_with_warmth() {
        assert_eq!(friction_ratio(NOMINAL_TEMPERATURE, VISCOUS_PER_KELVIN), 1.0);
        assert!(
            friction_ratio(40.0, COULOMB_PER_KELVIN) < 1.0
                && friction_ratio(COLD_TEMPERATURE, COULOMB_PER_KELVIN) > 1.0
        );
    }
}
