//! The page of a model as HTML: verdict, figures, sets, tight spots, settings, and their meaning.

use super::chart::Chart;
use super::error::Error;
use super::figures::{self, FIGURES};
use super::library::Assets;
use super::page::{Lead, Page, Verdict};
use super::plot::{chart_svg, chart_svg_of_size};
use super::skeleton::{anchor, document, fact_table, pair_of_lists, section, table};
use super::terms::{self, Explained};
use super::text::Text;
use super::{check, scripts, tables};
use maud::{Markup, PreEscaped, html};
use reachtube_finding::Table;
use std::io::Write;

/// Width and height of the first figure \[px\].
const LEAD: [f64; 2] = [480.0, 280.0];

/// Writes the page as one HTML file that can be mailed, archived and printed.
///
/// Without JavaScript all figures are shown one below the other. With it, the figure of one suite
/// and one view is shown at once, and an interactive one takes its place when the library is read.
/// The printed bounds of the sets are rounded outward. Equal pages give equal bytes.
///
/// With [`Assets::Inside`] the file needs no other file. With [`Assets::Beside`] its interactive
/// figures need the library of [`write_library`](super::write_library) in the same folder.
///
/// # Errors
///
/// Fails for figures that [`suite_svg`](super::suite_svg) refuses, bounds that are not finite, and
/// where `out` fails.
pub fn write_html(page: &Page, assets: Assets, out: &mut impl Write) -> Result<(), Error> {
    page.sets.iter().try_for_each(check::sets)?;
    page.suites.iter().try_for_each(check::suite)?;
    let sections = sections(page)?;
    let body = html! {
        (badges(&page.lead.badges))
        (verdict(&page.verdict))
        (lead(&page.lead)?)
        (links(&sections))
        @for (_, section) in &sections { (section) }
    };
    let scripts = scripts::scripts(page, assets);
    out.write_all(document(&page.title, &page.subtitle, &body, &scripts).as_bytes())?;
    Ok(())
}

/// Returns the sections that have something to show, each with its title.
fn sections(page: &Page) -> Result<Vec<(&'static str, Markup)>, Error> {
    let mut sections = Vec::new();
    let mut add = |is_there: bool, title: &'static str, body: Markup| {
        if is_there {
            sections.push((title, section(title, &body)));
        }
    };
    let Verdict { warnings, proved, not_proved, .. } = &page.verdict;
    add(!warnings.is_empty(), "Warnings", warning_list(warnings));
    let proofs = [("Proved", "yes", &proved[..]), ("Not proved", "no", &not_proved[..])];
    let is_there = !proved.is_empty() || !not_proved.is_empty();
    add(is_there, "What is proved", pair_of_lists(proofs));
    let suites = !page.suites.is_empty();
    add(suites, FIGURES, figures::figures(page)?);
    add(!page.phase_planes.is_empty(), "Phase planes", phase_planes(&page.phase_planes)?);
    let are_tight = page.suites.iter().any(|suite| !suite.tight.is_empty());
    let decide = page.suites.iter().any(|suite| suite.decided() > 0);
    let tight = if decide { "Where the sets are tight" } else { "Where recordings lie outside" };
    add(are_tight, tight, tables::tight(page));
    add(!page.sets.is_empty(), "Uncertainty sets", sets(page));
    add(!page.cost.is_empty(), "What drives the cost", cost(page)?);
    add(!page.nominal.is_empty(), "Fitted nominal model", text_tables(&page.nominal));
    add(!page.trust.is_empty() || !page.caution.is_empty(), "What may be trusted", meaning(page));
    add(!page.facts.is_empty(), "Settings and provenance", fact_table(&page.facts));
    add(!page.notes.is_empty(), "Notes", notes(page));
    add(suites, "Terms", terms::list());
    Ok(sections)
}

/// Returns links to the sections, which stay at the top of the window.
fn links(sections: &[(&str, Markup)]) -> Markup {
    html! {
        @if sections.len() > 1 {
            nav aria-label="Sections" {
                @for (title, _) in sections { a href={ "#" (anchor(title)) } { (title) } }
            }
        }
    }
}

fn verdict(verdict: &Verdict) -> Markup {
    let Verdict { ok, vacuous, useful, warnings, .. } = verdict;
    let (class, word) = match (ok, vacuous, useful, warnings.is_empty()) {
        (false, ..) => ("verdict bad", "Not conformant"),
        (true, true, ..) => ("verdict bad", "Conformant, but vacuous"),
        (true, false, Some(false), _) => ("verdict bad", "Conformant, but not accepted"),
        (true, false, Some(true), true) => ("verdict ok", "Conformant and useful"),
        (true, false, None, true) => ("verdict ok", "Conformant"),
        (true, false, Some(true), false) => {
            ("verdict doubtful", "Conformant and useful, with warnings")
        }
        (true, false, None, false) => ("verdict doubtful", "Conformant, with warnings"),
    };
    html! {
        section class=(class) aria-labelledby="verdict" {
            h2 #verdict { (word) }
            p.words { (Explained(&verdict.words)) }
        }
    }
}

pub(crate) fn warning_list(warnings: &[String]) -> Markup {
    html! { ul.warnings { @for warning in warnings { li { (Explained(warning)) } } } }
}

fn badges(badges: &[String]) -> Markup {
    html! {
        @if !badges.is_empty() {
            p.badges { @for badge in badges { span.badge { (Text(badge)) } } }
        }
    }
}

/// Returns the answer in numbers beside the figure of the widest set.
fn lead(lead: &Lead) -> Result<Markup, Error> {
    let figure = lead.figure.as_ref().map(|chart| chart_svg_of_size(chart, LEAD)).transpose()?;
    Ok(html! {
        @if !lead.facts.is_empty() || figure.is_some() {
            section.lead aria-label="The answer in numbers" {
                div {
                    dl {
                        @for (name, value) in &lead.facts {
                            div { dt { (Explained(name)) } dd { (Explained(value)) } }
                        }
                    }
                    @for (words, address) in &lead.links {
                        p { "See also: " a href=(address) { (Text(words)) } }
                    }
                }
                @if let Some(svg) = figure {
                    figure { (PreEscaped(svg)) figcaption { (Explained(&lead.caption)) } }
                }
            }
        }
    })
}

/// Returns the phase planes under a sentence that says what they are.
fn phase_planes(charts: &[Chart]) -> Result<Markup, Error> {
    let svgs: String = charts.iter().map(chart_svg).collect::<Result<_, _>>()?;
    let words = "Each joint at the sample where a recording comes closest to the boundary of the \
                 reachable set in the phase plane, or leaves it furthest, as deviations from the \
                 nominal motion. Grey: the interval hull. Blue: the set. Orange: the recordings. \
                 A point between blue and grey lies in the hull, and no motion of the model \
                 reaches it.";
    Ok(html! { p { (words) } div.charts #planes { (PreEscaped(svgs)) } })
}

fn sets(page: &Page) -> Markup {
    html! {
        div.tables {
            @for table in &page.sets { (tables::sets(table)) }
        }
        p {
            "Printed bounds are rounded outward at their last digit: the printed sets contain the \
             checked ones. The bars of a column share one scale; their middle is 0."
        }
    }
}

fn text_tables(all: &[Table]) -> Markup {
    html! {
        div.tables {
            @for text in all { (table("sets", text)) }
        }
    }
}

/// Returns what drives the cost: the tables, and the runs over their order and temperature.
fn cost(page: &Page) -> Result<Markup, Error> {
    let svgs: String = page.cost_charts.iter().map(chart_svg).collect::<Result<_, _>>()?;
    Ok(html! {
        p {
            (Explained("The cost is the set's width, summed over states and integrated over time. \
                        It adds rad to rad/s and grows with the length of the motions, so it is \
                        compared only within one data set."))
        }
        div.charts { (PreEscaped(svgs)) }
        (text_tables(&page.cost))
    })
}

fn meaning(page: &Page) -> Markup {
    pair_of_lists([
        ("You may rely on", "yes", &page.trust),
        ("Do not conclude", "no", &page.caution),
    ])
}

fn notes(page: &Page) -> Markup {
    html! {
        @for note in &page.notes { p { (Text(note)) } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use crate::suite_figure::SuiteFigure;

    fn written(page: &Page) -> String {
        let mut html = Vec::new();
        write_html(page, Assets::Beside, &mut html).unwrap();
        String::from_utf8(html).unwrap()
    }

    #[test]
    fn each_view_of_each_suite_has_a_figure() {
        let html = written(&sample::page());
        assert_eq!(html.matches("<svg").count(), 7, "with the first, a phase plane and the cost");
        assert_eq!(html.matches("</svg>").count(), 7);
        assert_eq!(html.matches("<section").count(), html.matches("</section>").count());
        assert_eq!(html.matches("<table").count(), html.matches("</table>").count());
    }

    #[test]
    fn every_text_is_escaped() {
        let html = written(&sample::page());
        assert_eq!(html.matches("<script>").count(), 1);
        for what in [
            "title", "subtitle", "words", "proved", "A", "name", "value", "trust", "caution",
            "note", "header", "cell", "badge", "fact", "number", "caption", "link",
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
        page.verdict.useful = Some(true);
        assert!(written(&page).contains(">Conformant and useful<"));
        page.verdict.useful = Some(false);
        assert!(written(&page).contains(">Conformant, but not accepted<"));
        page.verdict.ok = false;
        assert!(written(&page).contains(">Not conformant<"));
    }

    #[test]
    fn the_answer_and_one_figure_come_before_any_table_with_the_mark_of_a_simulation() {
        let mut page = sample::page();
        page.lead.badges = vec!["simulated data".into()];
        let html = written(&page);
        let place = |part: &str| html.find(part).unwrap_or_else(|| panic!("{part}"));
        let body = place("<body");
        let order = ["simulated data", "id=\"verdict\"", "<dl", "<figure", "<nav", "<table"];
        let places = order.map(|part| body + html[body..].find(part).unwrap());
        assert!(places.is_sorted(), "{places:?}");
        assert!(html.contains("href=\"../held-out/report.html\""));
        page.lead.badges.clear();
        assert!(!written(&page).contains("class=\"badge\""));
    }

    #[test]
    fn of_many_suites_the_first_have_static_figures_and_all_have_numbers() {
        let mut page = sample::page();
        let condensed = SuiteFigure { undrawn: 12, ..sample::suite("S", 1) };
        page.suites = vec![condensed; 40];
        let html = written(&page);
        assert_eq!(html.matches("<svg").count(), 2 * 3 + 3);
        assert!(html.contains("id=\"data-39\"") && html.contains("id=\"suite-search\""));
    }

    #[test]
    fn a_page_without_tight_spots_has_no_section_for_them() {
        let mut page = sample::page();
        assert!(written(&page).contains("Where the sets are tight"));
        let spots = |page: &mut Page, keep: usize| {
            page.suites.iter_mut().for_each(|suite| suite.tight.truncate(keep));
        };
        spots(&mut page, 1);
        page.suites.iter_mut().for_each(|suite| suite.tight[0].margin = -0.1);
        let html = written(&page);
        assert!(!html.contains("are tight") && html.contains("Where recordings lie outside"));
        spots(&mut page, 0);
        let html = written(&page);
        assert!(!html.contains("are tight") && !html.contains("Where recordings lie outside"));
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
        let error = write_html(&sample::page(), Assets::Beside, &mut &mut room[..]).unwrap_err();
        assert!(matches!(error, Error::Io(_)));
    }
}
