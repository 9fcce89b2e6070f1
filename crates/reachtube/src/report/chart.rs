//! One plot of dots and lines as SVG: for results that are no reachable sets.

use super::figure::{Canvas, DrawResult};
use super::layout::units;
use super::number::tick;
use super::panel::{GRID, INK};
use super::text::{clean, escape};
use super::{ReportError, decimate};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

const WIDTH: f64 = 400.0;
const HEIGHT: f64 = 230.0;
const TITLE: f64 = 20.0;
const LEFT: f64 = 56.0;
const BELOW: f64 = 36.0;
const RIGHT: f64 = 10.0;
const DOT: f64 = 1.6;
const LINE: u32 = 10;

/// Dots that are drawn of a series; more would hide each other.
const MOST_DOTS: usize = 500;

/// A plot.
#[derive(Debug, Clone, Default)]
pub struct Chart {
    /// What is plotted, above the plot.
    pub title: String,
    /// Label of the horizontal axis with its unit.
    pub x: String,
    /// Label of the vertical axis with its unit.
    pub y: String,
    /// Drawn one on the other.
    pub series: Vec<Series>,
}

/// Points of a chart.
#[derive(Debug, Clone, Default)]
pub struct Series {
    /// Points (x, y).
    pub points: Vec<(f64, f64)>,
    /// As dots, else as a line; the points of a line go from left to right.
    pub dots: bool,
    /// Red, green, blue.
    pub colour: [u8; 3],
}

/// A chart as a complete SVG document.
///
/// # Errors
///
/// Numbers that are not finite, or what the drawing library refuses.
pub fn chart_svg(chart: &Chart) -> Result<String, ReportError> {
    let points = || chart.series.iter().flat_map(|series| &series.points);
    if let Some((index, (x, y))) =
        points().enumerate().find(|(_, (x, y))| !(x.is_finite() && y.is_finite()))
    {
        let value = if x.is_finite() { *y } else { *x };
        return Err(ReportError::NotFinite {
            place: chart.title.clone(),
            what: "points".into(),
            index,
            value,
        });
    }
    let size = (units(WIDTH) as u32, units(HEIGHT) as u32);
    let mut drawing = String::new();
    let canvas = SVGBackend::with_string(&mut drawing, size).into_drawing_area();
    draw(&canvas, chart).map_err(|cause| ReportError::Draw {
        suite: chart.title.clone(),
        cause: cause.to_string(),
    })?;
    drop(canvas);
    let body = drawing.split_once('>').map_or("", |(_, body)| body);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {} {}\" \
         stroke-linejoin=\"round\" role=\"img\" aria-label=\"{}\">{body}",
        size.0,
        size.1,
        escape(&chart.title)
    ))
}

fn draw(canvas: &Canvas, chart: &Chart) -> DrawResult {
    canvas.fill(&WHITE)?;
    let [x, y] = [range(chart, |p| p.0), range(chart, |p| p.1)];
    let font = |size: f64| ("sans-serif", f64::from(units(size)) * 1.24).into_font();
    let style = |font: FontDesc<'static>| {
        TextStyle::from(font).color(&INK).pos(Pos::new(HPos::Center, VPos::Center))
    };
    let middle = units(LEFT + 0.5 * (WIDTH - LEFT - RIGHT));
    canvas.draw_text(
        &clean(&chart.title),
        &style(font(12.0).style(FontStyle::Bold)),
        (middle, units(10.0)),
    )?;
    canvas.draw_text(&clean(&chart.x), &style(font(11.0)), (middle, units(HEIGHT - 9.0)))?;
    let turned = style(font(11.0).transform(FontTransform::Rotate270));
    canvas.draw_text(
        &clean(&chart.y),
        &turned,
        (units(9.0), units(TITLE + 0.5 * (HEIGHT - TITLE - BELOW))),
    )?;
    let plot = canvas.clone().shrink(
        (units(14.0), units(TITLE)),
        (units(WIDTH - 14.0 - RIGHT), units(HEIGHT - TITLE - 16.0)),
    );
    let mut axes = ChartBuilder::on(&plot)
        .set_label_area_size(LabelAreaPosition::Left, units(LEFT - 14.0))
        .set_label_area_size(LabelAreaPosition::Bottom, units(BELOW - 16.0))
        .build_cartesian_2d(x[0]..x[1], y[0]..y[1])?;
    axes.configure_mesh()
        .max_light_lines(0)
        .bold_line_style(GRID.stroke_width(6))
        .axis_style(INK.stroke_width(6))
        .label_style(("sans-serif", f64::from(units(10.5)) * 1.24, &INK))
        .set_all_tick_mark_size(units(3.0))
        .x_labels(7)
        .y_labels(6)
        .x_label_formatter(&|value| tick(*value, x[1] - x[0]))
        .y_label_formatter(&|value| tick(*value, y[1] - y[0]))
        .draw()?;
    for series in &chart.series {
        let [red, green, blue] = series.colour;
        let colour = RGBColor(red, green, blue);
        if series.dots {
            let stride = series.points.len().div_ceil(MOST_DOTS).max(1);
            let dot = |point: &(f64, f64)| Circle::new(*point, units(DOT), colour.filled());
            axes.draw_series(series.points.iter().step_by(stride).map(dot))?;
        } else {
            let (column, tolerance) =
                ((x[1] - x[0]) / (2.0 * WIDTH), (y[1] - y[0]) / (20.0 * HEIGHT));
            let line = decimate::decimate(&series.points, column, tolerance);
            axes.draw_series([PathElement::new(line, colour.stroke_width(LINE))])?;
        }
    }
    canvas.present()
}

/// The range of a coordinate with some room; 1 about what does not vary.
fn range(chart: &Chart, of: fn(&(f64, f64)) -> f64) -> [f64; 2] {
    let values = || chart.series.iter().flat_map(|series| series.points.iter().map(of));
    let (low, high) =
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    // What differs by rounding only does not vary.
    match (low.is_finite(), high - low > 1e-9 * high.abs().max(low.abs()).max(1e-3)) {
        (true, true) => [low - 0.05 * (high - low), high + 0.05 * (high - low)],
        (true, false) => [low - 0.5, high + 0.5],
        _ => [0.0, 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_and_lines_are_drawn_and_texts_escaped() {
        let points: Vec<(f64, f64)> =
            (0..2000).map(|k| (0.01 * f64::from(k), (0.01 * f64::from(k)).sin())).collect();
        let chart = Chart {
            title: "a <b> & c".into(),
            x: "time [s]".into(),
            y: "torque [N m]".into(),
            series: vec![
                Series { points: points.clone(), dots: true, colour: [1, 2, 3] },
                Series { points, dots: false, colour: [9, 8, 7] },
            ],
        };
        let svg = chart_svg(&chart).unwrap();
        assert_eq!(svg.matches("<circle").count(), 500);
        assert!(
            svg.contains("stroke=\"#090807\"") && !svg.contains("<b>") && svg.ends_with("</svg>\n")
        );
    }

    #[test]
    fn what_cannot_be_drawn_is_refused_and_nothing_is_a_plot() {
        let mut chart = Chart {
            series: vec![Series { points: vec![(0.0, f64::NAN)], ..Series::default() }],
            ..Chart::default()
        };
        assert!(matches!(chart_svg(&chart), Err(ReportError::NotFinite { .. })));
        chart.series.clear();
        assert!(chart_svg(&chart).is_ok());
    }
}
