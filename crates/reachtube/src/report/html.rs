//! The page of a model as HTML: verdict, figures, sets, tight spots, settings, and their meaning.

use super::chart::{Chart, chart_svg};
use super::error::ReportError;
use super::figure::suite_svg;
use super::layout::Layout;
use super::page::{Page, Verdict};
use super::skeleton::{document, pair_of_lists, section};
use super::suite_figure::{RunTrace, SuiteFigure, View};
use super::text::Text;
use super::{check, colour, tables};
use crate::number::significant;
use maud::{Markup, PreEscaped, html};
use std::io::Write;

const SCRIPT: &str = include_str!("page.js");

/// Writes the page as one HTML file that needs no other file: it can be mailed, archived and
/// printed.
///
/// Without JavaScript all figures are shown one below the other; with it, one suite and one view at
/// a time. The printed bounds of the sets are rounded outward. Equal pages give equal bytes.
///
/// # Errors
///
/// Fails for figures that [`suite_svg`] refuses, bounds that are not finite, and where `out` fails.
///
/// # Examples
///
/// ```
/// use reachtube::report::{Page, Verdict, write_html};
///
/// let words = "All 73 runs lie in the reachable set.".into();
/// let verdict = Verdict { ok: true, words, ..Verdict::default() };
/// let mut html = Vec::new();
/// write_html(&Page { title: "LWA 4P".into(), verdict, ..Page::default() }, &mut html)?;
/// assert!(String::from_utf8(html).unwrap().contains("All 73 runs"));
/// # Ok::<(), reachtube::report::ReportError>(())
/// ```
pub fn write_html(page: &Page, out: &mut impl Write) -> Result<(), ReportError> {
    page.sets.iter().try_for_each(check::sets)?;
    let suites = page.suites.iter().enumerate().map(|(index, suite)| suite_section(index, suite));
    let suites: Vec<Markup> = suites.collect::<Result<_, _>>()?;
    let body = html! {
        (verdict(&page.verdict))
        @if !suites.is_empty() { (figures(page, &suites)) }
        @if !page.sets.is_empty() { (sets(page)) }
        (phase_planes(&page.phase_planes)?)
        @if !page.nominal.is_empty() { (nominal(page)) }
        @if !suites.is_empty() { (section("Where the sets are tight", &tables::tight(page))) }
        (meaning(page))
        @if !page.facts.is_empty() {
            (section("Settings and provenance", &tables::facts(&page.facts)))
        }
        @if !page.notes.is_empty() { (notes(page)) }
    };
    out.write_all(document(&page.title, &page.subtitle, &body, Some(SCRIPT)).as_bytes())?;
    Ok(())
}

fn verdict(verdict: &Verdict) -> Markup {
    let (class, word) = match (verdict.ok, verdict.warnings.is_empty()) {
        (true, true) => ("verdict ok", "Conformant"),
        (true, false) => ("verdict doubtful", "Conformant, with warnings"),
        (false, _) => ("verdict bad", "Not conformant"),
    };
    html! {
        section class=(class) aria-labelledby="verdict" {
            h2 #verdict { (word) }
            p.words { (Text(&verdict.words)) }
            @if !verdict.warnings.is_empty() {
                ul.warnings { @for warning in &verdict.warnings { li { (Text(warning)) } } }
            }
            (pair_of_lists([
                ("Proved", "yes", &verdict.proved),
                ("Not proved", "no", &verdict.not_proved),
            ]))
        }
    }
}

/// Returns the figures under their buttons, one per suite and one per view; only the script shows
/// the buttons.
fn figures(page: &Page, suites: &[Markup]) -> Markup {
    let both_views = page.suites.iter().any(|suite| suite.views().len() == 2);
    html! {
        section #figures aria-labelledby="figures-title" {
            h2 #figures-title { "Recordings in the reachable set" }
            div.controls {
                @if page.suites.len() > 1 {
                    div.choice #suites role="group" aria-label="Suite" hidden {
                        @for (k, suite) in page.suites.iter().enumerate() {
                            (button(&k.to_string(), &suite.suite))
                        }
                    }
                }
                @if both_views {
                    div.choice #views role="group" aria-label="View" hidden {
                        (button("motion", "Motion"))
                        (button("deviation", "Deviation from the nominal"))
                    }
                }
            }
            @for suite in suites { (suite) }
        }
    }
}

fn button(value: &str, label: &str) -> Markup {
    html! {
        button type="button" value=(value) aria-pressed="false" { (Text(label)) }
    }
}

fn suite_section(index: usize, suite: &SuiteFigure) -> Result<Markup, ReportError> {
    let figures = suite.views().iter().map(|&view| figure(suite, view));
    let figures: Vec<Markup> = figures.collect::<Result<_, _>>()?;
    let name = Text(&suite.suite);
    Ok(html! {
        section.suite id={ "suite-" (index) } data-suite=(index) aria-label={ "Suite " (name) } {
            h3 { "Suite " (name) }
            @for figure in figures { (figure) }
            @if !suite.runs.is_empty() { (runs(suite)) }
        }
    })
}

fn figure(suite: &SuiteFigure, view: View) -> Result<Markup, ReportError> {
    let svg = suite_svg(suite, view)?;
    let name = if view == View::Motion { "motion" } else { "deviation" };
    let width = Layout::new(suite.joints.len()).width();
    let choice = (suite.views().len() == 2).then_some(name);
    Ok(html! {
        figure data-view=[choice] {
            div.wide style={ "--width:" (width) "px" } tabindex="0" role="region"
                aria-label={ "Figure, " (name) } {
                (PreEscaped(svg))
            }
            figcaption { (caption(suite, view)) }
        }
    })
}

fn caption(suite: &SuiteFigure, view: View) -> String {
    let what = match view {
        View::Motion => "The recorded states",
        View::Deviation => "The recorded states minus the nominal solution",
    };
    let rings = match suite.tight.len() {
        0 => "",
        _ => " Rings mark the samples that decide the sets or lie furthest outside them.",
    };
    let outside = suite.tight.iter().filter(|spot| spot.margin < 0.0).count();
    let outside = match outside {
        0 => String::new(),
        1 => " The larger red ring marks a sample outside the set.".into(),
        more => format!(" The larger red rings mark {more} samples outside the set."),
    };
    format!(
        "{what} of {} runs (lines) in the reachable set (grey), from {} to {} s. Between samples \
         the edges of the set are joined by straight lines.{rings}{outside}",
        suite.runs.len(),
        significant(suite.times[0], 5),
        significant(suite.times[suite.times.len() - 1], 5),
    )
}

/// Returns the runs by name and colour, each with the number of support rows it decides. Choosing a
/// run highlights its lines.
fn runs(suite: &SuiteFigure) -> Markup {
    let heat = colour::heat(&suite.runs).values;
    let idle = suite.runs.iter().filter(|run| run.touches == 0).count();
    html! {
        p.hint {
            "Runs and the number of support rows that each decides (" (idle) " of "
            (suite.runs.len()) " decide none):"
        }
        ul.runs {
            @for (run, heat) in suite.runs.iter().zip(heat) { li { (run_button(run, heat)) } }
        }
    }
}

fn run_button(run: &RunTrace, heat: f64) -> Markup {
    let stroke = colour::hex(colour::colour(heat));
    html! {
        button type="button" data-stroke=(stroke) aria-pressed="false" {
            i style={ "background:" (stroke) } {}
            (Text(&run.name))
            @if let Some(degrees) = run.temperature {
                " " small { (format!("{degrees:.1} °C")) }
            }
            @if run.touches > 0 { " " b { (run.touches) } }
        }
    }
}

/// Returns the phase planes under a sentence that says what they are.
fn phase_planes(charts: &[Chart]) -> Result<Markup, ReportError> {
    if charts.is_empty() {
        return Ok(html! {});
    }
    let svgs: String = charts.iter().map(chart_svg).collect::<Result<_, _>>()?;
    let words = "Each joint at the sample where a recording comes closest to the boundary of the \
                 reachable set in the phase plane, or leaves it furthest, as deviations from the \
                 nominal motion. Grey: the interval hull. Blue: the set. Orange: the recordings. \
                 A point between blue and grey lies in the hull, and no motion of the model \
                 reaches it.";
    Ok(section("Phase planes", &html! { p { (words) } div.charts { (PreEscaped(svgs)) } }))
}

fn sets(page: &Page) -> Markup {
    let body = html! {
        div.tables {
            @for table in &page.sets { (tables::sets(table)) }
        }
        p {
            "Printed bounds are rounded outward at their last digit: the printed sets contain the \
             checked ones. The bars of a column share one scale; their middle is 0."
        }
    };
    section("Uncertainty sets", &body)
}

fn nominal(page: &Page) -> Markup {
    let body = html! {
        div.tables {
            @for table in &page.nominal { (tables::texts(table)) }
        }
    };
    section("Nominal model, fitted for small sets", &body)
}

/// Returns what the reader may and may not conclude; nothing where the page does not say.
fn meaning(page: &Page) -> Markup {
    if page.trust.is_empty() && page.caution.is_empty() {
        return Markup::default();
    }
    let lists = pair_of_lists([
        ("You may rely on", "yes", &page.trust),
        ("Do not conclude", "no", &page.caution),
    ]);
    section("What may be trusted", &lists)
}

fn notes(page: &Page) -> Markup {
    let notes = html! {
        @for note in &page.notes { p { (Text(note)) } }
    };
    section("Notes", &notes)
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
    fn each_view_of_each_suite_has_a_figure() {
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
            "note", "header", "cell",
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
    fn the_verdict_is_given_in_words() {
        let mut page = sample::page();
        assert!(written(&page).contains(">Conformant, with warnings<"));
        page.verdict.warnings.clear();
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
    fn a_full_disk_is_an_error() {
        let mut room = [0_u8; 100];
        let error = write_html(&sample::page(), &mut &mut room[..]).unwrap_err();
        assert!(matches!(error, ReportError::Io(_)));
    }
}
