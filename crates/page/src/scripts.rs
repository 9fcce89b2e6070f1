//! The scripts at the end of the page: its controls, the numbers of its figures, and the library
//! that draws them.

use super::chart::{Chart, Series};
use super::colour;
use super::interactive::{in_script, suite_json};
use super::library::{Assets, compressed_library};
use super::page::Page;
use maud::{Markup, PreEscaped, html};
use serde::Serialize;

const SCRIPT: &str = concat!(
    include_str!("numbers.js"),
    include_str!("figure.js"),
    include_str!("planes.js"),
    include_str!("page.js")
);

/// A chart for the script.
#[derive(Serialize)]
struct ChartData<'a> {
    title: &'a str,
    x: &'a str,
    y: &'a str,
    series: Vec<SeriesData>,
}

#[derive(Serialize)]
struct SeriesData {
    x: Vec<f64>,
    y: Vec<f64>,
    dots: bool,
    colour: [u8; 3],
}

/// Returns the scripts of a page with figures; no text for a page without figures.
///
/// The browser runs only the controls by itself. The others are texts to it: the words and the
/// first static figure are on the screen before the script reads the library, and the numbers of a
/// suite are read when it is shown.
pub(super) fn scripts(page: &Page, assets: Assets) -> Markup {
    if page.suites.is_empty() {
        return Markup::default();
    }
    let anchors = serde_json::to_string(&colour::ANCHORS).expect("numbers are finite");
    html! {
        (text("application/json", "scale", &anchors))
        (text("application/json", "plane-data", &charts(&page.phase_planes)))
        script { (PreEscaped("\n")) (PreEscaped(SCRIPT)) }
        @for (index, suite) in page.suites.iter().enumerate() {
            (text("application/json", &format!("data-{index}"), &suite_json(suite)))
        }
        @if assets == Assets::Inside { (text("text/plain", "library", &compressed_library())) }
    }
}

fn charts(charts: &[Chart]) -> String {
    let series = |series: &Series| {
        let (x, y) = series.points.iter().copied().unzip();
        SeriesData { x, y, dots: series.dots, colour: series.colour }
    };
    let chart = |chart: &'_ Chart| {
        let Chart { title, x, y, .. } = chart;
        let series = chart.series.iter().map(series).collect();
        serde_json::to_string(&ChartData { title, x, y, series }).expect("numbers are finite")
    };
    in_script(&format!("[{}]", charts.iter().map(chart).collect::<Vec<_>>().join(",")))
}

/// Returns a script element that the browser does not run.
fn text(kind: &str, id: &str, text: &str) -> Markup {
    html! {
        script type=(kind) id=(id) { (PreEscaped(text)) }
    }
}
