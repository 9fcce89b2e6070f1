//! The legend of a figure: what the bands, the colours and the rings mean, in lines that fit the
//! figure's width.

use super::colour::{Heat, colour};
use super::figure::{Canvas, DrawResult};
use super::layout::{LEGEND_ROW, units};
use super::panel::{BAND, INK, INNER, ring};
use super::text::clean;
use super::{SuiteFigure, View};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const LEFT: f64 = 20.0;
const GAP: f64 = 22.0;
const SWATCH: f64 = 22.0;
const SCALE: f64 = 120.0;
const SCALE_STEPS: usize = 40;
/// Mean width of a character of the legend's font \[px\]; the page's font is not known here.
const CHARACTER: f64 = 6.0;

/// One entry.
enum Entry {
    Title(String),
    Band([RGBColor; 2], String),
    Scale([String; 2]),
    Ring(bool, String),
}

impl Entry {
    fn width(&self) -> f64 {
        let text = |text: &str| text.chars().count() as f64 * CHARACTER;
        match self {
            Entry::Title(title) => 1.25 * text(title),
            Entry::Band(_, label) | Entry::Ring(_, label) => SWATCH + 6.0 + text(label),
            Entry::Scale(ends) => SCALE + 12.0 + ends.iter().map(|end| text(end)).sum::<f64>(),
        }
    }
}

/// The entries of a figure and their places.
pub(super) struct Legend {
    entries: Vec<(Entry, f64, usize)>,
}

impl Legend {
    /// The legend of a suite for a figure so wide \[px\].
    pub(super) fn new(figure: &SuiteFigure, view: View, heat: &Heat, width: f64) -> Self {
        let mut entries = vec![Entry::Title(title(figure, view)), band(BAND, &figure.band.label)];
        entries.extend(figure.inner.iter().map(|inner| band(INNER, &inner.label)));
        if !figure.runs.is_empty() {
            entries.push(Entry::Scale(heat.ends.clone()));
        }
        let outside = figure.tight.iter().filter(|spot| spot.margin < 0.0).count();
        if outside < figure.tight.len() {
            entries.push(Entry::Ring(false, "tight spot".into()));
        }
        if outside > 0 {
            entries.push(Entry::Ring(true, "outside the set".into()));
        }
        Legend { entries: flow(entries, width) }
    }

    /// How many lines it takes.
    pub(super) fn rows(&self) -> usize {
        self.entries.last().map_or(0, |entry| entry.2 + 1)
    }

    /// Draws it at the top of the figure.
    pub(super) fn draw(&self, canvas: &Canvas) -> DrawResult {
        self.entries.iter().try_for_each(|(entry, x, row)| {
            draw_entry(canvas, entry, *x, 6.0 + LEGEND_ROW * (*row as f64 + 0.5))
        })
    }
}

fn title(figure: &SuiteFigure, view: View) -> String {
    let what = match view {
        View::Motion => "motion",
        View::Deviation => "deviation from the nominal",
    };
    format!("{}: {what}", clean(&figure.suite))
}

fn band(colours: [RGBColor; 2], label: &str) -> Entry {
    Entry::Band(colours, if label.is_empty() { "reachable set".into() } else { clean(label) })
}

/// Entries from left to right, on a new line where the next one does not fit.
fn flow(entries: Vec<Entry>, width: f64) -> Vec<(Entry, f64, usize)> {
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

fn draw_entry(canvas: &Canvas, entry: &Entry, x: f64, y: f64) -> DrawResult {
    match entry {
        Entry::Title(title) => write(canvas, title, x, y, true),
        Entry::Band(colours, label) => {
            let corners = [(units(x), units(y - 5.0)), (units(x + SWATCH), units(y + 5.0))];
            canvas.draw(&Rectangle::new(corners, colours[0].filled()))?;
            for (_, edge) in corners {
                let path = vec![(corners[0].0, edge), (corners[1].0, edge)];
                canvas.draw(&PathElement::new(path, colours[1].stroke_width(8)))?;
            }
            write(canvas, label, x + SWATCH + 6.0, y, false)
        }
        Entry::Scale(ends) => draw_scale(canvas, ends, x, y),
        Entry::Ring(outside, label) => {
            canvas.draw(&ring((units(x + SWATCH / 2.0), units(y)), *outside))?;
            write(canvas, label, x + SWATCH + 6.0, y, false)
        }
    }
}

fn draw_scale(canvas: &Canvas, ends: &[String; 2], x: f64, y: f64) -> DrawResult {
    write(canvas, &ends[0], x, y, false)?;
    let x = x + ends[0].chars().count() as f64 * CHARACTER + 6.0;
    let step = SCALE / SCALE_STEPS as f64;
    for k in 0..SCALE_STEPS {
        let from = x + step * k as f64;
        // Each to the end, under the next: edges that only meet would show as seams.
        let corners = [(units(from), units(y - 4.0)), (units(x + SCALE), units(y + 4.0))];
        canvas
            .draw(&Rectangle::new(corners, colour(k as f64 / (SCALE_STEPS - 1) as f64).filled()))?;
    }
    write(canvas, &ends[1], x + SCALE + 6.0, y, false)
}

fn write(canvas: &Canvas, text: &str, x: f64, y: f64, title: bool) -> DrawResult {
    let (size, style) = if title { (13.0, FontStyle::Bold) } else { (11.5, FontStyle::Normal) };
    let font = FontDesc::new(FontFamily::SansSerif, f64::from(units(size)) * 1.24, style);
    let style = TextStyle::from(font).color(&INK).pos(Pos::new(HPos::Left, VPos::Center));
    canvas.draw_text(text, &style, (units(x), units(y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_wrap_within_the_width() {
        let entries = (0..9).map(|_| Entry::Ring(false, "a label of some length".into())).collect();
        let placed = flow(entries, 600.0);
        assert!(placed.iter().all(|(entry, x, _)| x + entry.width() <= 600.0));
        assert!(placed.last().is_some_and(|entry| entry.2 >= 2));
    }

    #[test]
    fn an_entry_wider_than_the_figure_stands_alone() {
        let placed = flow(vec![Entry::Title("t".into()), Entry::Title("x".repeat(500))], 600.0);
        assert_eq!((placed[1].1, placed[1].2), (LEFT, 1));
    }
}
