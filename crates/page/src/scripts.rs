//! The scripts at the end of the page: its controls, the numbers of its figures, and the library
//! that draws them.

use super::colour;
use super::interactive::{in_script, suite_json};
use super::library::{Assets, compressed_library};
use super::page::Page;
use maud::{Markup, PreEscaped, html};

const SCRIPT: &str = concat!(
    include_str!("numbers.js"),
    include_str!("figure.js"),
    include_str!("planes.js"),
    include_str!("page.js")
);

/// Returns the scripts of a page with figures; no text for a page without figures.
///
/// The browser runs only the controls by itself. The others are texts to it: the words and the
/// first static figure are on the screen before the script reads the library, and the numbers of a
/// suite are read when it is shown.
pub(super) fn scripts(page: &Page, assets: Assets) -> Markup {
    if page.suites.is_empty() {
        return Markup::default();
    }
    let json = |data: serde_json::Result<String>| in_script(&data.expect("numbers are finite"));
    let anchors = json(serde_json::to_string(&colour::ANCHORS));
    let planes = json(serde_json::to_string(&page.phase_planes));
    html! {
        (text("application/json", "scale", &anchors))
        (text("application/json", "plane-data", &planes))
        script { (PreEscaped("\n")) (PreEscaped(SCRIPT)) }
        @for (index, suite) in page.suites.iter().enumerate() {
            (text("application/json", &format!("data-{index}"), &suite_json(suite)))
        }
        @if assets == Assets::Inside { (text("text/plain", "library", &compressed_library())) }
    }
}

/// Returns a script element that the browser does not run.
fn text(kind: &str, id: &str, text: &str) -> Markup {
    html! {
        script type=(kind) id=(id) { (PreEscaped(text)) }
    }
}
