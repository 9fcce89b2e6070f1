use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Where the forward dynamics is expanded: positions q_a (rad), velocities q̇_a (rad/s) and inputs
/// u_a (N m), one entry a joint. The paper's is 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpansionPoint {
    /// Positions q_a, rad.
    pub q: Vec<f64>,
    /// Velocities q̇_a, rad/s.
    pub qd: Vec<f64>,
    /// Inputs u_a, N m; empty for 0. Models that are linear in u do not depend on it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub u: Vec<f64>,
}

impl ExpansionPoint {
    /// q_a = 0, q̇_a = 0, u_a = 0.
    pub fn zero(joints: usize) -> Self {
        Self { q: vec![0.0; joints], qd: vec![0.0; joints], u: Vec::new() }
    }

    /// From n positions, n positions and n velocities, or those and n inputs.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] for another number of values, or one that is not finite.
    pub fn from_values(values: &[f64], joints: usize) -> Result<Self> {
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(Error::Setting(format!(
                "the expansion point holds {value}; give finite numbers"
            )));
        }
        let parts = |count: usize| values.len() == count * joints;
        if values.is_empty() {
            return Ok(Self::zero(joints));
        }
        if !(parts(1) || parts(2) || parts(3)) {
            return Err(Error::Setting(format!(
                "the expansion point has {} values; the robot has {joints} joints, so give {joints} positions in rad, {} values: positions, then \
                 velocities in rad/s, or {} values: then also inputs in N m",
                values.len(),
                2 * joints,
                3 * joints
            )));
        }
        let mut point = Self::zero(joints);
        point.q.copy_from_slice(&values[..joints]);
        if let Some(qd) = values.get(joints..2 * joints) {
            point.qd.copy_from_slice(qd);
        }
        point.u = values.get(2 * joints..).unwrap_or_default().to_vec();
        Ok(point)
    }

    /// u_a, one entry a joint.
    pub fn input(&self) -> Vec<f64> {
        if self.u.is_empty() { vec![0.0; self.q.len()] } else { self.u.clone() }
    }
}
