//! Coulomb friction.

use reachtube_scalar::Lanewise;

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
