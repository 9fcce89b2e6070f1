//! Tables.

use reachtube::finding::Table;

/// Lays out a table: the first column is left-aligned, the others are right-aligned.
pub(crate) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    Table::new(header.iter().copied(), rows.to_vec()).to_string()
}
