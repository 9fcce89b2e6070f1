//! Tables and plurals.

use reachtube::report::TextTable;

use crate::output::printable;

/// Returns the word in the number that `count` asks for.
pub(crate) fn plural(count: usize, word: &str) -> String {
    format!("{word}{}", if count == 1 { "" } else { "s" })
}

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
    let rows: Vec<Vec<String>> =
        rows.iter().map(|row| row.iter().map(|cell| one_line(cell)).collect()).collect();
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count());
        cells.chain([header[column].chars().count()]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let line = |cells: Vec<&str>| {
        let aligned = cells.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        format!("  {}\n", aligned.collect::<Vec<_>>().join("   ").trim_end())
    };
    let mut text = line(header.to_vec());
    rows.iter().for_each(|row| text.push_str(&line(row.iter().map(String::as_str).collect())));
    text
}
