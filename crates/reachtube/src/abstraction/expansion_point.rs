use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Where the forward dynamics is expanded: positions q_a (rad) and velocities q̇_a (rad/s), one entry a joint. The paper's is 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExpansionPoint {
    /// Positions q_a, rad.
    pub q: Vec<f64>,
    /// Velocities q̇_a, rad/s.
    pub qd: Vec<f64>,
}

impl ExpansionPoint {
    /// q_a = 0, q̇_a = 0.
    pub fn zero(joints: usize) -> Self {
        Self { q: vec![0.0; joints], qd: vec![0.0; joints] }
    }

    /// From n positions, or n positions and n velocities.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] for another number of values, or one that is not finite.
    pub fn from_values(values: &[f64], joints: usize) -> Result<Self> {
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(Error::Setting(format!("the expansion point holds {value}; give finite numbers")));
        }
        match values.len() {
            0 => Ok(Self::zero(joints)),
            given if given == joints => Ok(Self { q: values.to_vec(), qd: vec![0.0; joints] }),
            given if given == 2 * joints => {
                Ok(Self { q: values[..joints].to_vec(), qd: values[joints..].to_vec() })
            }
            given => Err(Error::Setting(format!(
                "the expansion point has {given} values; the robot has {joints} joints, so give {joints} positions in rad, or {} \
                 values: positions, then velocities in rad/s",
                2 * joints
            ))),
        }
    }
}
