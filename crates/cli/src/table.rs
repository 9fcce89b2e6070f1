//! Tables.

use reachtube::finding::Table;
use reachtube::finding::printable;
use reachtube::page::TextTable;

/// Returns the text of a cell on one line, so that no name can pretend to be a row of its own.
fn one_line(text: &str) -> String {
    printable(&text.replace('\n', "\\n"))
}

/// Lays out a table of the library under its title.
pub(crate) fn titled(text: &TextTable) -> String {
    format!("{}\n\n{}", one_line(&text.title), untitled(text))
}

/// Lays out a table of the library.
pub(crate) fn untitled(text: &TextTable) -> String {
    let header: Vec<&str> = text.header.iter().map(String::as_str).collect();
    table(&header, &text.rows)
}

/// Lays out a table: the first column is left-aligned, the others are right-aligned.
pub(crate) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    Table::new(header.iter().copied(), rows.to_vec()).to_string()
}
