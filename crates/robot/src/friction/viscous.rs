//! Viscous friction.

use reachtube_scalar::Scalar;

/// Cubic viscous friction of one joint (5): tau_v = v1 q̇ + v2 q̇² + v3 q̇³ \[N m\], with q̇ in
/// rad/s.
///
/// # Examples
///
/// ```
/// use reachtube_robot::friction::Viscous;
///
/// let friction = Viscous { v1: 2.0, v2: 0.0, v3: -1.0 };
/// assert_eq!(friction.torque(&1.0), 1.0);
/// assert_eq!(friction.slope(&1.0), -1.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Viscous {
    /// Linear coefficient \[N m s/rad\].
    pub v1: f64,
    /// Quadratic coefficient \[N m s²/rad²\]. Its torque has the same sign for both directions of
    /// motion.
    pub v2: f64,
    /// Cubic coefficient \[N m s³/rad³\].
    pub v3: f64,
}

impl Viscous {
    /// Returns tau_v(q̇) \[N m\] by Horner's rule.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure.
    pub fn torque<S: Scalar>(&self, qd: &S) -> S {
        let inner = S::from(self.v2) + S::from(self.v3) * qd.clone();
        (S::from(self.v1) + inner * qd.clone()) * qd.clone()
    }

    /// Returns the lowest speed \[rad/s\] from which on friction falls with speed in either
    /// direction, and `None` if it rises up to `limit` \[rad/s\].
    ///
    /// Friction that rises never drives: its torque is 0 at standstill.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::friction::Viscous;
    ///
    /// let friction = Viscous { v1: 3.0, v2: 0.0, v3: -1.0 };
    /// assert_eq!(friction.falls_beyond(0.9), None);
    /// assert!((friction.falls_beyond(2.0).unwrap() - 1.0).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn falls_beyond(&self, limit: f64) -> Option<f64> {
        let one_way = |b: f64| {
            let (a, c) = (3.0 * self.v3, self.v1);
            let falls = a < 0.0 || b < 0.0;
            if c < 0.0 || (c == 0.0 && falls) {
                return Some(0.0);
            }
            // The first root of the slope c + 2 b s + a s².
            let root = b * b - a * c;
            let first = (falls && root > 0.0).then(|| c / (root.sqrt() - b));
            first.filter(|speed| *speed < limit)
        };
        [self.v2, -self.v2].into_iter().filter_map(one_way).reduce(f64::min)
    }

    /// Returns the derivative d tau_v / d q̇ \[N m s/rad\].
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure.
    pub fn slope<S: Scalar>(&self, qd: &S) -> S {
        let cubic = S::from(3.0) * S::from(self.v3);
        S::from(self.v1) + (S::from(2.0 * self.v2) + cubic * qd.clone()) * qd.clone()
    }
}
