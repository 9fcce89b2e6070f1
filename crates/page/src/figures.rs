//! The section of the figures: the static ones, and the controls of the interactive one.

use super::colour;
use super::error::Error;
use super::figure::suite_svg;
use super::layout::Layout;
use super::page::Page;
use super::suite_figure::{RunTrace, SuiteFigure, View};
use super::svg::hex;
use super::text::Text;
use maud::{Markup, PreEscaped, html};
use reachtube_scalar::number::{counted, significant};

/// Title of the section.
pub(super) const FIGURES: &str = "Recordings in the set";
/// Number of suites up to which each has a static figure.
pub(super) const MOST_STATIC: usize = 12;
/// Number of suites with a static figure if there are more; the first are the worst.
const STATIC_OF_MANY: usize = 3;

/// Returns the figures under their buttons, one per suite and one per view; only the script shows
/// the buttons.
pub(super) fn figures(page: &Page) -> Result<Markup, Error> {
    let are_many = page.suites.len() > MOST_STATIC;
    let drawn = if are_many { STATIC_OF_MANY } else { page.suites.len() };
    let suites = page.suites.iter().enumerate().take(drawn);
    let suites = suites.map(|(index, suite)| suite_section(index, suite));
    let suites: Vec<Markup> = suites.collect::<Result<_, _>>()?;
    let both_views = page.suites.iter().any(|suite| suite.views().len() == 2);
    Ok(html! {
        div.controls {
            @if are_many {
                label hidden {
                    "Search " (page.suites.len()) " suites, the furthest out first "
                    input #suite-search type="search" placeholder="name of a suite";
                }
            }
            @if page.suites.len() > 1 {
                div.choice.many[are_many] #suites role="group" aria-label="Suite" hidden {
                    @for (k, suite) in page.suites.iter().enumerate() {
                        (button(&k.to_string(), &suite_label(suite, are_many)))
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
        (explorer())
        @for suite in suites { (suite) }
        @if are_many { (suites_table(page)) }
    })
}

/// Returns a suite's name; if there are many, also the part of the set that its runs reach, and the
/// number of rows that they decide or that lie outside.
fn suite_label(suite: &SuiteFigure, are_many: bool) -> String {
    let Some(part) = suite.furthest.filter(|_| are_many) else { return suite.suite.clone() };
    let rows = match (suite.outside, suite.decided()) {
        (0, 0) => String::new(),
        (0, decided) => format!(", decides {decided}"),
        (outside, _) => format!(", {outside} outside"),
    };
    format!("{} {:.0} %{rows}", suite.suite, 100.0 * part)
}

/// Returns the controls and the place of the interactive figure, which the script shows.
fn explorer() -> Markup {
    html! {
        div #explorer hidden {
            div.controls {
                label { "Colour by " select #colour {} }
                label { "Joint " select #joint {} }
                button #reset type="button" { "Whole time" }
            }
            p.legend {
                span #band-names {}
                span #scale-ends { span {} i #scale-bar {} span {} }
            }
            div #plot tabindex="0" role="application"
                aria-label="Interactive figure: arrow keys move in time, plus and minus zoom, \
                            0 shows the whole time" {}
            div.choice {
                span.hint { "Runs" }
                button #show-all type="button" { "All" }
                button #show-none type="button" { "None" }
                button #show-deciding type="button" { "Deciding or outside" }
            }
            ul.runs #run-list {}
            p.hint {
                "Drag to zoom into a box, hold Shift to move, double-click for the whole time; the \
                 times of all panels are linked. With the figure in focus, the arrow keys move, \
                 + and - zoom. A click on a line or on a run's name keeps it highlighted. "
                span #rounding {}
            }
        }
    }
}

/// Returns all suites as a table, for readers without scripts.
fn suites_table(page: &Page) -> Markup {
    // Recordings that the model was not made from decide nothing.
    let decide = page.suites.iter().any(|suite| suite.decided() > 0);
    let leave = page.suites.iter().any(|suite| suite.outside > 0);
    html! {
        div.tall.suite-table tabindex="0" role="region" aria-label="Suites" {
            table {
                thead {
                    tr {
                        th scope="col" { "Suite" }
                        th.number scope="col" { "Runs" }
                        th.number scope="col" { "Part of the set used" }
                        @if decide { th.number scope="col" { "Rows decided" } }
                        @if leave { th.number scope="col" { "Rows outside" } }
                    }
                }
                tbody {
                    @for suite in &page.suites {
                        tr {
                            td { (Text(&suite.suite)) }
                            td.number { (suite.runs.len() + suite.undrawn) }
                            td.number {
                                @if let Some(part) = suite.furthest {
                                    (format!("{:.1} %", 100.0 * part))
                                }
                            }
                            @if decide { td.number { (suite.decided()) } }
                            @if leave { td.number { (suite.outside) } }
                        }
                    }
                }
            }
        }
    }
}

fn button(value: &str, label: &str) -> Markup {
    html! {
        button type="button" value=(value) aria-pressed="false" { (Text(label)) }
    }
}

fn suite_section(index: usize, suite: &SuiteFigure) -> Result<Markup, Error> {
    let figures = suite.views().iter().map(|&view| figure(suite, view));
    let figures: Vec<Markup> = figures.collect::<Result<_, _>>()?;
    let name = Text(&suite.suite);
    Ok(html! {
        section.suite data-suite=(index) aria-label={ "Suite " (name) } {
            h3 { "Suite " (name) }
            @for figure in figures { (figure) }
            @if !suite.runs.is_empty() { (runs(suite)) }
        }
    })
}

fn figure(suite: &SuiteFigure, view: View) -> Result<Markup, Error> {
    let svg = suite_svg(suite, view)?;
    let name = view.name();
    let width = Layout::new(suite.joints.len()).width();
    let (both, only) = match suite.views().len() {
        2 => (Some(name), None),
        _ => (None, Some(name)),
    };
    Ok(html! {
        figure data-view=[both] data-only=[only] {
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
        View::Deviation => "The recorded states minus the nominal motion",
    };
    let rings = match suite.decided() {
        0 => "",
        _ => " Rings mark the samples that decide the sets.",
    };
    let outside = suite.tight.len() - suite.decided();
    let outside = match outside {
        0 => String::new(),
        1 => " The larger red ring marks the sample furthest outside the set.".into(),
        more => format!(" The larger red rings mark {more} samples outside the set."),
    };
    let compared = match suite.positions_only {
        true => " Only positions are compared: velocities are not, and may lie outside the set.",
        false => "",
    };
    format!(
        "{what} of {} (lines) in the reachable set (grey), from {} to {} s.{compared} Between \
         samples the edges of the set are joined by straight lines.{rings}{outside}",
        counted(suite.runs.len(), "run"),
        significant(suite.times[0], 5),
        significant(suite.times[suite.times.len() - 1], 5),
    )
}

/// Returns the runs by name and colour, each with the number of support rows it decides.
fn runs(suite: &SuiteFigure) -> Markup {
    let heat = colour::heat(&suite.runs).values;
    let idle = suite.runs.iter().filter(|run| run.touches == 0).count();
    html! {
        p.hint {
            @if idle == suite.runs.len() { "Runs:" }
            @else {
                "Runs and the number of support rows that each decides (" (idle) " of "
                (suite.runs.len()) " decide none):"
            }
        }
        ul.runs {
            @for (run, heat) in suite.runs.iter().zip(heat) { li { (run_label(run, heat)) } }
        }
    }
}

fn run_label(run: &RunTrace, heat: f64) -> Markup {
    html! {
        span {
            i style={ "background:" (hex(colour::colour(heat))) } {}
            (Text(&run.name))
            @if let Some(degrees) = run.temperature {
                " " small { (format!("{degrees:.1} °C")) }
            }
            @if run.touches > 0 { " " b { (run.touches) } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn a_caption_limits_its_claim_where_only_positions_are_compared() {
        let words = "velocities are not, and may lie outside the set";
        let mut suite = sample::suite("S", 1);
        assert!(!caption(&suite, View::Motion).contains(words));
        suite.positions_only = true;
        assert!(caption(&suite, View::Motion).contains(words));
        assert!(caption(&suite, View::Deviation).contains(words));
    }

    #[test]
    fn suites_that_leave_the_set_decide_nothing() {
        let mut page = sample::page();
        let mut suite = sample::suite("S", 1);
        assert_eq!(suite_label(&suite, true), "S 90 %, decides 2");
        page.suites = vec![suite.clone()];
        let table = suites_table(&page).into_string();
        assert!(table.contains("Rows decided") && !table.contains("Rows outside"));
        suite.tight.truncate(1);
        (suite.tight[0].margin, suite.outside, suite.furthest) = (-0.1, 14, Some(1.5));
        suite.runs.iter_mut().for_each(|run| run.touches = 0);
        assert_eq!(suite_label(&suite, true), "S 150 %, 14 outside");
        assert!(!runs(&suite).into_string().contains("decide"));
        assert!(!caption(&suite, View::Motion).contains("decide"));
        page.suites = vec![suite];
        let table = suites_table(&page).into_string();
        assert!(!table.contains("Rows decided") && table.contains("Rows outside"));
    }
}
