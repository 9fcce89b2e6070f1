//! The few forms of YAML that the shield's files use: a key at the start of a line, and after it a
//! number or numbers in brackets.

use std::ops::Range;

use super::file::ShieldFile;
use crate::export::ExportError;

/// A file of the shield.
pub(super) struct Yaml<'a> {
    file: &'a ShieldFile,
}

impl<'a> Yaml<'a> {
    pub(super) fn new(file: &'a ShieldFile) -> Self {
        Self { file }
    }

    /// Returns the numbers of a key, `count` of them.
    pub(super) fn numbers(&self, key: &str, count: usize) -> Result<Vec<f64>, ExportError> {
        let place = self.brackets(key)?;
        let text: String = self.file.text[place.clone()]
            .lines()
            .map(|line| line.split('#').next().unwrap_or("").to_owned() + " ")
            .collect();
        let entries: Vec<&str> = text.split(',').map(str::trim).filter(|x| !x.is_empty()).collect();
        let number = |entry: &&str| {
            let value = entry.parse::<f64>().ok().filter(|x| x.is_finite());
            value.ok_or_else(|| self.error(place.start, key, format!("`{entry}` is no number")))
        };
        let values = entries.iter().map(number).collect::<Result<Vec<f64>, _>>()?;
        if values.len() != count {
            let problem = format!("there are {} numbers, and the robot has {count}", values.len());
            return Err(self.error(place.start, key, problem));
        }
        Ok(values)
    }

    pub(super) fn with_numbers(&self, key: &str, values: &str) -> Result<String, ExportError> {
        let place = self.brackets(key)?;
        let text = &self.file.text;
        Ok([&text[..place.start], values, &text[place.end..]].concat())
    }

    /// Returns the text with another value for a key; what follows the value on its line stays.
    pub(super) fn with_value(&self, key: &str, value: &str) -> Result<String, ExportError> {
        let start = self.after(key)?;
        let rest = &self.file.text[start..];
        let before = rest.len() - rest.trim_start_matches(' ').len();
        let old = rest[before..].find([' ', '\n', '\r', '#']).unwrap_or(rest.len() - before);
        let text = &self.file.text;
        let (head, tail) = (&text[..start], &text[start + before + old..]);
        Ok(format!("{head} {value}{tail}"))
    }

    /// Returns an error about a key; `at` is a place in the text.
    pub(super) fn error(&self, at: usize, key: &str, problem: String) -> ExportError {
        let line = self.file.text[..at].matches('\n').count() + 1;
        ExportError::Refused {
            place: format!("{}:{line}: {key}", self.file.name),
            problem,
            remedy: "correct it, or name the file that belongs to this robot".into(),
        }
    }

    fn brackets(&self, key: &str) -> Result<Range<usize>, ExportError> {
        let (text, start) = (&self.file.text, self.after(key)?);
        let open = text[start..].find(|c: char| !c.is_whitespace()).map(|at| start + at);
        let open = open.filter(|at| text[*at..].starts_with('['));
        let close = open.and_then(|open| text[open..].find(']').map(|at| open + at));
        match (open, close) {
            (Some(open), Some(close)) => Ok(open + 1..close),
            _ => Err(self.error(start, key, "there are no numbers in brackets, [a, b, ..]".into())),
        }
    }

    fn after(&self, key: &str) -> Result<usize, ExportError> {
        let mut at = 0;
        for line in self.file.text.split_inclusive('\n') {
            if line.strip_prefix(key).is_some_and(|rest| rest.starts_with(':')) {
                return Ok(at + key.len() + 1);
            }
            at += line.len();
        }
        Err(self.error(0, key, "there is no such key at the start of a line".into()))
    }
}
