use reachtube_robot::{Joint, Robot};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::limits::is_within;

/// The point about which the forward dynamics is expanded, one value per joint for each of q, q̇
/// and u. The paper's point is 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpansionPoint {
    /// Positions q_a, n, rad.
    pub q: Vec<f64>,
    /// Velocities q̇_a, n, rad/s.
    pub qd: Vec<f64>,
    /// Inputs u_a, n, N m; empty stands for 0. Models that are linear in u do not depend on it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub u: Vec<f64>,
}

impl ExpansionPoint {
    /// Returns the point q_a = 0, q̇_a = 0, u_a = 0.
    #[must_use]
    pub fn zero(joints: usize) -> Self {
        Self { q: vec![0.0; joints], qd: vec![0.0; joints], u: Vec::new() }
    }

    /// Returns the point with the given values: n positions (rad), then n velocities (rad/s), then
    /// n inputs (N m). Velocities and inputs may be missing, and then are 0. No value at all gives
    /// [`zero`](Self::zero).
    ///
    /// # Errors
    ///
    /// [`Error::ExpansionPointValue`] for a value that is not finite, and
    /// [`Error::ExpansionPointSize`] for another number of values than 0, n, 2n or 3n.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_abstraction::ExpansionPoint;
    ///
    /// let point = ExpansionPoint::from_values(&[0.1, 0.2], 2)?;
    /// assert_eq!((point.qd, point.q), (vec![0.0; 2], vec![0.1, 0.2]));
    /// # Ok::<(), reachtube_abstraction::Error>(())
    /// ```
    pub fn from_values(values: &[f64], joints: usize) -> Result<Self> {
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(Error::ExpansionPointValue { number: index + 1, value: values[index] });
        }
        let parts = |count: usize| values.len() == count * joints;
        if values.is_empty() {
            return Ok(Self::zero(joints));
        }
        if !(parts(1) || parts(2) || parts(3)) {
            return Err(Error::ExpansionPointSize { values: values.len(), joints });
        }
        let mut point = Self::zero(joints);
        point.q.copy_from_slice(&values[..joints]);
        if let Some(qd) = values.get(joints..2 * joints) {
            point.qd.copy_from_slice(qd);
        }
        point.u = values.get(2 * joints..).unwrap_or_default().to_vec();
        Ok(point)
    }

    /// Returns the index of the first joint whose position is beyond its limits; `None` if all are
    /// within.
    #[must_use]
    pub fn beyond_limits(&self, robot: &Robot) -> Option<usize> {
        let is_within = |(q, joint): (&f64, &Joint)| is_within([*q; 2], joint.position_limits);
        self.q.iter().zip(robot.joints()).position(|side| !is_within(side))
    }

    /// Returns the inputs u_a, n, N m.
    #[must_use]
    pub fn input(&self) -> Vec<f64> {
        if self.u.is_empty() { vec![0.0; self.q.len()] } else { self.u.clone() }
    }
}
