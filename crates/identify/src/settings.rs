use super::prepare::{LogEntry, PrepareSettings};
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What is identified from which recordings, and how: the settings file of `reachtube identify`.
///
/// # Examples
///
/// ```
/// use reachtube_identify::IdentifySettings;
///
/// let settings = IdentifySettings::from_toml(r#"
///     robot = "arm.urdf"
///     static = ["poses"]
///     dynamic = ["excitation/a.csv", { path = "excitation/b.csv", from = 2.0 }]
///     validate = ["excitation/c.csv"]
///
///     [prepare]
///     cut_off = 5.0
///
///     [model]
///     motor_inertia = false
/// "#, "arm.toml").unwrap();
/// assert_eq!(settings.dynamic.len(), 2);
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct IdentifySettings {
    /// The robot: an embedded name, a TOML or a URDF file.
    pub robot: Option<String>,
    /// Recordings of poses at rest, for gravity.
    #[serde(rename = "static")]
    pub rest: Vec<LogEntry>,
    /// Recordings of one slow joint at a time, for friction (and gravity).
    pub friction: Vec<LogEntry>,
    /// Recordings of exciting motions, for the inertial parameters.
    pub dynamic: Vec<LogEntry>,
    /// Recordings kept back: nothing is fitted to them.
    pub validate: Vec<LogEntry>,
    /// How recordings are prepared.
    pub prepare: PrepareSettings,
    /// What is fitted.
    pub model: ModelSettings,
}

/// What is fitted, and how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ModelSettings {
    /// Whether the torque drives the motors' inertia too: not where it is measured behind the gear.
    pub motor_inertia: bool,
    /// Whether friction is fitted once more, as a change, with the inertial parameters; always
    /// where there are no friction recordings.
    pub refit_friction: bool,
    /// Whether viscous friction has a cubic term where it is fitted with the inertial parameters;
    /// where left out, if there are friction recordings.
    pub cubic: Option<bool>,
    /// Speed below which a joint's torque is not used \[rad/s\], for friction has no value there; 2
    /// % of each joint's high speeds where left out.
    pub slow: Option<f64>,
    /// Speed up to which the robot is at rest \[rad/s\].
    pub rest_speed: f64,
    /// Whether outliers lose weight (Huber); plain least squares otherwise.
    pub robust: bool,
    /// Whether the links must be bodies that can exist.
    pub physical: bool,
    /// What decides where the recordings do not.
    pub prior: Prior,
    /// How much the prior counts: in independent samples a link, roughly.
    pub prior_strength: f64,
    /// Whether gravity keeps mass moments of its own, from the first fit, as in the paper.
    pub separate_gravity: bool,
    /// Lengths of the forward simulations over the recordings kept back \[s\].
    pub windows: Vec<f64>,
}

/// What decides where the recordings leave links open.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Prior {
    /// The links of the robot's description.
    #[default]
    Description,
    /// Balls about the links' origins: the description's links are not used.
    None,
}

impl Default for ModelSettings {
    fn default() -> Self {
        Self {
            motor_inertia: true,
            refit_friction: true,
            cubic: None,
            slow: None,
            rest_speed: 0.01,
            robust: true,
            physical: true,
            prior: Prior::Description,
            prior_strength: 1.0,
            separate_gravity: false,
            windows: vec![0.5, 1.0, 2.0],
        }
    }
}

impl IdentifySettings {
    /// Settings from TOML text; `origin` names it in errors.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] with line and field.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self> {
        let wrong = |error: toml::de::Error| {
            Error::Setting(format!("{origin}: {}", error.to_string().trim_end()))
        };
        toml::from_str(text).map_err(wrong)
    }

    /// Settings from a TOML file.
    ///
    /// # Errors
    ///
    /// [`Error::File`], or as [`IdentifySettings::from_toml`].
    pub fn load(path: &Path) -> Result<Self> {
        let text =
            reachtube_files::read_text(path, "give a settings file as docs/identify.md describes")?;
        Self::from_toml(&text, &path.display().to_string())
    }

    /// Whether the settings fit a robot of so many joints.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] with the value and its limit.
    pub fn validate(&self, joints: usize) -> Result<()> {
        let wrong = |words: String| Err(Error::Setting(words));
        if self.dynamic.is_empty() {
            return wrong(
                "no recordings of exciting motions: name some with --dynamic or dynamic = [..]"
                    .into(),
            );
        }
        let gains = &self.prepare.gains;
        if !gains.is_empty() && gains.len() != joints {
            return wrong(format!(
                "gains: {} given; give one for each of the {joints} joints, in their order",
                gains.len()
            ));
        }
        if let Some(gain) = gains.iter().find(|gain| **gain == 0.0 || !gain.is_finite()) {
            return wrong(format!(
                "gains: {gain} turns no torque into N m; give numbers other than 0"
            ));
        }
        let model = &self.model;
        let positive = [
            ("model.rest_speed", model.rest_speed),
            ("model.prior_strength", model.prior_strength),
        ];
        let slow = model.slow.map(|slow| ("model.slow", slow));
        let windows = model.windows.iter().map(|window| ("model.windows", *window));
        match positive
            .into_iter()
            .chain(slow)
            .chain(windows)
            .find(|(_, value)| !(*value > 0.0 && value.is_finite()))
        {
            Some((name, value)) => wrong(format!("{name} = {value} must be above 0")),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistake_is_found_with_its_line() {
        let error = IdentifySettings::from_toml(
            "dynamic = [\"a.csv\"]\n[model]\nmotorinertia = true\n",
            "s.toml",
        );
        let words = error.unwrap_err().to_string();
        assert!(
            words.contains("s.toml") && words.contains("line 3") && words.contains("motorinertia"),
            "{words}"
        );
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let given = IdentifySettings {
            dynamic: vec![std::path::PathBuf::from("a.csv").into()],
            ..Default::default()
        };
        assert!(given.validate(6).is_ok());
        assert!(
            IdentifySettings::default().validate(6).unwrap_err().to_string().contains("--dynamic")
        );
        let mut gains = given.clone();
        gains.prepare.gains = vec![1.0; 5];
        assert!(gains.validate(6).unwrap_err().to_string().contains("each of the 6 joints"));
        let mut windows = given;
        windows.model.windows = vec![0.0];
        assert!(windows.validate(6).unwrap_err().to_string().contains("above 0"));
    }
}
