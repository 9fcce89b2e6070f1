//! The user's assignment of the columns of logs if their names are ambiguous.

use std::str::FromStr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::unit::{AngleUnit, TimeUnit};

/// The columns of logs, if their names are ambiguous: the table `columns` of the settings.
///
/// A name is the header of a column with `{}` in place of the number of the joint.
///
/// # Examples
///
/// ```
/// use reachtube_recordings::ColumnSettings;
///
/// let columns: ColumnSettings = "q=pos_{},tau=m{}_nm,first=0".parse()?;
/// assert_eq!(columns.q.as_deref(), Some("pos_{}"));
/// assert_eq!(columns.first, Some(0));
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ColumnSettings {
    /// Positions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub q: Option<String>,
    /// Commanded positions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub r: Option<String>,
    /// Velocities.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub qd: Option<String>,
    /// Torques.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tau: Option<String>,
    /// Motor currents, which the gains turn into torques.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub current: Option<String>,
    /// Name of the column with the time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// Rate of evenly spaced samples that have no time, Hz.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rate: Option<f64>,
    /// Number of the first joint in the names, usually 0 or 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first: Option<usize>,
    /// Unit of the time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_unit: Option<TimeUnit>,
    /// Unit of positions and velocities of revolute joints.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle: Option<AngleUnit>,
}

impl ColumnSettings {
    /// Returns the names with `{}` that are given, each with the name of its setting.
    pub(super) fn patterns(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let Self { q, r, qd, tau, current, .. } = self;
        [("q", q), ("r", r), ("qd", qd), ("tau", tau), ("current", current)]
            .into_iter()
            .filter_map(|(key, pattern)| Some((key, pattern.as_deref()?)))
    }
}

impl FromStr for ColumnSettings {
    type Err = String;

    /// Reads `KEY=VALUE,..` with the keys of the table.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut out = Self::default();
        for part in text.split(',').filter(|part| !part.trim().is_empty()) {
            let (key, value) = part.split_once('=').ok_or_else(|| {
                format!("\"{part}\" is not KEY=VALUE; write for example q=pos_{{}},first=0")
            })?;
            let value = value.trim();
            match key.trim() {
                "q" => out.q = Some(value.into()),
                "r" => out.r = Some(value.into()),
                "qd" => out.qd = Some(value.into()),
                "tau" => out.tau = Some(value.into()),
                "current" => out.current = Some(value.into()),
                "time" => out.time = Some(value.into()),
                "rate" => {
                    let rate: Option<f64> = value.parse().ok().filter(|rate| *rate > 0.0);
                    let wrong = || format!("rate={value} is no rate above 0 Hz");
                    out.rate = Some(rate.filter(|rate| rate.is_finite()).ok_or_else(wrong)?);
                }
                "first" => {
                    let number = value.parse();
                    out.first = Some(number.map_err(|_| format!("first={value} is no number"))?);
                }
                "time_unit" => out.time_unit = Some(value.parse()?),
                "angle" => out.angle = Some(value.parse()?),
                other => {
                    return Err(format!(
                        "there is no key \"{other}\"; the keys are q, r, qd, tau, current, \
                         time, rate, first, time_unit and angle"
                    ));
                }
            }
        }
        Ok(out)
    }
}

#[cfg(test)]
mod tests {
    use super::ColumnSettings;
    use crate::reading::unit::{AngleUnit, TimeUnit};

    #[test]
    fn text_and_table_mean_the_same() {
        let text = "q=pos_{}, qd = vel_{},time=clock,first=0,time_unit=ms,angle=deg,rate=125";
        let columns: ColumnSettings = text.parse().unwrap();
        assert_eq!(columns.qd.as_deref(), Some("vel_{}"));
        assert_eq!(columns.time.as_deref(), Some("clock"));
        assert_eq!(columns.time_unit, Some(TimeUnit::Milliseconds));
        assert_eq!((columns.angle, columns.rate), (Some(AngleUnit::Degrees), Some(125.0)));
        for wrong in ["q", "speed=x", "first=x", "time_unit=h", "angle=grad", "rate=0", "rate=x"] {
            assert!(wrong.parse::<ColumnSettings>().is_err(), "{wrong}");
        }
    }
}
