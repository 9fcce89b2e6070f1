use std::borrow::Cow;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::front_end::FrontEnd;

/// A setting that helps, and what it does. Each front end writes it in its own form.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Remedy {
    /// The name of the setting, as on the command line but without dashes in front.
    pub setting: Cow<'static, str>,
    /// Its value; empty if the user has to choose one.
    pub value: String,
    /// What the setting does: the rest of a sentence whose subject is the setting.
    pub effect: Cow<'static, str>,
}

/// What the settings that help do.
const EFFECTS: &[(&str, &str)] = &[
    ("until", "uses only the samples before."),
    ("torque", "reads the recorded torques as such."),
    ("expansion", "expands the model there."),
    ("paper-model", "with order 2 follows how the inertia changes."),
    ("equations", "lets the nominal motions follow the robot's own equations."),
    ("fit", "names the parameters to fit."),
    ("horizon", "cuts recordings into windows of this length, s."),
    ("identify", "identifies the robot from the recordings."),
    ("pull", "keeps the fitted values closer to the identified ones."),
    ("initial-limit", "limits X0 to the recorded starts."),
    ("stiction", "of `conform` widens U so that it does."),
    ("disturbance", "lets the disturbance change during the motion."),
    ("noise", "adds measurement noise V."),
    (
        "calibrate",
        "holds motions out of the fit, for a guarantee: with n of them the next motion \
                   leaves the sets with probability at most 1 in n + 1.",
    ),
];

impl Remedy {
    /// Makes the remedy that gives `setting` a value, or leaves its value to the user.
    ///
    /// # Panics
    ///
    /// Panics for a setting whose effect is not listed.
    pub fn new(setting: &str, value: impl Into<String>) -> Self {
        let known = EFFECTS.iter().find(|(name, _)| *name == setting);
        let (name, effect) = known.expect("the effect of each remedy is listed");
        Self { setting: Cow::Borrowed(name), value: value.into(), effect: Cow::Borrowed(effect) }
    }

    /// Makes the remedy that uses only the samples before `time`, s.
    #[must_use]
    pub fn until(time: f64) -> Self {
        Self::new("until", format!("{time:.3}"))
    }

    /// Returns the remedy as a sentence, as users of a front end write settings.
    #[must_use]
    pub fn written_for(&self, front_end: FrontEnd) -> String {
        let Self { setting, value, effect } = self;
        let own = front_end.name_of(setting);
        if own != setting {
            return Self::new(own, value).written_for(front_end);
        }
        let value = Some(value.as_str()).filter(|value| !value.is_empty());
        format!("`{}` {effect}", front_end.setting(setting, value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_shortened_by_their_horizon() {
        let remedy = Remedy::until(0.28);
        let words = "`--until 0.280` uses only the samples before.";
        assert_eq!(remedy.written_for(FrontEnd::CommandLine), words);
        let words = "`--horizon 0.280` cuts recordings into windows of this length, s.";
        assert_eq!(remedy.written_for(FrontEnd::Windows), words);
    }
}
