//! Settings as the users of each front end write them.

/// Who reads a finding, and so how settings are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrontEnd {
    /// Users of the command write `--until 1.204`.
    CommandLine,
    /// Users of the Python package write `until=1.204`.
    Python,
}

/// Settings whose value is a list.
const LISTS: [&str; 4] = ["calibrate", "expansion", "fit", "suites"];

/// Values that are words, and not numbers or names in capitals.
const WORDS: &[&str] = &[
    "bisection",
    "coulomb",
    "compensated",
    "constant",
    "exact",
    "fitted",
    "hull",
    "inertia",
    "link",
    "measurable",
    "model",
    "motor",
    "none",
    "own",
    "phase-plane",
    "positions",
    "program",
    "robot",
    "sample",
    "states",
    "trace",
    "viscous",
];

/// A setting in a text, as users of the command write it.
pub(crate) struct Mention<'a> {
    pub setting: &'a str,
    pub value: Option<&'a str>,
    /// Where it is in the text, bytes.
    start: usize,
    end: usize,
}

impl FrontEnd {
    /// Returns a setting with its value, as users of the front end write it.
    #[must_use]
    pub fn setting(self, name: &str, value: Option<&str>) -> String {
        match (self, value) {
            (Self::CommandLine, None) => format!("--{name}"),
            // A value that begins with a minus would be taken for an option.
            (Self::CommandLine, Some(value)) if value.starts_with('-') => {
                format!("--{name}={value}")
            }
            (Self::CommandLine, Some(value)) => format!("--{name} {value}"),
            (Self::Python, None) => name.replace('-', "_"),
            (Self::Python, Some(value)) => {
                format!("{}={}", name.replace('-', "_"), python_value(name, value))
            }
        }
    }

    /// Returns a text, in which settings are written for the command, for this front end.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_conform::FrontEnd;
    ///
    /// let text = "use --method program, or --notion hull";
    /// assert_eq!(
    ///     FrontEnd::Python.written(text),
    ///     "use method=\"program\", or notion=\"hull\""
    /// );
    /// ```
    #[must_use]
    pub fn written(self, text: &str) -> String {
        if self == Self::CommandLine {
            return text.into();
        }
        let (mut written, mut end) = (String::new(), 0);
        for mention in mentions(text) {
            written.push_str(&text[end..mention.start]);
            written.push_str(&self.setting(mention.setting, mention.value));
            end = mention.end;
        }
        written + &text[end..]
    }
}

/// Returns a value as Python has it.
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

/// Finds the settings in a text that are written as `--name`, `--name value` or `--name=value`.
pub(crate) fn mentions(text: &str) -> Vec<Mention<'_>> {
    let mut found = Vec::new();
    let mut from = 0;
    while let Some(at) = text[from..].find("--").map(|at| from + at) {
        let rest = &text[at + 2..];
        let is_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        let length = rest.find(|c| !is_name(c)).unwrap_or(rest.len());
        let setting = rest[..length].trim_end_matches('-');
        let begins_word = text[..at].chars().next_back().is_none_or(|c| !c.is_alphanumeric());
        from = at + 2 + length;
        if setting.is_empty() || !begins_word {
            continue;
        }
        let end = at + 2 + setting.len();
        let value = value_after(&text[end..]);
        // One character, a space or an equals sign, is between the two.
        let end = value.map_or(end, |value| end + 1 + value.len());
        from = from.max(end);
        found.push(Mention { setting, value, start: at, end });
    }
    found
}

/// Returns the value at the beginning of what follows the name of a setting.
fn value_after(rest: &str) -> Option<&str> {
    let (is_sure, rest) = match rest.strip_prefix('=') {
        Some(rest) => (true, rest),
        None => (false, rest.strip_prefix(' ')?),
    };
    let ends = |c: char| c.is_whitespace() || matches!(c, ';' | ')' | '`' | ':' | '"');
    let token = &rest[..rest.find(ends).unwrap_or(rest.len())];
    // The list MOTION,.. ends with dots that belong to it.
    let value = match token.strip_suffix(",..") {
        Some(_) => token,
        None => token.trim_end_matches([',', '.']),
    };
    let is_number = |part: &str| part.parse::<f64>().is_ok();
    let is_capital = |c: char| c.is_ascii_uppercase();
    let is_value = value.split(',').all(|part| {
        is_number(part) || WORDS.contains(&part) || part == ".." || part.starts_with(is_capital)
    });
    (!value.is_empty() && (is_sure || is_value)).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::FrontEnd::{CommandLine, Python};

    #[test]
    fn settings_in_sentences_are_written_for_python() {
        for (command, python) in [
            ("check that --torque says what was recorded", "check that torque says what was"),
            ("(--torque compensated). So", "(torque=\"compensated\"). So"),
            ("with --expansion=-0.02,2.58, the mean", "with expansion=[-0.02, 2.58], the mean"),
            ("use --until 1.204, shorter", "use until=1.204, shorter"),
            ("--calibrate MOTION,.. keeps", "calibrate=[\"MOTION\", ...] keeps"),
            ("(--model 3 --order 2) has", "(model=3 order=2) has"),
            ("another --model or --order, or", "another model or order, or"),
            ("(--initial-limit positions) leaves", "(initial_limit=\"positions\") leaves"),
            ("with --equations robot the nominal", "with equations=\"robot\" the nominal"),
            ("`reachtube prepare --window`", "`reachtube prepare window`"),
            ("--noise, for example --noise 0.001,0.01", "noise, for example noise=[0.001, 0.01]"),
            ("a -- b and q--", "a -- b and q--"),
        ] {
            let written = Python.written(command);
            assert!(written.starts_with(python), "{command}: {written}");
            assert_eq!(CommandLine.written(command), command);
        }
    }

    #[test]
    fn a_value_that_begins_with_a_minus_is_no_option() {
        assert_eq!(CommandLine.setting("expansion", Some("-0.1,2")), "--expansion=-0.1,2");
        assert_eq!(Python.setting("expansion", Some("-0.1,2")), "expansion=[-0.1, 2]");
        assert_eq!(Python.setting("calibrate", Some("M7")), "calibrate=[\"M7\"]");
    }
}
