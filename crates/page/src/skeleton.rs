//! The parts that all pages share: the document around a page, sections, and lists.

use super::terms::Explained;
use super::text::{Text, capital};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use reachtube_finding::Table;

const STYLE: &str = include_str!("page.css");
/// The browser enforces that the page loads nothing from anywhere, but for a library that is a file
/// beside it. Figures are saved from blobs.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; \
                      script-src 'unsafe-inline' 'self' file:; img-src data: blob:";

/// Returns a page as one HTML document. The scripts stand at its end.
pub fn document(title: &str, subtitle: &str, body: &Markup, scripts: &Markup) -> String {
    let document = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                (own_mark())
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                link rel="icon" href="data:,";
                title { (Text(title)) }
                style { (PreEscaped("\n")) (PreEscaped(STYLE)) }
            }
            body {
                main {
                    header {
                        h1 { (Text(title)) }
                        p { (Text(subtitle)) }
                    }
                    (body)
                }
                (scripts)
            }
        }
    };
    document.into_string() + "\n"
}

/// Returns the comment by which a later command recognises a file that it may replace.
pub(super) fn own_mark() -> Markup {
    PreEscaped(format!("<!-- {} -->", reachtube_files::MARK))
}

/// Returns a verdict in the colour of `class`: its first words, up to a colon, are the heading.
pub(super) fn verdict(class: &str, sentence: &str) -> Markup {
    let (head, words) = sentence.split_once(": ").unwrap_or((sentence, ""));
    html! {
        div class={ "verdict " (class) } {
            h2 { (Text(&capital(head))) }
            p.words { (Explained(&capital(words))) }
        }
    }
}

/// Returns a section under a heading.
pub fn section(title: &str, body: &Markup) -> Markup {
    html! {
        section id=(anchor(title)) { h2 { (title) } (body) }
    }
}

pub(super) fn anchor(title: &str) -> String {
    title.to_lowercase().replace(' ', "-")
}

/// Returns two lists of points side by side, each with its title and class; no text for an empty
/// list.
pub(super) fn pair_of_lists(lists: [(&str, &str, &[String]); 2]) -> Markup {
    html! {
        div.pair {
            @for (title, class, points) in lists {
                @if !points.is_empty() {
                    div {
                        h3 { (title) }
                        ul class=(class) {
                            @for point in points { li { (Explained(point)) } }
                        }
                    }
                }
            }
        }
    }
}

/// Returns a table in a region that scrolls sideways on a narrow screen, named by its caption. The
/// class decides whether its cells are broken into lines: `sets` are not, `long` are.
pub(super) fn wide_table(class: &str, caption: &str, head: &Markup, rows: &Markup) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label=(Text(caption)) {
            table class=(class) {
                caption { (Explained(caption)) }
                thead { tr { (head) } }
                tbody { (rows) }
            }
        }
    }
}

/// Returns a table with columns of numbers aligned right. The class decides whether cells are
/// broken into lines: `sets` are not, `long` are.
pub fn table(class: &str, table: &Table) -> Markup {
    let is_number = |cell: &String| {
        matches!(&**cell, "" | "none")
            || cell.starts_with(|c: char| c.is_ascii_digit() || "+-\u{2212}".contains(c))
    };
    let are_numbers =
        |column: usize| column > 0 && table.rows.iter().all(|row| is_number(&row[column]));
    let numbers: Vec<bool> = (0..table.header.len()).map(are_numbers).collect();
    let head = html! {
        @for (name, number) in table.header.iter().zip(&numbers) {
            th.number[*number] scope="col" { (Explained(name)) }
        }
    };
    let rows = html! {
        @for cells in &table.rows {
            tr {
                th scope="row" { (Text(&cells[0])) }
                @for (cell, number) in cells.iter().zip(&numbers).skip(1) {
                    td.number[*number] { (Text(cell)) }
                }
            }
        }
    };
    wide_table(class, &capital(&table.title), &head, &rows)
}

/// Returns a table of names and values.
pub fn fact_table(facts: &[(impl AsRef<str>, String)]) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label="Names and values" {
            table.facts {
                tbody {
                    @for (name, value) in facts {
                        tr {
                            th scope="row" { (Explained(name.as_ref())) }
                            td { (Text(value)) }
                        }
                    }
                }
            }
        }
    }
}
