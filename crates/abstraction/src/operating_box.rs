use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::expansion_point::ExpansionPoint;
use crate::limits::is_within;

/// The positions, velocities and inputs over which a bound holds: one interval \[low, high\] per
/// joint for each.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OperatingBox {
    /// Positions q, n, rad or m.
    pub q: Vec<[f64; 2]>,
    /// Velocities q̇, n, rad/s or m/s.
    pub qd: Vec<[f64; 2]>,
    /// Inputs u, n, N m or N.
    pub u: Vec<[f64; 2]>,
}

impl OperatingBox {
    /// Returns the box about an expansion point with the given radii: 3 (one for all positions in
    /// rad, one for all velocities in rad/s, one for all inputs in N m) or 3n (one per joint for
    /// each).
    ///
    /// # Errors
    ///
    /// [`Error::Radius`] for a radius that is negative or not finite, and [`Error::RadiusCount`]
    /// for another number of radii.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_abstraction::{ExpansionPoint, OperatingBox};
    ///
    /// let operating_box = OperatingBox::about(&ExpansionPoint::zero(2), &[0.5, 1.0, 20.0])?;
    /// assert_eq!(operating_box.q, [[-0.5, 0.5]; 2]);
    /// # Ok::<(), reachtube_abstraction::Error>(())
    /// ```
    pub fn about(point: &ExpansionPoint, radii: &[f64]) -> Result<Self> {
        let n = point.q.len();
        if let Some(index) = radii.iter().position(|r| !(r.is_finite() && *r >= 0.0)) {
            return Err(Error::Radius { number: index + 1, value: radii[index] });
        }
        let radius = |group: usize, i: usize| match radii.len() {
            3 => Some(radii[group]),
            given if given == 3 * n => Some(radii[group * n + i]),
            _ => None,
        };
        let sides = |group: usize, centre: &[f64]| -> Option<Vec<[f64; 2]>> {
            let side = |(i, c): (usize, &f64)| radius(group, i).map(|r| [c - r, c + r]);
            centre.iter().enumerate().map(side).collect()
        };
        match (sides(0, &point.q), sides(1, &point.qd), sides(2, &point.input())) {
            (Some(q), Some(qd), Some(u)) => Ok(Self { q, qd, u }),
            _ => Err(Error::RadiusCount { radii: radii.len(), joints: n }),
        }
    }

    /// Returns (q, q̇, u) as 3n intervals.
    ///
    /// # Guarantee
    ///
    /// Exact: the ends are the ends of the box.
    #[must_use]
    pub(crate) fn sides(&self) -> Vec<Interval> {
        let all = self.q.iter().chain(&self.qd).chain(&self.u);
        all.map(|[low, high]| Interval::point(*low).hull(Interval::point(*high))).collect()
    }

    /// Returns whether the box has `n` intervals for each of q, q̇ and u, with finite ends in
    /// order.
    #[must_use]
    pub fn is_valid_for(&self, n: usize) -> bool {
        let valid = |sides: &[[f64; 2]]| {
            sides.len() == n
                && sides
                    .iter()
                    .all(|[low, high]| low <= high && low.is_finite() && high.is_finite())
        };
        valid(&self.q) && valid(&self.qd) && valid(&self.u)
    }

    /// Checks that the box fits this robot and lies within its limits.
    pub(crate) fn check(&self, robot: &Robot) -> Result<()> {
        let n = robot.joint_count();
        if !self.is_valid_for(n) {
            return Err(Error::BoxSize { joints: n });
        }
        for (i, joint) in robot.joints().iter().enumerate() {
            let inside = |quantity, unit, side, limits| {
                let joint = joint.name.clone();
                let beyond = Error::BeyondLimits { joint, quantity, unit, side, limits };
                is_within(side, limits).then_some(()).ok_or(beyond)
            };
            let kind = joint.kind;
            inside("positions", kind.position_unit(), self.q[i], joint.position_limits)?;
            if let Some(limit) = joint.velocity_limit {
                inside("velocities", kind.velocity_unit(), self.qd[i], [-limit, limit])?;
            }
        }
        Ok(())
    }
}
