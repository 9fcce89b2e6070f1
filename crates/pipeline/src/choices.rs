use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use reachtube_arm::Equations;
use reachtube_conform::{Group, Model};
use reachtube_identify::prepare::PrepareSettings;
use reachtube_recordings::{ColumnSettings, LogSettings, Torque};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::error::{Error, Result};

/// What the comment with the digest of the values begins with.
const DIGEST: &str = "the reasons belong to the values with the digest ";

/// What the comment begins with that has the digests of an allowance, and of the other values.
const FOLLOWS: &str = "the allowance, and what it follows from: ";

/// Half a joint's set by the joint's displacement that is accepted by default.
pub(crate) const LARGEST_RATIO: f64 = 0.5;

/// The factor by which a joint's set may have to grow for motions that were held out, by default.
pub(crate) const LARGEST_GROWTH: f64 = 2.0;

/// The part of the rows of held-out motions that may lie outside the sets, by default.
pub(crate) const LARGEST_OUTSIDE: f64 = 0.01;

/// Largest number of columns of a comment.
const COLUMNS: usize = 96;

/// The choices behind a model. Choices that are not given are made from the recordings.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, rename_all = "kebab-case")]
pub struct Choices {
    /// The robot: a name or a file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robot: Option<String>,
    /// Recordings: files or folders.
    pub data: Vec<PathBuf>,
    /// The kind of the recorded torques.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<Torque>,
    /// Factors of the recorded torques, one per joint; for motor currents in N m/A.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub gains: Vec<f64>,
    /// The motions that are held out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held_out: Option<Vec<String>>,
    /// Cut-off frequency of the low-pass, Hz.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut_off: Option<f64>,
    /// Whether the robot is identified from the recordings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub identify: Option<bool>,
    /// Whose equations of motion the nominal motions satisfy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub equations: Option<Equations>,
    /// The position about which the model of deviations is linear, n, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expansion: Option<Vec<f64>>,
    /// Radii of the sensors' noise, 2n, rad and rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensor_noise: Option<Vec<f64>>,
    /// Accelerations of the nominal motion at which U is twice what it is at rest, n, rad/s²; empty
    /// if U is the same along every motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub input_doubling: Option<Vec<f64>>,
    /// The largest accepted ratio of half a joint's set at the horizon to the joint's displacement.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_ratio: Option<f64>,
    /// The largest accepted factor by which the set of a joint would have to grow for motions that
    /// are held out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_growth: Option<f64>,
    /// The largest accepted part of the rows of held-out motions that lies outside the sets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest_outside: Option<f64>,
    /// Time up to which the model predicts, s: the length of the windows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub horizon: Option<f64>,
    /// Radii added to the smallest X0 and U, 3n, rad, rad/s and N m, for motions that were not
    /// recorded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub allowance: Option<Vec<f64>>,
    /// Parameters of the nominal model that are fitted for small sets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fit: Option<Vec<Group>>,
    /// Weight of the pull of the fit toward the identified values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pull: Option<f64>,
    /// Joints that are held at positions, as `JOINT=VALUE`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub lock: Vec<String>,
    /// Columns of CSV files, if their names are ambiguous.
    #[serde(skip_serializing_if = "is_default")]
    pub columns: ColumnSettings,
    /// Topics, joints and times of MCAP and rosbag2 logs, if the logs are ambiguous.
    #[serde(skip_serializing_if = "is_default")]
    pub log: LogSettings,
    /// The reasons that a file gives for its choices, by their keys.
    #[serde(skip)]
    pub reasons: BTreeMap<String, String>,
}

fn is_default<T: Default + PartialEq>(settings: &T) -> bool {
    *settings == T::default()
}

/// A choice that was made, and why.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Choice {
    /// The key in the settings.
    pub key: &'static str,
    /// The choice in words.
    pub value: String,
    /// The reason.
    pub reason: String,
}

impl Choices {
    /// Reads choices and the reasons in the comments before them. Reasons of a value that was
    /// edited are dropped, because they may refer to the previous value. So is an allowance that
    /// was found for other values.
    ///
    /// # Errors
    ///
    /// Text that is not TOML, and keys that do not exist, with line and column.
    pub fn from_toml(text: &str) -> Result<Self, toml::de::Error> {
        let mut choices: Self = toml::from_str(text)?;
        let comment = |begin: &str| {
            text.lines().find_map(|line| Some(line.strip_prefix("# ")?.strip_prefix(begin)?.trim()))
        };
        if comment(DIGEST) != Some(choices.digest().as_str()) {
            let [allowance, others] = choices.following();
            let known = comment(FOLLOWS).and_then(|line| line.split_once(' '));
            if known.is_some_and(|known| known.0 == allowance && known.1 != others) {
                choices.allowance = None;
            }
            return Ok(choices);
        }
        let mut reason: Vec<&str> = Vec::new();
        for line in text.lines() {
            match (line.strip_prefix("# "), line.split_once(" = ")) {
                (Some(words), _) => reason.push(words),
                (None, Some((key, _))) if !reason.is_empty() => {
                    choices.reasons.insert(key.into(), reason.join(" "));
                    reason.clear();
                }
                _ => reason.clear(),
            }
        }
        Ok(choices)
    }

    /// Reads a file of choices, with its paths from the working directory.
    ///
    /// # Errors
    ///
    /// [`Error::File`] if the file cannot be read, [`Error::Settings`] as
    /// [`from_toml`](Self::from_toml).
    pub fn load(path: &Path) -> Result<Self> {
        let text = reachtube_files::read_text(path, "give a file that `model` wrote")?;
        let read = Self::from_toml(&text);
        let mut choices = read
            .map_err(|error| Error::Settings { path: path.into(), message: error.to_string() })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        if let Some(robot) = &choices.robot {
            let beside = folder.join(robot);
            if beside.exists() {
                choices.robot = Some(beside.display().to_string());
            }
        }
        choices.data.iter_mut().for_each(|path| *path = folder.join(&*path));
        Ok(choices)
    }

    /// Returns the part of the rows of held-out motions that may lie outside the sets.
    pub(crate) fn largest_outside(&self) -> f64 {
        self.largest_outside.unwrap_or(LARGEST_OUTSIDE)
    }

    /// Returns whether the sets of a model were proved, limit every joint, and are narrow enough at
    /// the horizon.
    pub(crate) fn accept(&self, model: &Model) -> bool {
        let worst = model.usefulness.as_ref().and_then(|said| said.worst());
        let largest = self.largest_ratio.unwrap_or(LARGEST_RATIO);
        model.is_useful() && worst.is_some_and(|(_, ratio)| ratio <= largest)
    }

    /// Replaces choices by the ones that `given` has. Reasons are about values, and are dropped if
    /// a value is another.
    #[must_use]
    pub fn replaced_by(self, given: Self) -> Self {
        fn filled<T>(given: Vec<T>, own: Vec<T>) -> Vec<T> {
            if given.is_empty() { own } else { given }
        }
        fn other<T: Default + PartialEq>(given: T, own: T) -> T {
            if is_default(&given) { own } else { given }
        }
        let before = self.clone();
        let mut choices = Self {
            robot: given.robot.or(self.robot),
            data: filled(given.data, self.data),
            torque: given.torque.or(self.torque),
            gains: filled(given.gains, self.gains),
            held_out: given.held_out.or(self.held_out),
            cut_off: given.cut_off.or(self.cut_off),
            identify: given.identify.or(self.identify),
            equations: given.equations.or(self.equations),
            expansion: given.expansion.or(self.expansion),
            sensor_noise: given.sensor_noise.or(self.sensor_noise),
            input_doubling: given.input_doubling.or(self.input_doubling),
            largest_ratio: given.largest_ratio.or(self.largest_ratio),
            largest_growth: given.largest_growth.or(self.largest_growth),
            largest_outside: given.largest_outside.or(self.largest_outside),
            horizon: given.horizon.or(self.horizon),
            allowance: given.allowance.or(self.allowance),
            fit: given.fit.or(self.fit),
            pull: given.pull.or(self.pull),
            lock: filled(given.lock, self.lock),
            columns: other(given.columns, self.columns),
            log: other(given.log, self.log),
            reasons: self.reasons,
        };
        if choices != before {
            // An allowance was found for the values before.
            let is_given = before.reasons.get("allowance").is_none_or(|reason| reason == "given");
            if !is_given && choices.allowance == before.allowance {
                choices.allowance = None;
            }
            choices.reasons.clear();
        }
        choices
    }

    /// Returns the digests of the allowance, and of the values that it follows from.
    fn following(&self) -> [String; 2] {
        let (allowance, reasons) = (self.allowance.clone(), BTreeMap::new());
        let own = Self { allowance, ..Self::default() };
        let others = Self { allowance: None, reasons, ..self.clone() };
        [own.digest(), others.digest()]
    }

    /// Returns how recordings are read and prepared, but for the cut-off.
    pub(crate) fn prepare_settings(&self) -> PrepareSettings {
        PrepareSettings {
            gains: self.gains.clone(),
            columns: self.columns.clone(),
            log: self.log.clone(),
            ..PrepareSettings::default()
        }
    }

    /// Returns the choices as TOML, with the reasons of `made` as comments, and a digest of the
    /// values that the reasons belong to.
    #[must_use]
    pub(crate) fn to_toml(&self, made: &[Choice]) -> String {
        let lines = self.values();
        let mut text = String::new();
        for line in lines.lines() {
            let key = line.split(" = ").next().unwrap_or_default();
            if let Some(choice) = made.iter().find(|choice| choice.key == key) {
                text += &comment(&choice.reason);
            }
            text += line;
            text.push('\n');
        }
        let [allowance, others] = self.following();
        text + &format!("\n# {DIGEST}{}\n# {FOLLOWS}{allowance} {others}\n", self.digest())
    }

    fn values(&self) -> String {
        toml::to_string(self).expect("choices are a TOML table")
    }

    fn digest(&self) -> String {
        let sha256 = Sha256::digest(self.values().as_bytes());
        sha256.iter().take(8).map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Returns a sentence as lines of a comment.
fn comment(sentence: &str) -> String {
    let mut lines = vec![String::from("#")];
    for word in sentence.split_whitespace() {
        if lines.last().is_some_and(|line| line.len() + word.len() >= COLUMNS) {
            lines.push("#".into());
        }
        let line = lines.last_mut().expect("there is a line");
        line.push(' ');
        line.push_str(word);
    }
    format!("\n{}\n", lines.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choices_are_read_as_they_were_written() {
        let choices = Choices {
            robot: Some("arm.urdf".into()),
            data: vec!["logs".into()],
            torque: Some(Torque::Motor),
            held_out: Some(vec!["a".into()]),
            fit: Some(vec![Group::Inertia]),
            expansion: Some(vec![0.1, -1.2]),
            equations: Some(Equations::Robot),
            columns: "q=p{},first=0".parse().unwrap(),
            log: LogSettings { topic: vec!["/joints".into()], ..LogSettings::default() },
            ..Choices::default()
        };
        let reason = "every fourth motion is held out before anything is looked at ".repeat(3);
        let made = [Choice { key: "held-out", value: "a".into(), reason: reason.clone() }];
        let text = choices.to_toml(&made);
        assert!(text.contains("# every fourth motion"), "{text}");
        assert!(text.lines().all(|line| line.len() <= 100), "{text}");
        let read = Choices::from_toml(&text).unwrap();
        assert_eq!(read.reasons["held-out"], reason.trim());
        assert_eq!(Choices { reasons: BTreeMap::new(), ..read }, choices);
        // A choice that is given replaces the one in the file, and its reason with it.
        let longer = Choices { horizon: Some(0.5), ..Choices::default() };
        let replaced = Choices::from_toml(&text).unwrap().replaced_by(longer);
        assert!(replaced.reasons.is_empty());
        assert_eq!(replaced, Choices { horizon: Some(0.5), ..choices.clone() });
        let same = Choices::from_toml(&text).unwrap().replaced_by(Choices::default());
        assert_eq!(same.reasons.len(), 1);
        // An allowance follows from the other values, and goes with them unless it was given.
        let with = Choices { allowance: Some(vec![0.5; 6]), ..choices.clone() };
        let made = |reason: &str| {
            let (value, reason) = (String::new(), reason.into());
            with.to_toml(&[Choice { key: "allowance", value, reason }])
        };
        let edited = Choices::from_toml(&made("found").replace("-1.2", "-1.3")).unwrap();
        assert_eq!(edited.allowance, None);
        let edited = made("found").replace("-1.2", "-1.3").replace("[0.5, ", "[0.6, ");
        assert_eq!(Choices::from_toml(&edited).unwrap().allowance.unwrap()[0], 0.6);
        for (reason, kept) in [("found", false), ("given", true)] {
            let longer = Choices { horizon: Some(0.5), ..Choices::default() };
            let replaced = Choices::from_toml(&made(reason)).unwrap().replaced_by(longer);
            assert_eq!(replaced.allowance.is_some(), kept, "{reason}");
        }
        // The reasons of an edited file may be about other values.
        let edited = Choices::from_toml(&text.replace("-1.2", "-1.3")).unwrap();
        assert!(edited.reasons.is_empty());
    }
}
