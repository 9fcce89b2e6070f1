//! The legend of a figure: bands, colours and rings, in lines that fit the figure's width.

use super::chart::Mark;
use super::colour::{Heat, colour};
use super::layout::LEGEND_ROW;
use super::plot::{BANDS, ring};
use super::suite_figure::{Band, SuiteFigure, View};
use super::svg::{Anchor, Colour, Svg};

/// Left edge of the first entry \[px\].
const LEFT: f64 = 20.0;
/// Room between two entries \[px\].
const GAP: f64 = 22.0;
/// Width of the sample of a band or ring \[px\].
const SWATCH: f64 = 22.0;
/// Room between a sample and its label \[px\].
const LABEL_GAP: f64 = 6.0;
/// Width of the scale of colours \[px\].
const SCALE: f64 = 120.0;
/// Number of colours of the scale.
const SCALE_STEPS: usize = 40;
/// Mean width of a character \[px\] in a wide font; the page's font is not known when the figure
/// is drawn. Names of suites have digits and capital letters, which are wide.
const CHARACTER: f64 = 6.8;
/// Width of the title, which is bold, over the width of a label with as many characters.
const TITLE_WIDTH: f64 = 1.35;

/// One entry.
enum Entry {
    /// The suite and the view.
    Title(String),
    /// Fill and edge of a band, and its label.
    Band([Colour; 2], String),
    /// The scale of the runs' colours, and the labels of its ends.
    Scale([String; 2]),
    /// What the ring marks, and its label.
    Ring(Mark, String),
}

impl Entry {
    fn width(&self) -> f64 {
        let text = |text: &str| text.chars().count() as f64 * CHARACTER;
        match self {
            Entry::Title(title) => TITLE_WIDTH * text(title),
            Entry::Band(_, label) | Entry::Ring(_, label) => SWATCH + LABEL_GAP + text(label),
            Entry::Scale(ends) => {
                SCALE + 2.0 * LABEL_GAP + ends.iter().map(|end| text(end)).sum::<f64>()
            }
        }
    }
}

/// An entry with its left edge \[px\] and its row.
type Placed = (Entry, f64, usize);

/// The entries of a figure and their places.
pub(super) struct Legend {
    entries: Vec<Placed>,
}

impl Legend {
    pub(super) fn new(figure: &SuiteFigure, view: View, heat: &Heat, width: f64) -> Self {
        let mut entries = vec![Entry::Title(title(figure, view)), band(BANDS[0], &figure.band)];
        entries.extend(figure.inner.iter().map(|inner| band(BANDS[1], inner)));
        if !figure.runs.is_empty() {
            entries.push(Entry::Scale(heat.ends.clone()));
        }
        let outside = figure.tight.iter().filter(|spot| spot.margin < 0.0).count();
        if outside < figure.tight.len() {
            entries.push(Entry::Ring(Mark::Decides, "tight spot".into()));
        }
        if outside > 0 {
            entries.push(Entry::Ring(Mark::Outside, "outside the set".into()));
        }
        Legend { entries: flow(entries, width) }
    }

    pub(super) fn rows(&self) -> usize {
        self.entries.last().map_or(0, |entry| entry.2 + 1)
    }

    pub(super) fn draw(&self, svg: &mut Svg) {
        for (entry, x, row) in &self.entries {
            draw_entry(svg, entry, *x, 6.0 + LEGEND_ROW * (*row as f64 + 0.5));
        }
    }
}

fn title(figure: &SuiteFigure, view: View) -> String {
    let what = match view {
        View::Motion => "motion",
        View::Deviation => "deviation from the nominal",
    };
    format!("{}: {what}", figure.suite)
}

fn band(colours: [Colour; 2], band: &Band) -> Entry {
    Entry::Band(colours, band.label().into())
}

/// Places entries from left to right, on a new row where the next one does not fit.
fn flow(entries: Vec<Entry>, width: f64) -> Vec<Placed> {
    let (mut x, mut row) = (LEFT, 0);
    let mut placed = Vec::with_capacity(entries.len());
    for entry in entries {
        if x > LEFT && x + entry.width() > width {
            (x, row) = (LEFT, row + 1);
        }
        let next = x + entry.width() + GAP;
        placed.push((entry, x, row));
        x = next;
    }
    placed
}

/// Draws an entry whose left edge is `x` and whose middle is `y` \[px\].
fn draw_entry(svg: &mut Svg, entry: &Entry, x: f64, y: f64) {
    let label = |svg: &mut Svg, text: &str, x: f64| svg.text((x, y), text, &Anchor::Start, 11.5);
    match entry {
        Entry::Title(title) => svg.bold((x, y), title, &Anchor::Start, 13.0),
        Entry::Band([fill, edge], text) => {
            svg.rectangle((x, y - 5.0), [SWATCH, 10.0], *fill);
            for y in [y - 5.0, y + 5.0] {
                svg.line(&[(x, y), (x + SWATCH, y)], *edge, 1.0);
            }
            label(svg, text, x + SWATCH + LABEL_GAP);
        }
        Entry::Scale([first, last]) => {
            label(svg, first, x);
            let x = x + first.chars().count() as f64 * CHARACTER + LABEL_GAP;
            for k in 0..SCALE_STEPS {
                let from = SCALE * k as f64 / SCALE_STEPS as f64;
                // Each colour reaches to the end, under the next: edges that only meet show as
                // seams.
                let fill = colour(k as f64 / (SCALE_STEPS - 1) as f64);
                svg.rectangle((x + from, y - 4.0), [SCALE - from, 8.0], fill);
            }
            label(svg, last, x + SCALE + LABEL_GAP);
        }
        Entry::Ring(mark, text) => {
            ring(svg, *mark, (x + SWATCH / 2.0, y));
            label(svg, text, x + SWATCH + LABEL_GAP);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_wrap_within_the_width() {
        let entries =
            (0..9).map(|_| Entry::Ring(Mark::Decides, "a label of some length".into())).collect();
        let placed = flow(entries, 600.0);
        assert!(placed.iter().all(|(entry, x, _)| x + entry.width() <= 600.0));
        assert!(placed.last().is_some_and(|entry| entry.2 >= 2));
    }

    #[test]
    fn a_wide_title_ends_before_the_next_entry() {
        // Measured in DejaVu Sans at 13 px, bold.
        let title = "UR10e-load-5kg: deviation from the nominal";
        let (wide, entry) = (8.1 * title.len() as f64, Entry::Title(title.into()));
        let placed = flow(vec![entry, Entry::Ring(Mark::Decides, "tight spot".into())], 900.0);
        assert!(placed[1].2 == 0 && placed[1].1 >= LEFT + wide, "{}", placed[1].1);
    }

    #[test]
    fn an_entry_wider_than_the_figure_stands_alone() {
        let placed = flow(vec![Entry::Title("t".into()), Entry::Title("x".repeat(500))], 600.0);
        assert_eq!((placed[1].1, placed[1].2), (LEFT, 1));
    }
}
