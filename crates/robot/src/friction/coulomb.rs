//! Coulomb friction.

use reachtube_scalar::Lanewise;

/// Speed below which a joint is near standstill, rad/s or m/s. The steps of dry friction are
/// softened there.
pub(crate) const NEAR_STANDSTILL: f64 = 0.02;

/// Load below which [`Coulomb::softened_torque`] passes from braking to driving, in parts of the
/// mean friction at no load.
const NEAR_NO_LOAD: f64 = 0.5;

/// Load-dependent Coulomb friction of one joint: a linear function of the load torque for each
/// motor quadrant, (6) to (9), after Hamon et al. (AIM 2010).
///
/// The quadrants are named by whether the motor drives or brakes. With the conditions as printed in
/// the paper, friction of (6) and (8) would not dissipate (docs/method.md, correction L).
///
/// # Examples
///
/// ```
/// use reachtube_robot::friction::Coulomb;
///
/// let friction = Coulomb::constant(2.0);
/// assert_eq!(friction.torque(-5.0, 0.1), 2.0);
/// assert_eq!(friction.torque(-5.0, 0.0), 0.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coulomb {
    /// q̇ > 0, load > 0: a1 + a2 load.
    pub driving_forward: LoadLine,
    /// q̇ < 0, load < 0: a3 + a4 load.
    pub driving_backward: LoadLine,
    /// q̇ < 0, load ≥ 0: a5 + a6 load.
    pub braking_backward: LoadLine,
    /// q̇ > 0, load ≤ 0: a7 + a8 load.
    pub braking_forward: LoadLine,
}

/// A torque that is linear in the load: offset + slope · load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadLine {
    /// Torque at no load \[N m\].
    pub offset: f64,
    /// Torque per load torque (dimensionless).
    pub slope: f64,
}

impl Coulomb {
    /// Makes friction from the coefficients a1 to a8: offset \[N m\] and slope of driving forward,
    /// driving backward, braking backward and braking forward, in this order.
    pub fn from_coefficients(a: [f64; 8]) -> Self {
        let line = |i: usize| LoadLine { offset: a[i], slope: a[i + 1] };
        Self {
            driving_forward: line(0),
            driving_backward: line(2),
            braking_backward: line(4),
            braking_forward: line(6),
        }
    }

    /// Makes friction of one magnitude \[N m\] against the motion in every quadrant.
    pub fn constant(magnitude: f64) -> Self {
        let (plus, minus) = (magnitude, -magnitude);
        Self::from_coefficients([plus, 0.0, minus, 0.0, minus, 0.0, plus, 0.0])
    }

    /// Returns the friction torque \[N m\] at a load torque \[N m\] and a joint velocity \[rad/s\].
    ///
    /// The torque is 0 at q̇ = 0, because stiction is a set of torques, not a value, and belongs to
    /// the uncertainty. A moving joint without load counts as braking. Over lanes, each lane has
    /// its own quadrant.
    pub fn torque<S: Lanewise>(&self, load: S, qd: S) -> S {
        load.zip(qd, |load, qd| self.torque_in_lane(load, qd))
    }

    /// Returns the friction torque \[N m\] with each quadrant in these parts, as
    /// [`torque`](Self::torque) but without steps, at a load torque \[N m\] and a joint velocity
    /// \[rad/s\]. The parts belong to driving forward, driving backward, braking backward and
    /// braking forward.
    ///
    /// Below 0.02 rad/s or m/s it is in proportion to the velocity. Where the load is smaller than
    /// half of the mean friction at no load, it passes linearly from braking to driving.
    #[must_use]
    pub fn softened_torque(&self, load: f64, qd: f64, parts: [f64; 4]) -> f64 {
        let lines = [
            self.driving_forward,
            self.driving_backward,
            self.braking_backward,
            self.braking_forward,
        ];
        let at = |i: usize| parts[i] * (lines[i].offset + lines[i].slope * load);
        let [driving, braking] = if qd > 0.0 { [at(0), at(3)] } else { [at(1), at(2)] };
        let mean = lines.iter().map(|line| line.offset.abs()).sum::<f64>() / 4.0;
        let near_no_load = (NEAR_NO_LOAD * mean).max(f64::MIN_POSITIVE);
        let share = (0.5 + 0.5 * load * qd.signum() / near_no_load).clamp(0.0, 1.0);
        let moving = (qd.abs() / NEAR_STANDSTILL).min(1.0);
        moving * (braking + share * (driving - braking))
    }

    /// Returns the magnitude of the torque \[N m\] at no load, in the mean over the quadrants; it
    /// is negative if it drives. A torque that is the same in both directions does not count: an
    /// identification takes up constant torques so.
    pub(crate) fn magnitude_at_no_load(&self) -> f64 {
        let forward = self.driving_forward.offset + self.braking_forward.offset;
        let backward = self.driving_backward.offset + self.braking_backward.offset;
        0.25 * (forward - backward)
    }

    /// Returns the torque for one lane.
    fn torque_in_lane(&self, load: f64, qd: f64) -> f64 {
        if qd == 0.0 {
            return 0.0;
        }
        let driving = if qd > 0.0 { load > 0.0 } else { load < 0.0 };
        let line = match (qd > 0.0, driving) {
            (true, true) => self.driving_forward,
            (false, true) => self.driving_backward,
            (false, false) => self.braking_backward,
            (true, false) => self.braking_forward,
        };
        line.offset + line.slope * load
    }
}

#[cfg(test)]
mod tests {
    use super::{Coulomb, NEAR_NO_LOAD, NEAR_STANDSTILL};

    /// Joint 2 of the paper's arm; the lines of driving and braking differ at no load.
    fn friction() -> Coulomb {
        Coulomb::from_coefficients([4.46, 0.086, -5.46, 0.015, -4.64, -0.089, 4.08, -0.027])
    }

    #[test]
    fn softened_friction_is_friction_away_from_its_steps() {
        for load in [-40.0, -3.0, 3.0, 25.0] {
            for qd in [-0.5, -NEAR_STANDSTILL, NEAR_STANDSTILL, 0.3] {
                let (exact, soft) = (friction().torque(load, qd), |parts| {
                    friction().softened_torque(load, qd, parts)
                });
                assert!((soft([1.0; 4]) - exact).abs() < 1e-14, "{load} {qd}");
                assert_eq!(soft([0.0; 4]), 0.0);
            }
        }
        let driving_forward = [0.5, 0.0, 0.0, 0.0];
        let half = friction().softened_torque(3.0, 0.1, driving_forward);
        assert!((half - 0.5 * friction().torque(3.0, 0.1)).abs() < 1e-14);
        assert_eq!(friction().softened_torque(-3.0, 0.1, driving_forward), 0.0);
    }

    #[test]
    fn softened_friction_has_no_steps() {
        let near = NEAR_NO_LOAD * 4.66;
        for qd in [-0.3, 0.3] {
            let at = |load| friction().softened_torque(load, qd, [1.0; 4]);
            let middle = 0.5 * (friction().torque(1e-12, qd) + friction().torque(-1e-12, qd));
            assert!((at(0.0) - middle).abs() < 1e-9);
            for load in [-near, 0.0, near] {
                assert!((at(load - 1e-9) - at(load + 1e-9)).abs() < 1e-8, "{load} {qd}");
            }
        }
        for load in [-8.0, 0.0, 8.0] {
            let at = |qd| friction().softened_torque(load, qd, [1.0; 4]);
            for qd in [-NEAR_STANDSTILL, 0.0, NEAR_STANDSTILL] {
                assert!((at(qd - 1e-12) - at(qd + 1e-12)).abs() < 1e-8, "{load} {qd}");
            }
        }
        assert_eq!(Coulomb::default().softened_torque(0.0, 0.3, [1.0; 4]), 0.0);
    }
}
