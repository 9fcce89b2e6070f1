//! Settings as the users of each front end write them.

/// Who reads a finding or an error, and so how settings are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrontEnd {
    /// Users of the command write `--until 1.204`.
    CommandLine,
    /// Users of the command that cuts recordings into windows write `--horizon 1.204` for `until`.
    Windows,
    /// Users of the Python package write `until=1.204`.
    Python,
    /// Users of a file of choices write `until = 1.204`.
    Choices,
}

/// A setting with a value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    /// Its name, as on the command line but without dashes in front.
    pub name: &'static str,
    /// Its value; empty if the user has to choose one.
    pub value: String,
}

/// Settings whose value is a list.
const LISTS: [&str; 4] = ["calibrate", "expansion", "fit", "suites"];

impl Setting {
    /// Makes a setting with a value, or leaves its value to the user.
    pub fn new(name: &'static str, value: impl Into<String>) -> Self {
        Self { name, value: value.into() }
    }

    /// Returns the setting as users of a front end write it.
    #[must_use]
    pub(crate) fn written_for(&self, front_end: FrontEnd) -> String {
        front_end.setting(self.name, Some(self.value.as_str()).filter(|value| !value.is_empty()))
    }
}

/// Remedies that a file of choices can name.
const CHOICES: [&str; 7] =
    ["equations", "expansion", "fit", "horizon", "identify", "pull", "torque"];

impl FrontEnd {
    /// Returns whether users of the front end can give a setting.
    pub(crate) fn has(self, setting: &str) -> bool {
        self != Self::Choices || CHOICES.contains(&setting)
    }

    /// Returns the name of the setting that does in a front end what `setting` does in others.
    pub(crate) fn name_of(self, setting: &str) -> &str {
        if self == Self::Windows && setting == "until" { "horizon" } else { setting }
    }

    /// Returns a setting with its value, as users of the front end write it.
    #[must_use]
    pub fn setting(self, name: &str, value: Option<&str>) -> String {
        match (self, value) {
            (Self::Windows, _) => Self::CommandLine.setting(self.name_of(name), value),
            (Self::CommandLine, None | Some("true")) => format!("--{name}"),
            // A value that begins with a minus would be taken for an option.
            (Self::CommandLine, Some(value)) if value.starts_with('-') => {
                format!("--{name}={value}")
            }
            (Self::CommandLine, Some(value)) => format!("--{name} {value}"),
            (Self::Choices, None) => name.into(),
            (Self::Choices, Some("true")) => format!("{name} = true"),
            (Self::Choices, Some(value)) => format!("{name} = {}", python_value(name, value)),
            (Self::Python, None) => name.replace('-', "_"),
            (Self::Python, Some("true")) => format!("{}=True", name.replace('-', "_")),
            (Self::Python, Some(value)) => {
                format!("{}={}", name.replace('-', "_"), python_value(name, value))
            }
        }
    }
}

/// Returns a value as Python and TOML have it.
fn python_value(name: &str, value: &str) -> String {
    let one = |part: &str| match part {
        ".." => "...".into(),
        part if part.parse::<f64>().is_ok() => part.into(),
        part => format!("\"{part}\""),
    };
    let parts: Vec<String> = value.split(',').map(|part| one(part.trim())).collect();
    match parts.len() {
        1 if !LISTS.contains(&name) => parts.concat(),
        _ => format!("[{}]", parts.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::FrontEnd::{CommandLine, Python, Windows};

    #[test]
    fn each_front_end_writes_settings_in_its_own_form() {
        for (name, value, command, python) in [
            ("until", Some("1.204"), "--until 1.204", "until=1.204"),
            ("notion", Some("hull"), "--notion hull", "notion=\"hull\""),
            ("initial-limit", Some("states"), "--initial-limit states", "initial_limit=\"states\""),
            // A value that begins with a minus is no option.
            ("expansion", Some("-0.1,2"), "--expansion=-0.1,2", "expansion=[-0.1, 2]"),
            ("calibrate", Some("M7"), "--calibrate M7", "calibrate=[\"M7\"]"),
            (
                "calibrate",
                Some("MOTION,.."),
                "--calibrate MOTION,..",
                "calibrate=[\"MOTION\", ...]",
            ),
            ("max-gap", None, "--max-gap", "max_gap"),
            ("stiction", Some("true"), "--stiction", "stiction=True"),
        ] {
            assert_eq!(CommandLine.setting(name, value), command);
            assert_eq!(Python.setting(name, value), python);
        }
        assert_eq!(Windows.setting("until", Some("1.204")), "--horizon 1.204");
        assert_eq!(Windows.setting("notion", Some("hull")), "--notion hull");
    }
}
