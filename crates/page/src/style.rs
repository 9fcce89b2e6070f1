//! Colours, fonts and marks that all figures share.

use super::layout::units;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Fill and edge of the reachable set.
pub(super) const BAND: [RGBColor; 2] = [RGBColor(226, 230, 235), RGBColor(140, 149, 159)];
/// Fill and edge of the second reachable set.
pub(super) const INNER: [RGBColor; 2] = [RGBColor(180, 188, 197), RGBColor(99, 108, 118)];
/// Text and axes.
pub(super) const INK: RGBColor = RGBColor(31, 35, 40);
/// Lines at the ticks.
pub(super) const GRID: RGBColor = RGBColor(238, 240, 243);

/// Rings of tight spots, and of samples outside the set.
const RINGS: [RGBColor; 2] = [INK, RGBColor(207, 19, 34)];

/// Height of a line of text over the font size that the drawing library takes.
const FONT_SCALE: f64 = 1.24;

/// Returns the figures' font at a size \[px\].
pub(super) fn font(size: f64, style: FontStyle) -> FontDesc<'static> {
    FontDesc::new(FontFamily::SansSerif, f64::from(units(size)) * FONT_SCALE, style)
}

pub(super) fn centred(font: FontDesc<'static>) -> TextStyle<'static> {
    TextStyle::from(font).color(&INK).pos(Pos::new(HPos::Center, VPos::Center))
}

pub(super) fn starting(font: FontDesc<'static>) -> TextStyle<'static> {
    TextStyle::from(font).color(&INK).pos(Pos::new(HPos::Left, VPos::Center))
}

/// Returns font, size and colour of the labels at ticks.
pub(super) fn tick_style() -> (&'static str, f64, &'static RGBColor) {
    ("sans-serif", f64::from(units(10.5)) * FONT_SCALE, &INK)
}

/// Returns the mark of a tight spot; it is larger and red where the sample lies outside.
pub(super) fn ring<Coord>(point: Coord, outside: bool) -> Circle<Coord, i32> {
    let (radius, width) = if outside { (6.0, 16) } else { (4.0, 10) };
    Circle::new(point, units(radius), RINGS[usize::from(outside)].stroke_width(width))
}
