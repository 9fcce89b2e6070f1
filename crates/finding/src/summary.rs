use std::fmt;

use crate::printable::{COLUMNS, printable};
use crate::table::Table;

/// Largest number of lines.
const LINES: usize = 18;

/// Smallest number of rows that a table keeps.
const FEWEST_ROWS: usize = 2;

/// An answer for people on at most 18 lines of 100 columns, unless the first warning, which is
/// printed in full, needs more. The [`Report`](crate::Report) has the rest.
///
/// # Examples
///
/// ```
/// use reachtube_finding::Summary;
///
/// let verdict = vec!["conformant: 6 recordings".into()];
/// let mut summary = Summary { verdict, ..Summary::default() };
/// summary.fact("wrote", "model.json");
/// summary.next = Some("check other recordings".into());
/// assert_eq!(
///     summary.to_string(),
///     "conformant: 6 recordings\nwrote: model.json\nnext: check other recordings\n"
/// );
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Summary {
    /// The verdict, and below it what speaks against the sets.
    pub verdict: Vec<String>,
    /// The sets joint by joint, or the suites that leave them.
    pub table: Table,
    /// The rows of the table by their importance: where not all fit, the first ones stay.
    pub importance: Vec<usize>,
    /// Names and values.
    pub facts: Vec<(String, String)>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// The one thing to do next.
    pub next: Option<String>,
}

impl Summary {
    /// Adds a fact.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.facts.push((name.into(), value.into()));
    }

    /// Returns the lines without table and warnings: before and after them.
    fn fixed(&self) -> [Vec<String>; 2] {
        let before = self.verdict.iter().flat_map(|line| wrapped(line)).collect();
        let facts = self.facts.iter().map(|(name, value)| format!("{name}: {value}"));
        let next = self.next.iter().map(|next| format!("next: {next}"));
        [before, facts.chain(next).flat_map(|line| wrapped(&line)).collect()]
    }

    /// Returns the table with the most important rows.
    fn with_rows(&self, count: usize) -> Table {
        let mut table = self.table.clone();
        let mut kept: Vec<usize> = match &self.importance[..] {
            [] => (0..count.min(table.rows.len())).collect(),
            ranked => ranked.iter().copied().take(count).collect(),
        };
        kept.sort_unstable();
        table.more += table.rows.len() - kept.len();
        table.rows = kept.into_iter().map(|row| self.table.rows[row].clone()).collect();
        table
    }

    /// Returns the first warning, the others that fit on some lines, and the number of the rest.
    fn warnings_within(&self, lines: usize) -> Vec<String> {
        let mut all = Vec::new();
        for (index, warning) in self.warnings.iter().enumerate() {
            let own = wrapped(&format!("warning: {warning}"));
            let others = self.warnings.len() - index;
            let reserved = usize::from(others > 1);
            if index > 0 && all.len() + own.len() + reserved > lines {
                let word = if others == 1 { "warning" } else { "warnings" };
                all.push(format!("warning: {others} more {word} in the whole report"));
                break;
            }
            all.extend(own);
        }
        all
    }

    /// Returns the table with as many rows as fit on some lines.
    fn table_within(&self, lines: usize) -> Vec<String> {
        let Table { rows, more, .. } = &self.table;
        if rows.is_empty() {
            return Vec::new();
        }
        let room = lines.saturating_sub(1 + usize::from(!self.table.title.is_empty()));
        let table = match rows.len() + usize::from(*more > 0) <= room {
            true => self.table.clone(),
            // The last line counts the others.
            false => self.with_rows(room.saturating_sub(1).max(FEWEST_ROWS)),
        };
        table.to_string().lines().map(cut).collect()
    }
}

impl fmt::Display for Summary {
    /// Lays the summary out. Names of files stay whole, even if they are longer than a line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [before, after] = self.fixed();
        let room = LINES.saturating_sub(before.len() + after.len());
        let rows = self.table.rows.len();
        let warnings = self.warnings_within(room.saturating_sub(1 + rows));
        let table = self.table_within(room.saturating_sub(warnings.len()));
        for line in [before, table, warnings, after].concat() {
            writeln!(f, "{}", printable(&line))?;
        }
        Ok(())
    }
}

/// Breaks a text between words into lines; all but the first are indented.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("there is a line");
        if line.is_empty() {
            line.push_str(word);
        } else if line.chars().count() + 1 + word.chars().count() <= COLUMNS {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(format!("  {word}"));
        }
    }
    lines
}

/// Cuts a line of a table that is too long.
fn cut(line: &str) -> String {
    if line.chars().count() <= COLUMNS {
        return line.into();
    }
    line.chars().take(COLUMNS - 2).chain("..".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn long(rows: usize, warnings: usize) -> Summary {
        let row = |number: usize| vec![format!("joint{number}"), "0.1".repeat(60)];
        Summary {
            verdict: vec!["conformant ".repeat(12), "but vacuous".into()],
            table: Table::new(["joint", "U"], (1..=rows).map(row).collect()),
            facts: vec![("new motions".into(), "no guarantee ".repeat(12))],
            warnings: vec!["U reaches beyond the input ".repeat(5); warnings],
            next: Some("`--calibrate` ".repeat(10)),
            ..Summary::default()
        }
    }

    #[test]
    fn every_answer_fits() {
        for rows in [0, 1, 2, 3, 6, 7, 30] {
            for warnings in [0, 1, 2, 3, 40] {
                let text = long(rows, warnings).to_string();
                assert!(text.lines().count() <= LINES, "{rows} {warnings}: {text}");
                assert!(text.lines().all(|line| line.chars().count() <= COLUMNS), "{text}");
                assert!(text.contains("\nnext: ") && text.starts_with("conformant"), "{text}");
                assert_eq!(text.contains("  joint"), rows > 0, "{text}");
                assert_eq!(text.contains("warning: "), warnings > 0, "{text}");
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_counted() {
        let text = long(30, 0).to_string();
        assert!(text.contains("  joint1 ") && text.contains("\n  and 2"), "{text}");
        let summary = Summary { importance: (0..30).rev().collect(), ..long(30, 1) };
        let text = summary.to_string();
        assert!(text.contains("  joint30 ") && !text.contains("  joint1 "), "{text}");
        assert!(text.contains("\nwarning: U reaches"), "the first warning stays: {text}");
        let text = long(30, 2).to_string();
        assert!(text.contains("\nwarning: U reaches"), "{text}");
        assert!(text.contains("\nwarning: 1 more warning in the whole report\n"), "{text}");
        let warnings = vec!["The torques come later than the motion. ".repeat(12)];
        let text = Summary { warnings, ..long(30, 1) }.to_string();
        assert_eq!(text.matches("come later").count(), 12, "the first warning is whole: {text}");
        let text = long(3, 40).to_string();
        assert!(text.contains("more warnings in the whole report\n"), "{text}");
    }

    #[test]
    fn a_control_character_is_not_printed() {
        let summary = Summary { verdict: vec!["a\u{1b}[31m".into()], ..Summary::default() };
        assert_eq!(summary.to_string(), "a\\u{1b}[31m\n");
    }
}
