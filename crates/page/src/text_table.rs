//! Tables of text.

use serde::Serialize;

/// A table of texts: the first column names the row.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct TextTable {
    /// What the table shows.
    pub title: String,
    /// The names of the columns.
    pub header: Vec<String>,
    /// The rows, each as long as the header.
    pub rows: Vec<Vec<String>>,
}
