//! The page: verdict, figures, sets, tight spots, settings, and what may be trusted, in one file.

use super::text::escape;
use super::{
    Page, ReportError, RunTrace, SuiteFigure, View, check, colour, figure::suite_svg,
    layout::Layout, tables,
};
use std::io::Write;

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
/// The browser is told what the page promises: nothing is loaded from anywhere.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// Writes the page as one HTML file that needs nothing else: it can be mailed, archived and
/// printed. Without JavaScript all figures are shown one below the other; with it, one suite and
/// one view at a time.
///
/// The printed bounds of the sets are rounded outward. The same page gives the same bytes.
///
/// # Errors
///
/// What [`suite_svg`] refuses, bounds that are not finite, and failures of `out`.
///
/// # Examples
///
/// ```
/// use reachtube::report::{Page, Verdict, write_html};
///
/// let verdict = Verdict { ok: true, words: "All 73 runs lie in the reachable set.".into(), ..Verdict::default() };
/// let mut html = Vec::new();
/// write_html(&Page { title: "LWA 4P".into(), verdict, ..Page::default() }, &mut html)?;
/// assert!(String::from_utf8(html).unwrap().contains("All 73 runs"));
/// # Ok::<(), reachtube::report::ReportError>(())
/// ```
pub fn write_html(page: &Page, out: &mut impl Write) -> Result<(), ReportError> {
    page.sets.iter().try_for_each(check::sets)?;
    let figures = page.suites.iter().enumerate().map(|(index, suite)| suite_section(index, suite));
    let figures: Vec<String> = figures.collect::<Result<_, _>>()?;
    out.write_all(top(&page.title, &page.subtitle).as_bytes())?;
    out.write_all(verdict(page).as_bytes())?;
    if !figures.is_empty() {
        out.write_all(controls(page).as_bytes())?;
        figures.iter().try_for_each(|figure| out.write_all(figure.as_bytes()))?;
        out.write_all(b"</section>\n")?;
    }
    out.write_all(rest(page).as_bytes())?;
    out.write_all(format!("</main>\n<script>\n{SCRIPT}</script>\n</body>\n</html>\n").as_bytes())?;
    Ok(())
}

/// The head of a page, up to its heading.
pub(super) fn top(title: &str, subtitle: &str) -> String {
    let title = escape(title);
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" href=\"data:,\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n\
         <header><h1>{title}</h1>\n<p>{}</p></header>\n",
        escape(subtitle)
    )
}

fn verdict(page: &Page) -> String {
    let verdict = &page.verdict;
    let (class, word) = if verdict.ok { ("ok", "Conformant") } else { ("bad", "Not conformant") };
    format!(
        "<section class=\"verdict {class}\" aria-labelledby=\"verdict\">\n<h2 id=\"verdict\">{word}</h2>\n\
         <p class=\"words\">{}</p>\n<div class=\"pair\">\n{}{}</div>\n</section>\n",
        escape(&verdict.words),
        titled_list("Proved", "yes", &verdict.proved),
        titled_list("Not proved", "no", &verdict.not_proved),
    )
}

/// A heading and its points; nothing where there are none.
pub(super) fn titled_list(title: &str, class: &str, points: &[String]) -> String {
    if points.is_empty() {
        return String::new();
    }
    let points: String =
        points.iter().map(|point| format!("<li>{}</li>\n", escape(point))).collect();
    format!("<div>\n<h3>{title}</h3>\n<ul class=\"{class}\">\n{points}</ul>\n</div>\n")
}

/// The head of the figures: a button a suite and a button a view, shown by the script only.
fn controls(page: &Page) -> String {
    let suites: String = page
        .suites
        .iter()
        .enumerate()
        .map(|(k, suite)| button(&k.to_string(), &suite.suite))
        .collect();
    let both = page.suites.iter().any(|suite| suite.views().len() == 2);
    let views = [("motion", "Motion"), ("deviation", "Deviation from the nominal")];
    let views: String = views.map(|(value, label)| button(value, label)).concat();
    let views = if both { group("views", "View", &views) } else { String::new() };
    let suites =
        if page.suites.len() > 1 { group("suites", "Suite", &suites) } else { String::new() };
    format!(
        "<section id=\"figures\" aria-labelledby=\"figures-title\">\n<h2 id=\"figures-title\">Recordings in the reachable set</h2>\n\
         <div class=\"controls\">{suites}{views}</div>\n"
    )
}

fn group(id: &str, label: &str, buttons: &str) -> String {
    format!(
        "<div class=\"choice\" id=\"{id}\" role=\"group\" aria-label=\"{label}\" hidden>{buttons}</div>"
    )
}

fn button(value: &str, label: &str) -> String {
    format!(
        "<button type=\"button\" value=\"{value}\" aria-pressed=\"false\">{}</button>",
        escape(label)
    )
}

fn suite_section(index: usize, suite: &SuiteFigure) -> Result<String, ReportError> {
    let views = suite.views();
    let figures: String =
        views.iter().map(|&view| figure(suite, view)).collect::<Result<_, _>>()?;
    let name = escape(&suite.suite);
    Ok(format!(
        "<section class=\"suite\" id=\"suite-{index}\" data-suite=\"{index}\" aria-label=\"Suite {name}\">\n\
         <h3>Suite {name}</h3>\n{figures}{}</section>\n",
        chips(suite)
    ))
}

fn figure(suite: &SuiteFigure, view: View) -> Result<String, ReportError> {
    let svg = suite_svg(suite, view)?;
    let name = if view == View::Motion { "motion" } else { "deviation" };
    let width = Layout::new(suite.joints.len()).width();
    let choice =
        if suite.views().len() == 2 { format!(" data-view=\"{name}\"") } else { String::new() };
    Ok(format!(
        "<figure{choice}>\n<div class=\"wide\" style=\"--width:{width}px\" tabindex=\"0\" role=\"region\" aria-label=\"Figure, {name}\">\n{svg}</div>\n\
         <figcaption>{}</figcaption>\n</figure>\n",
        caption(suite, view)
    ))
}

fn caption(suite: &SuiteFigure, view: View) -> String {
    let what = match view {
        View::Motion => "The recorded states",
        View::Deviation => "The recorded states minus the nominal trajectory",
    };
    let rings = match suite.tight.len() {
        0 => "",
        _ => " Rings mark the samples that decide the sets, or leave them furthest.",
    };
    let outside = suite.tight.iter().filter(|spot| spot.margin < 0.0).count();
    let outside = match outside {
        0 => String::new(),
        1 => " The larger red ring marks a sample outside the set.".into(),
        more => format!(" The larger red rings mark {more} samples outside the set."),
    };
    format!(
        "{what} of {} runs (lines) in the reachable set (grey), from {} to {} s. Between samples the edges of the set \
         are joined by straight lines.{rings}{outside}",
        suite.runs.len(),
        super::number::short(suite.times[0], 5),
        super::number::short(suite.times[suite.times.len() - 1], 5),
    )
}

/// The runs by name and colour, each with the number of support rows it decides; choosing one
/// singles out its lines.
fn chips(suite: &SuiteFigure) -> String {
    if suite.runs.is_empty() {
        return String::new();
    }
    let heat = colour::heat(&suite.runs).values;
    let chips: String = suite.runs.iter().zip(heat).map(|(run, heat)| chip(run, heat)).collect();
    let idle = suite.runs.iter().filter(|run| run.touches == 0).count();
    format!(
        "<p class=\"hint\">Runs and the support rows each decides ({idle} of {} decide none):</p>\n\
         <ul class=\"runs\">\n{chips}</ul>\n",
        suite.runs.len()
    )
}

fn chip(run: &RunTrace, heat: f64) -> String {
    let stroke = colour::hex(colour::colour(heat));
    let degrees =
        run.temperature.map_or(String::new(), |degrees| format!(" <small>{degrees:.1} °C</small>"));
    let touches = if run.touches == 0 { String::new() } else { format!(" <b>{}</b>", run.touches) };
    format!(
        "<li><button type=\"button\" data-stroke=\"{stroke}\" aria-pressed=\"false\"><i style=\"background:{stroke}\"></i>{}{degrees}{touches}</button></li>\n",
        escape(&run.name)
    )
}

/// What follows the figures.
fn rest(page: &Page) -> String {
    let mut html = String::new();
    if !page.sets.is_empty() {
        let tables: String = page.sets.iter().map(tables::sets).collect();
        let words = "<p>Printed bounds are rounded outward at their last digit: the printed sets contain the checked ones. \
                     The bars share one scale a column; their middle is 0.</p>\n";
        html += &section(
            "Uncertainty sets",
            &format!("<div class=\"tables\">\n{tables}</div>\n{words}"),
        );
    }
    if !page.suites.is_empty() {
        html += &section("Where the sets are tight", &tables::tight(page));
    }
    let trust = titled_list("You may rely on", "yes", &page.trust)
        + &titled_list("Do not conclude", "no", &page.caution);
    if !trust.is_empty() {
        html += &section("What may be trusted", &format!("<div class=\"pair\">\n{trust}</div>\n"));
    }
    if !page.facts.is_empty() {
        html += &section("Settings and provenance", &tables::facts(&page.facts));
    }
    if !page.notes.is_empty() {
        let notes: String =
            page.notes.iter().map(|note| format!("<p>{}</p>\n", escape(note))).collect();
        html += &section("Notes", &notes);
    }
    html
}

pub(super) fn section(title: &str, body: &str) -> String {
    format!("<section>\n<h2>{title}</h2>\n{body}</section>\n")
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    fn written(page: &Page) -> String {
        let mut html = Vec::new();
        write_html(page, &mut html).unwrap();
        String::from_utf8(html).unwrap()
    }

    #[test]
    fn a_figure_a_suite_and_view() {
        let html = written(&sample::page());
        assert_eq!(html.matches("<svg").count(), 4);
        assert_eq!(html.matches("</svg>").count(), 4);
        assert_eq!(html.matches("<section").count(), html.matches("</section>").count());
        assert_eq!(html.matches("<table").count(), html.matches("</table>").count());
    }

    #[test]
    fn every_text_is_escaped() {
        let html = written(&sample::page());
        assert_eq!(html.matches("<script>").count(), 1);
        for what in [
            "title", "subtitle", "words", "proved", "A", "name", "value", "trust", "caution",
            "note",
        ] {
            assert!(html.contains(&format!("{what} &lt;script&gt;")), "{what}");
        }
    }

    #[test]
    fn nothing_is_loaded_from_anywhere() {
        let html = written(&sample::page()).replace("http://www.w3.org/2000/svg", "");
        for outside in ["http:", "https:", "src=", "@import", "url("] {
            assert!(!html.contains(outside), "{outside}");
        }
    }

    #[test]
    fn the_verdict_is_said_in_words() {
        let mut page = sample::page();
        assert!(written(&page).contains(">Conformant<"));
        page.verdict.ok = false;
        assert!(written(&page).contains(">Not conformant<"));
    }

    #[test]
    fn an_empty_page_is_a_page() {
        let html = written(&Page::default());
        assert!(html.ends_with("</html>\n") && !html.contains("<svg"));
    }

    #[test]
    fn the_same_page_gives_the_same_bytes() {
        assert_eq!(written(&sample::page()), written(&sample::page()));
    }

    #[test]
    fn a_disk_that_is_full_is_an_error() {
        let mut room = [0_u8; 100];
        let error = write_html(&sample::page(), &mut &mut room[..]).unwrap_err();
        assert!(matches!(error, ReportError::Io(_)));
    }
}
