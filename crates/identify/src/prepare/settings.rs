use reachtube_recordings::{ColumnSettings, GapLimit, LogSettings, Torque};
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Settings of how recordings are prepared.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PrepareSettings {
    /// Names of the robot's joints in the order of the recordings' columns.
    ///
    /// An empty list stands for the robot's own order.
    pub joints: Vec<String>,
    /// Factors that multiply the recorded torques, one per joint in the robot's order.
    ///
    /// They have the unit N m/A where currents were recorded. An empty list stands for 1.
    pub gains: Vec<f64>,
    /// Cut-off frequency of the low-pass \[Hz\]; by default it is chosen from the recordings.
    pub cut_off: Option<f64>,
    /// Source of the velocity.
    pub velocity: VelocitySource,
    /// Longest allowed time between samples \[s\].
    ///
    /// By default it is 1.9 times the usual time at a fixed rate, and 10 times the usual time where
    /// the sample times jitter.
    pub max_gap: Option<f64>,
    /// The kind of the recorded torques if they are compensated; motor torques by default.
    ///
    /// Torques behind the gear, `link`, do not drive the motors' inertia, and become the input of a
    /// robot without `armature`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<Torque>,
    /// Columns of recordings as robots and drivers log them, if their names are ambiguous.
    #[serde(skip_serializing_if = "is_default")]
    pub columns: ColumnSettings,
    /// Topics, joints and times of MCAP and rosbag2 logs, if the logs are ambiguous.
    #[serde(skip_serializing_if = "is_default")]
    pub log: LogSettings,
}

impl PrepareSettings {
    /// Returns the gain of each of a robot's joints, which is 1 if none are given.
    ///
    /// # Errors
    ///
    /// [`Error::GainCount`] and [`Error::Gain`].
    pub fn gain_of_each_joint(&self, joints: usize) -> Result<Vec<f64>> {
        gain_of_each_joint(&self.gains, joints)
    }

    pub(crate) fn gap_limit(&self) -> GapLimit {
        self.max_gap.into()
    }
}

/// Does what [`PrepareSettings::gain_of_each_joint`] does for the gains `given`.
pub(crate) fn gain_of_each_joint(given: &[f64], joints: usize) -> Result<Vec<f64>> {
    if given.is_empty() {
        return Ok(vec![1.0; joints]);
    }
    if given.len() != joints {
        return Err(Error::GainCount { given: given.len(), joints });
    }
    match given.iter().position(|gain| *gain == 0.0 || !gain.is_finite()) {
        Some(joint) => Err(Error::Gain { number: joint + 1, gain: given[joint] }),
        None => Ok(given.to_vec()),
    }
}

fn is_default<T: Default + PartialEq>(settings: &T) -> bool {
    *settings == T::default()
}

/// The source of a log's velocity.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum VelocitySource {
    /// The source from which the low-pass removes less, chosen for each log; the position, if the
    /// recorded velocity lags it by more than a sample time.
    #[default]
    Quieter,
    /// The recorded velocity.
    Recorded,
    /// The derivative of the filtered position.
    Differentiated,
}

#[cfg(test)]
mod tests {
    use super::PrepareSettings;

    #[test]
    fn gains_are_one_for_each_joint() {
        let check = |gains: &[f64]| {
            let settings = PrepareSettings { gains: gains.into(), ..PrepareSettings::default() };
            settings.gain_of_each_joint(2).map_err(|error| error.to_string())
        };
        assert_eq!(check(&[]), Ok(vec![1.0; 2]));
        assert_eq!(check(&[-1.0, 2.5]), Ok(vec![-1.0, 2.5]));
    }
}
