use crate::error::{Error, Result};
use crate::prepare::entry::LogEntry;
use crate::prepare::settings::PrepareSettings;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Settings of an identification: the recordings, their preparation and the model.
///
/// The settings file of `reachtube identify` has this form.
///
/// # Examples
///
/// ```
/// use reachtube_identify::IdentifySettings;
///
/// let settings = IdentifySettings::from_toml(r#"
///     robot = "arm.urdf"
///     rest = ["poses"]
///     excitation = ["excitation/a.csv", { path = "excitation/b.csv", from = 2.0 }]
///     validate = ["excitation/c.csv"]
///
///     [prepare]
///     cut_off = 5.0
///
///     [model]
///     motor_inertia = false
/// "#, "arm.toml").unwrap();
/// assert_eq!(settings.excitation.len(), 2);
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct IdentifySettings {
    /// The robot: an embedded name, or the path of a TOML or URDF file.
    pub robot: Option<String>,
    /// Recordings of poses at rest, for gravity.
    pub rest: Vec<LogEntry>,
    /// Recordings of slow motions of one joint at a time, for friction and gravity.
    pub one_joint: Vec<LogEntry>,
    /// Recordings of exciting motions, for the inertial parameters.
    pub excitation: Vec<LogEntry>,
    /// Validation recordings; nothing is fitted to them.
    pub validate: Vec<LogEntry>,
    /// Settings of the preparation of recordings.
    pub prepare: PrepareSettings,
    /// Settings of the model and its fits.
    pub model: ModelSettings,
}

/// Settings of the model and its fits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ModelSettings {
    /// Whether the recorded torque also drives the motors' inertia.
    ///
    /// Set it to false if the torque is measured behind the gear.
    pub motor_inertia: bool,
    /// Whether corrections of friction are fitted together with the inertial parameters.
    ///
    /// A joint without a friction fit always makes this necessary.
    pub refit_friction: bool,
    /// Whether viscous friction has a cubic term when it is fitted with the inertial parameters.
    ///
    /// By default it has one if friction recordings gave a fit.
    pub cubic: Option<bool>,
    /// Speed below which a joint's torque is not used \[rad/s\], because friction has no unique
    /// value at rest.
    ///
    /// By default it is 2 % of the 99th percentile of each joint's speed.
    pub slow: Option<f64>,
    /// Speed up to which the robot counts as at rest \[rad/s\].
    pub rest_speed: f64,
    /// Whether outliers lose weight by Huber's function; otherwise least squares is plain.
    pub robust: bool,
    /// Whether the links must be physically consistent.
    ///
    /// By default they must, unless the description has `parameters = "base"` and the torque
    /// drives the motors' inertia.
    pub physical: Option<bool>,
    /// Prior of the links in directions that the recordings do not determine.
    pub prior: Prior,
    /// Weight of the prior, roughly in independent samples per link.
    pub prior_strength: f64,
    /// Whether gravity keeps its own mass moments from the gravity fit, as in the paper.
    pub separate_gravity: bool,
    /// Whether friction that saturates is tried on the exciting motions: dry friction that builds
    /// up with speed, in place of viscous friction that bends.
    ///
    /// It is not tried on inputs or torques without the motors' friction.
    pub saturating: bool,
    /// Durations of the forward simulations over the validation recordings \[s\].
    pub windows: Vec<f64>,
}

/// The prior of the links in directions that the recordings do not determine.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Prior {
    /// The links of the robot's description.
    #[default]
    Description,
    /// Solid balls about the links' origins; the links of the description are not used.
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
            physical: None,
            prior: Prior::Description,
            prior_strength: 1.0,
            separate_gravity: false,
            saturating: true,
            windows: vec![0.5, 1.0, 2.0],
        }
    }
}

impl IdentifySettings {
    /// Parses settings from TOML text; errors name it `origin`.
    ///
    /// # Errors
    ///
    /// [`Error::Syntax`] with line, column and field.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self> {
        toml::from_str(text)
            .map_err(|error| Error::Syntax { origin: origin.into(), message: error.to_string() })
    }

    /// Reads settings from a TOML file.
    ///
    /// # Errors
    ///
    /// [`Error::File`] if the file cannot be read, and [`Error::Syntax`] if it cannot be parsed.
    pub fn load(path: &Path) -> Result<Self> {
        let text =
            reachtube_files::read_text(path, "give a settings file as docs/identify.md describes")?;
        Self::from_toml(&text, &path.display().to_string())
    }

    /// Checks the settings for a robot with a number of joints.
    ///
    /// # Errors
    ///
    /// [`Error::NoExcitingMotions`], [`Error::GainCount`], [`Error::Gain`],
    /// [`Error::SeparateGravity`] or [`Error::NotPositive`].
    pub(crate) fn validate(&self, joints: usize) -> Result<()> {
        if self.excitation.is_empty() {
            return Err(Error::NoExcitingMotions);
        }
        self.prepare.gain_of_each_joint(joints)?;
        if self.model.separate_gravity && self.rest.is_empty() && self.one_joint.is_empty() {
            return Err(Error::SeparateGravity);
        }
        self.model.validate()
    }
}

impl ModelSettings {
    fn validate(&self) -> Result<()> {
        let always =
            [("model.rest_speed", self.rest_speed), ("model.prior_strength", self.prior_strength)];
        let slow = self.slow.map(|slow| ("model.slow", slow));
        let windows = self.windows.iter().map(|window| ("model.windows", *window));
        let wrong = always
            .into_iter()
            .chain(slow)
            .chain(windows)
            .find(|(_, value)| !(*value > 0.0 && value.is_finite()));
        match wrong {
            Some((setting, value)) => Err(Error::NotPositive { setting, value }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_syntax_error_names_file_line_and_field() {
        let error = IdentifySettings::from_toml(
            "excitation = [\"a.csv\"]\n[model]\nmotorinertia = true\n",
            "s.toml",
        );
        let message = error.unwrap_err().to_string();
        for part in ["s.toml", "line 3", "motorinertia"] {
            assert!(message.contains(part), "{message}");
        }
    }

    #[test]
    fn settings_that_do_not_suit_the_robot_are_errors() {
        let given = IdentifySettings {
            excitation: vec![std::path::PathBuf::from("a.csv").into()],
            ..Default::default()
        };
        assert!(given.validate(6).is_ok());
        assert!(
            IdentifySettings::default()
                .validate(6)
                .unwrap_err()
                .to_string()
                .contains("--excitation")
        );
        let mut gains = given.clone();
        gains.prepare.gains = vec![1.0; 5];
        assert!(gains.validate(6).unwrap_err().to_string().contains("each of the 6 joints"));
        let mut separate = given.clone();
        separate.model.separate_gravity = true;
        assert!(separate.validate(6).unwrap_err().to_string().contains("--rest"));
        separate.rest = vec![std::path::PathBuf::from("poses").into()];
        assert!(separate.validate(6).is_ok());
        let mut windows = given;
        windows.model.windows = vec![0.0];
        assert!(windows.validate(6).unwrap_err().to_string().contains("above 0"));
    }
}
