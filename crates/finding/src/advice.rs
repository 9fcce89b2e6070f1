use std::fmt;

use crate::front_end::{FrontEnd, Setting};

/// The problem, the remedy, and the settings that apply it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Advice {
    /// The problem and what to do, in words that name no option.
    pub problem: String,
    /// The settings that help.
    pub settings: Vec<Setting>,
}

impl Advice {
    /// Adds a setting that helps.
    pub fn with(mut self, name: &'static str, value: &str) -> Self {
        self.settings.push(Setting::new(name, value));
        self
    }
}

impl From<String> for Advice {
    fn from(problem: String) -> Self {
        Self { problem, settings: Vec::new() }
    }
}

impl From<&str> for Advice {
    fn from(problem: &str) -> Self {
        problem.to_string().into()
    }
}

impl fmt::Display for Advice {
    /// Writes the problem and what to do, without settings.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.problem)
    }
}

/// Returns a text with the settings that help in brackets, as users of a front end write them.
pub fn advised(text: String, settings: &[Setting], front_end: FrontEnd) -> String {
    let written: Vec<String> =
        settings.iter().map(|setting| setting.written_for(front_end)).collect();
    if written.is_empty() { text } else { format!("{text} ({})", written.join(", ")) }
}
