//! Conversion of a text or a description to a robot, and of a description to text.

use super::joint_description::JointDescription;
use super::robot_description::RobotDescription;
use super::validity::InvalidValue;
use crate::error::RobotError;
use crate::robot::Robot;

impl Robot {
    /// Reads a robot from TOML text; `origin` names the text in errors.
    ///
    /// # Errors
    ///
    /// Returns a [`RobotError`] with line, joint, value and remedy.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self, RobotError> {
        let description: RobotDescription = toml::from_str(text).map_err(|e| {
            if text.trim_start().starts_with('{') {
                return RobotError::Invalid {
                    origin: origin.into(),
                    place: String::new(),
                    problem: "the file is JSON, and no robot".into(),
                    remedy: "name a TOML or URDF file; `model` writes robot.toml beside its model"
                        .into(),
                };
            }
            RobotError::Syntax { origin: origin.into(), message: e.to_string() }
        })?;
        Self::checked(&description, |value| {
            let line = line_of(text, value.joint, value.key);
            (format!("{origin}:{line}"), place_of(&description, value))
        })
    }

    /// Makes a robot from its description.
    ///
    /// # Errors
    ///
    /// Returns a [`RobotError`] with joint, value and remedy.
    pub fn from_description(description: &RobotDescription) -> Result<Self, RobotError> {
        Self::checked(description, |value| (description.name.clone(), place_of(description, value)))
    }

    /// Makes a robot from its description; `locate` returns origin and place of an invalid value.
    pub(crate) fn checked(
        description: &RobotDescription,
        locate: impl Fn(&InvalidValue) -> (String, String),
    ) -> Result<Self, RobotError> {
        description.check().map_err(|value| {
            let (origin, place) = locate(&value);
            RobotError::Invalid {
                origin,
                place,
                problem: value.problem,
                remedy: value.remedy.into(),
            }
        })?;
        Ok(description.clone().build())
    }
}

/// Returns the joint of an invalid value as the start of an error message.
fn place_of(description: &RobotDescription, value: &InvalidValue) -> String {
    value.joint.map_or(String::new(), |i| format!("joint `{}`: ", description.joints[i].name))
}

/// Returns the line (from 1) of a key in the table of the given joint, or the first line of that
/// table if the key is absent.
fn line_of(text: &str, joint: Option<usize>, key: &str) -> usize {
    let lines = || text.lines().map(str::trim).enumerate();
    let mut headers = lines().filter(|(_, l)| l.starts_with("[[joint]]")).map(|(i, _)| i);
    let start = joint.map_or(0, |k| headers.nth(k).unwrap_or(0));
    // A key is `key = ...`, `key.part = ...` or the table `[joint.key]`.
    let has_key = |l: &str| {
        let rest = l.strip_prefix("[joint.").unwrap_or(l).strip_prefix(key);
        rest.is_some_and(|rest| rest.trim_start().starts_with(['=', '.', ']']))
    };
    let own = lines().skip(start).take_while(|(i, l)| *i == start || !l.starts_with("[[joint]]"));
    own.into_iter().find(|(_, l)| has_key(l)).map_or(start, |(i, _)| i) + 1
}

impl RobotDescription {
    /// Writes the description as TOML text, from which [`Robot::from_toml`] makes the same robot.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    ///
    /// let text = Robot::lwa4p().description().to_toml();
    /// assert_eq!(Robot::from_toml(&text, "copy").unwrap(), Robot::lwa4p());
    /// ```
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("numbers, strings and tables are valid TOML")
    }

    fn build(self) -> Robot {
        let geometry: Vec<_> = self.joints.iter().map(|j| j.geometry(self.convention)).collect();
        let inertias: Vec<_> = self.joints.iter().map(JointDescription::link_inertia).collect();
        let gravity: Vec<_> = self.joints.iter().map(JointDescription::gravity_inertia).collect();
        let joints = self.joints.iter().map(JointDescription::joint).collect();
        Robot::assemble(self, joints, &geometry, &inertias, &gravity)
    }
}
