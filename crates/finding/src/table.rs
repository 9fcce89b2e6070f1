use std::fmt;

use crate::printable::{COLUMNS, printable};
use schemars::JsonSchema;
use serde::Serialize;

/// A table of texts, of which the first column names the row.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Table {
    /// What the table shows; empty if the text around it says so.
    pub title: String,
    /// The names of the columns.
    pub header: Vec<String>,
    /// The rows, each as long as the header.
    pub rows: Vec<Vec<String>>,
    /// Number of rows that are not in the table because there are too many.
    #[serde(skip_serializing_if = "is_zero")]
    pub more: usize,
}

fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl Table {
    /// Makes a table without a title.
    #[must_use]
    pub fn new<T: Into<String>>(
        header: impl IntoIterator<Item = T>,
        rows: Vec<Vec<String>>,
    ) -> Self {
        let header = header.into_iter().map(Into::into).collect();
        Self { title: String::new(), header, rows, more: 0 }
    }

    /// Returns the table under a title.
    #[must_use]
    pub fn titled(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Keeps the first rows only, and counts the others.
    pub fn cut_to(mut self, most: usize) -> Self {
        self.more = self.rows.len().saturating_sub(most);
        self.rows.truncate(most);
        self
    }
}

impl fmt::Display for Table {
    /// Lays the table out: the first column is aligned left, the others right. Columns of a wide
    /// table stand closer.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A cell stays on one line, so that no name can pretend to be a row of its own.
        let one_line = |text: &String| printable(&text.replace('\n', "\\n"));
        if !self.title.is_empty() {
            writeln!(f, "{}:", one_line(&self.title))?;
        }
        let lines = [&self.header].into_iter().chain(&self.rows);
        let lines: Vec<Vec<String>> =
            lines.map(|line| line.iter().map(one_line).collect()).collect();
        let width = |column: usize| {
            let cells = lines.iter().filter_map(|line| line.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.header.len()).map(width).collect();
        let is_wide = 2 + widths.iter().map(|width| width + 3).sum::<usize>() > COLUMNS + 3;
        let gap = if is_wide { "  " } else { "   " };
        for line in &lines {
            let cells = line.iter().zip(&widths).enumerate();
            let aligned = cells.map(|(column, (cell, &width))| {
                if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            writeln!(f, "  {}", aligned.collect::<Vec<_>>().join(gap).trim_end())?;
        }
        if self.more > 0 {
            writeln!(f, "  and {} more, which JSON lists", self.more)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Table;

    #[test]
    fn a_name_cannot_pretend_to_be_a_row() {
        let table = Table::new(["joint", "U"], vec![vec!["a\n  b".into(), "1.25".into()]]);
        assert_eq!(table.to_string(), "  joint       U\n  a\\n  b   1.25\n");
    }
}
