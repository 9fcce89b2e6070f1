//! The drawing area of a figure, and the SVG document made of it.

use super::layout::units;
use super::skeleton::own_mark;
use super::text::Text;
use maud::{PreEscaped, html};
use plotters::coord::Shift;
use plotters::prelude::*;
use std::io;

/// A drawing area, in drawing units.
pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// The failure of a drawing call.
pub(super) type DrawFailure = DrawingAreaErrorKind<io::Error>;
/// The outcome of a drawing call.
pub(super) type DrawResult = Result<(), DrawFailure>;

/// Draws on a white canvas of a width and height \[px\] and returns the complete SVG document.
/// Readers that do not see it get `label`.
pub(super) fn svg_document(
    [width, height]: [f64; 2],
    label: &str,
    draw: impl FnOnce(&Canvas) -> DrawResult,
) -> Result<String, DrawFailure> {
    let size = (units(width) as u32, units(height) as u32);
    let mut drawing = String::new();
    let canvas = SVGBackend::with_string(&mut drawing, size).into_drawing_area();
    canvas.fill(&WHITE)?;
    draw(&canvas)?;
    canvas.present()?;
    drop(canvas);
    let view_box = format!("0 0 {} {}", size.0, size.1);
    // The library's own head has neither a size in pixels nor a label.
    let document = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height) viewBox=(view_box)
            stroke-linejoin="round" role="img" aria-label=(Text(label)) {
            (own_mark())
            (PreEscaped(without_root(&drawing)))
        }
    };
    Ok(document.into_string() + "\n")
}

/// Returns what stands between the first tag of a drawing and its last.
fn without_root(drawing: &str) -> &str {
    let body = drawing.split_once('>').map_or("", |(_, body)| body);
    body.rsplit_once("</svg>").map_or(body, |(body, _)| body)
}
