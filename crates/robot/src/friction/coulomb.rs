use reachtube_scalar::Lanewise;

/// Load-dependent Coulomb friction of one joint: a straight line in the load torque for each motor
/// quadrant, eqs. (6) to (9), after Hamon et al. (AIM 2010).
///
/// The quadrants are named by what the motor does, so that friction dissipates: as printed, (6) and
/// (8) would let it push the joint along.
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

/// A torque linear in the load: offset + slope · load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadLine {
    /// Torque at no load \[N m\].
    pub offset: f64,
    /// Torque per load torque (dimensionless).
    pub slope: f64,
}

impl Coulomb {
    /// The coefficients a1 to a8: offset \[N m\] and slope of driving forward, driving backward,
    /// braking backward and braking forward, in this order.
    pub fn from_coefficients(a: [f64; 8]) -> Self {
        let line = |i: usize| LoadLine { offset: a[i], slope: a[i + 1] };
        Self {
            driving_forward: line(0),
            driving_backward: line(2),
            braking_backward: line(4),
            braking_forward: line(6),
        }
    }

    /// The same magnitude \[N m\] against the motion in every quadrant.
    pub fn constant(magnitude: f64) -> Self {
        let (plus, minus) = (magnitude, -magnitude);
        Self::from_coefficients([plus, 0.0, minus, 0.0, minus, 0.0, plus, 0.0])
    }

    /// Friction torque \[N m\] at a load torque \[N m\] and a joint velocity \[rad/s\].
    ///
    /// At q̇ = 0 it is 0: stiction is a set of torques, not a value, and belongs to the
    /// uncertainty. At zero load the joint brakes, by the convention of the fields. Over lanes each
    /// has its own quadrant.
    pub fn torque<S: Lanewise>(&self, load: S, qd: S) -> S {
        load.zip(qd, |load, qd| self.of_lane(load, qd))
    }

    fn of_lane(&self, load: f64, qd: f64) -> f64 {
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
