//! Where a robot is operated.

use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use serde::{Deserialize, Serialize};

use super::ExpansionPoint;
use crate::error::{Error, Result};

/// Positions, velocities and inputs that a bound holds for, each \[low, high\], one entry a joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OperatingBox {
    /// q, rad.
    pub q: Vec<[f64; 2]>,
    /// q̇, rad/s.
    pub qd: Vec<[f64; 2]>,
    /// u, N m.
    pub u: Vec<[f64; 2]>,
}

impl OperatingBox {
    /// The box about an expansion point with the given radii: 3 (for all positions in rad,
    /// velocities in rad/s and inputs in N m) or 3n.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] for another number of radii, or one that is negative or not finite.
    pub fn about(point: &ExpansionPoint, radii: &[f64]) -> Result<Self> {
        let n = point.q.len();
        if let Some(radius) = radii.iter().find(|radius| !(radius.is_finite() && **radius >= 0.0)) {
            return Err(Error::Setting(format!(
                "a radius of the box is {radius}; give finite numbers, 0 or more"
            )));
        }
        let radius = |group: usize, i: usize| match radii.len() {
            3 => Some(radii[group]),
            given if given == 3 * n => Some(radii[group * n + i]),
            _ => None,
        };
        let sides = |group: usize, center: &[f64]| -> Option<Vec<[f64; 2]>> {
            let side = |(i, c): (usize, &f64)| radius(group, i).map(|r| [c - r, c + r]);
            center.iter().enumerate().map(side).collect()
        };
        match (sides(0, &point.q), sides(1, &point.qd), sides(2, &point.input())) {
            (Some(q), Some(qd), Some(u)) => Ok(Self { q, qd, u }),
            _ => Err(Error::Setting(format!(
                "{} radii of the box; give 3 (positions in rad, velocities in rad/s, inputs in N m) or {}",
                radii.len(),
                3 * n
            ))),
        }
    }

    /// (q, q̇, u) as intervals.
    pub fn sides(&self) -> Vec<Interval> {
        let all = self.q.iter().chain(&self.qd).chain(&self.u);
        all.map(|[low, high]| Interval::point(*low).hull(Interval::point(*high))).collect()
    }

    /// Returns whether the box is one of `n` joints, with finite ends in order.
    #[must_use]
    pub fn is_of(&self, n: usize) -> bool {
        let is = |sides: &[[f64; 2]]| {
            sides.len() == n
                && sides
                    .iter()
                    .all(|[low, high]| low <= high && low.is_finite() && high.is_finite())
        };
        is(&self.q) && is(&self.qd) && is(&self.u)
    }

    /// Whether it is a box of this robot, within its limits.
    pub(super) fn check(&self, robot: &Robot) -> Result<()> {
        let n = robot.joint_count();
        if !self.is_of(n) {
            return Err(Error::Setting(format!(
                "the operating box has not one finite interval a joint for each of q, qd and u; there are {n} joints"
            )));
        }
        for (i, joint) in robot.joints().iter().enumerate() {
            let outside = |what: &str, side: [f64; 2], limits: [f64; 2], unit: &str| {
                Err(Error::Setting(format!(
                    "joint `{}`: the box has {what} in [{}, {}] {unit}, beyond the limits [{}, {}] of the robot; choose a smaller box",
                    joint.name, side[0], side[1], limits[0], limits[1]
                )))
            };
            let within = |side: [f64; 2], limits: [f64; 2]| {
                let slack = 1e-9 * (limits[1] - limits[0]).abs();
                side[0] >= limits[0] - slack && side[1] <= limits[1] + slack
            };
            if !within(self.q[i], joint.position_limits) {
                return outside("positions", self.q[i], joint.position_limits, "rad");
            }
            if let Some(limit) =
                joint.velocity_limit.filter(|limit| !within(self.qd[i], [-limit, *limit]))
            {
                return outside("velocities", self.qd[i], [-limit, limit], "rad/s");
            }
        }
        Ok(())
    }
}
