//! Viscous friction must rise with speed up to a velocity that its joint may reach.
//!
//! With the number x of v1, and the number y of v2 and v3, the slope is
//! v1 e^x + (1 + y) (2 v2 s + 3 v3 s²). It is at least 0 at all |s| <= L if and only if
//! e^x >= c (1 + y), where c is the largest fall of the second part by v1. Then x >= ln(c (1 + y)),
//! and the tangent of the concave right side lies above it: each step of a fit keeps to a tangent,
//! and so to the condition itself.

/// Speed up to which friction must rise without a velocity limit, in parts of the highest speed
/// that it was fitted on.
pub(crate) const BEYOND_FITTED: f64 = 2.0;

/// A tangent touches where 1 + y is at least this.
const LEAST_FACTOR: f64 = 0.05;

/// Room for rounding, relative to c.
const ROOM: f64 = 1e-9;

/// The condition on the friction of one joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RisingFriction {
    /// Index of the parameter of v1; `None` if it is not fitted.
    linear: Option<usize>,
    /// Index of the parameter of v2 and v3.
    cubic: Option<usize>,
    /// The largest fall c of the slope by v2 and v3, in parts of v1.
    fall: f64,
}

impl RisingFriction {
    /// Returns the condition on a joint with coefficients `viscous` and a limit, rad/s, from the
    /// parameters of v1, and of v2 and v3; `None` if none of them is fitted, or friction rises
    /// whatever they are.
    pub(crate) fn new(
        [linear, cubic]: [Option<usize>; 2],
        [v1, v2, v3]: [f64; 3],
        limit: f64,
    ) -> Option<Self> {
        let vertex = (-v2 / (3.0 * v3)).abs();
        let least = match v3 > 0.0 && vertex < limit {
            true => -v2 * v2 / (3.0 * v3),
            false => 3.0 * v3 * limit * limit - 2.0 * v2.abs() * limit,
        };
        let fall = (1.0 + ROOM) * -least / v1;
        // More of v1 alone would not mend a cubic that falls, but brake at every speed.
        let is_fitted = cubic.is_some() || (linear.is_some() && fall <= 1.0);
        (is_fitted && v1 > 0.0 && fall > 0.0).then_some(Self { linear, cubic, fall })
    }

    /// Moves numbers to friction that rises, with less of v2 and v3.
    pub(crate) fn start(&self, numbers: &mut [f64]) {
        if let Some(cubic) = self.cubic.filter(|_| self.fall > 1.0) {
            numbers[cubic] = 1.0 / self.fall - 1.0;
        }
    }

    /// Returns the tangent of the condition about `numbers`: the sum of the entries (parameter,
    /// factor) is at most the bound.
    pub(crate) fn tangent(&self, numbers: &[f64]) -> (Vec<(usize, f64)>, f64) {
        let factor = self.cubic.map_or(1.0, |cubic| 1.0 + numbers[cubic]).max(LEAST_FACTOR);
        let entries = self.linear.map(|linear| (linear, -1.0));
        let entries = entries.into_iter().chain(self.cubic.map(|cubic| (cubic, 1.0 / factor)));
        let touched = if self.cubic.is_some() { (factor - 1.0) / factor } else { 0.0 };
        (entries.collect(), touched - (self.fall * factor).ln())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use reachtube_robot::friction::Viscous;

    const BOTH: [Option<usize>; 2] = [Some(0), Some(1)];

    fn rises([v1, v2, v3]: [f64; 3], [x, y]: [f64; 2]) -> bool {
        let (v1, v2, v3) = (v1 * x.exp(), v2 * (1.0 + y), v3 * (1.0 + y));
        Viscous { v1, v2, v3 }.falls_beyond(2.0).is_none()
    }

    #[test]
    fn what_keeps_to_a_tangent_rises() {
        for viscous in [[3.0, 0.0, -0.2], [3.0, 0.7, -0.1], [3.0, -1.5, 0.4]] {
            let condition = RisingFriction::new(BOTH, viscous, 2.0).unwrap();
            let at = |k: usize| 0.05 * k as f64 - 1.0;
            let mut kept = 0;
            for about in (0..80).map(at) {
                let (entries, bound) = condition.tangent(&[0.0, about]);
                for (x, y) in (0..60).flat_map(|i| (0..80).map(move |j| (at(i), at(j)))) {
                    let sum: f64 = entries.iter().map(|(p, a)| a * [x, y][*p]).sum();
                    if sum <= bound {
                        assert!(rises(viscous, [x, y]), "{viscous:?}: {x} {y} about {about}");
                        kept += 1;
                    }
                }
            }
            assert!(kept > 1000, "{kept}");
        }
    }

    #[test]
    fn a_fit_starts_from_friction_that_rises() {
        let falling = [3.0, 0.2, -0.9];
        assert!(!rises(falling, [0.0, 0.0]));
        let condition = RisingFriction::new(BOTH, falling, 2.0).unwrap();
        let mut numbers = [0.0, 0.0];
        condition.start(&mut numbers);
        assert!(rises(falling, numbers) && numbers[1] > -1.0, "{numbers:?}");
        assert_eq!(RisingFriction::new([Some(0), None], falling, 2.0), None);
        assert_eq!(RisingFriction::new(BOTH, [3.0, 0.0, 0.4], 2.0), None);
    }
}
