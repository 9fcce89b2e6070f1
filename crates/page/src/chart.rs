//! One plot of dots and lines as SVG, for results other than reachable sets.

use super::canvas::{Canvas, DrawResult, svg_document};
use super::decimate::{Point, decimate};
use super::error::Error;
use super::layout::units;
use super::skeleton::own_mark;
use super::style::{BAND, GRID, INK, centred, font, tick_style};
use super::text::{Text, clean};
use maud::{PreEscaped, html};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use reachtube_scalar::number::tick_label;

/// Width of the document \[px\].
const WIDTH: f64 = 400.0;
/// Height of the document \[px\].
const HEIGHT: f64 = 230.0;
/// Room above the range of the values, as a part of it, and below.
const MARGIN: f64 = 0.05;
/// Height of the title \[px\].
const TITLE: f64 = 20.0;
/// Room left of the plot \[px\].
const LEFT: f64 = 56.0;
/// Part of the room left of the plot that holds the axis' label \[px\].
const Y_LABEL: f64 = 14.0;
/// Room below the plot \[px\].
const BELOW: f64 = 36.0;
/// Part of the room below the plot that holds the axis' label \[px\].
const X_LABEL: f64 = 16.0;
/// Room right of the plot \[px\].
const RIGHT: f64 = 10.0;
/// Radius of a dot \[px\].
const DOT: f64 = 1.6;
/// Width of a line, in drawing units.
const LINE: u32 = 10;

/// Largest number of dots drawn of a series; more would hide each other.
const MOST_DOTS: usize = 500;

/// A plot.
#[derive(Debug, Clone, Default)]
pub struct Chart {
    /// The heading above the plot.
    pub title: String,
    /// Label of the horizontal axis with its unit.
    pub x: String,
    /// Label of the vertical axis with its unit.
    pub y: String,
    /// Corners of a grey area behind the series, one after the other; none if it is empty.
    pub area: Vec<(f64, f64)>,
    /// The series, each drawn over the one before it.
    pub series: Vec<Series>,
}

/// Points of a chart.
#[derive(Debug, Clone, Default)]
pub struct Series {
    /// Points (x, y).
    pub points: Vec<(f64, f64)>,
    /// Whether to draw dots; else a line, whose points go from left to right.
    pub dots: bool,
    /// Red, green, blue.
    pub colour: [u8; 3],
}

type Axes<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Draws a chart as a complete SVG document.
///
/// # Errors
///
/// Fails for numbers that are not finite, and where the drawing library fails.
pub(crate) fn chart_svg(chart: &Chart) -> Result<String, Error> {
    chart_svg_of_height(chart, HEIGHT)
}

/// Draws a chart as [`chart_svg`] does, with a height \[px\].
///
/// # Errors
///
/// As [`chart_svg`].
pub(super) fn chart_svg_of_height(chart: &Chart, height: f64) -> Result<String, Error> {
    chart_svg_of_size(chart, [WIDTH, height])
}

/// Draws a chart as [`chart_svg`] does, with a width and a height \[px\].
///
/// # Errors
///
/// As [`chart_svg`].
pub(super) fn chart_svg_of_size(chart: &Chart, size: [f64; 2]) -> Result<String, Error> {
    check(chart)?;
    svg_document(size, &chart.title, |canvas| draw(canvas, chart, size)).map_err(|cause| {
        Error::Draw { figure: format!("chart {}", chart.title), cause: cause.to_string() }
    })
}

/// Draws charts side by side, `columns` in a row, as one complete SVG document. Readers that do not
/// see it get `label`.
///
/// # Errors
///
/// Fails for numbers that are not finite, and where the drawing library fails.
pub fn charts_svg(charts: &[Chart], columns: usize, label: &str) -> Result<String, Error> {
    let svgs: Vec<String> = charts.iter().map(chart_svg).collect::<Result<_, _>>()?;
    let (width, height) =
        (WIDTH * columns.min(charts.len()) as f64, HEIGHT * charts.len().div_ceil(columns) as f64);
    let at = |index: usize| (WIDTH * (index % columns) as f64, HEIGHT * (index / columns) as f64);
    let document = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height)
            viewBox={ "0 0 " (width) " " (height) } role="img" aria-label=(Text(label)) {
            (own_mark())
            @for (index, svg) in svgs.iter().enumerate() {
                g transform={ "translate(" (at(index).0) " " (at(index).1) ")" } {
                    (PreEscaped(svg))
                }
            }
        }
    };
    Ok(document.into_string() + "\n")
}

fn points(chart: &Chart) -> impl Iterator<Item = &Point> {
    chart.area.iter().chain(chart.series.iter().flat_map(|series| &series.points))
}

fn check(chart: &Chart) -> Result<(), Error> {
    let mut points = points(chart).enumerate();
    match points.find(|(_, (x, y))| !(x.is_finite() && y.is_finite())) {
        None => Ok(()),
        Some((index, (x, y))) => Err(Error::NotFinite {
            place: format!("chart {}", chart.title),
            what: "points".into(),
            index,
            value: if x.is_finite() { *y } else { *x },
        }),
    }
}

fn draw(canvas: &Canvas, chart: &Chart, [width, height]: [f64; 2]) -> DrawResult {
    labels(canvas, chart, [width, height])?;
    let [x, y] = [range(chart, |p| p.0), range(chart, |p| p.1)];
    let plot = canvas.clone().shrink(
        (units(Y_LABEL), units(TITLE)),
        (units(width - Y_LABEL - RIGHT), units(height - TITLE - X_LABEL)),
    );
    let mut axes = ChartBuilder::on(&plot)
        .set_label_area_size(LabelAreaPosition::Left, units(LEFT - Y_LABEL))
        .set_label_area_size(LabelAreaPosition::Bottom, units(BELOW - X_LABEL))
        .build_cartesian_2d(x[0]..x[1], y[0]..y[1])?;
    axes.configure_mesh()
        .max_light_lines(0)
        .bold_line_style(GRID.stroke_width(6))
        .axis_style(INK.stroke_width(6))
        .label_style(tick_style())
        .set_all_tick_mark_size(units(3.0))
        .x_labels(7)
        .y_labels((height / 32.0) as usize)
        .x_label_formatter(&|value| tick_label(*value, x[1] - x[0]))
        .y_label_formatter(&|value| tick_label(*value, y[1] - y[0]))
        .draw()?;
    let (column, tolerance) = ((x[1] - x[0]) / (2.0 * width), (y[1] - y[0]) / (20.0 * height));
    if !chart.area.is_empty() {
        let [fill, edge] = BAND;
        axes.draw_series([Polygon::new(chart.area.clone(), fill.filled())])?;
        let outline = chart.area.iter().chain(&chart.area[..1]).copied().collect::<Vec<_>>();
        axes.draw_series([PathElement::new(outline, edge.stroke_width(6))])?;
    }
    chart.series.iter().try_for_each(|series| match series.dots {
        true => dots(&mut axes, series),
        false => line(&mut axes, series, column, tolerance),
    })
}

/// Writes the title and the labels of the axes.
fn labels(canvas: &Canvas, chart: &Chart, [width, height]: [f64; 2]) -> DrawResult {
    let middle = units(LEFT + 0.5 * (width - LEFT - RIGHT));
    let title = centred(font(12.0, FontStyle::Bold));
    let label = font(11.0, FontStyle::Normal);
    let turned = centred(label.transform(FontTransform::Rotate270));
    canvas.draw_text(&clean(&chart.title), &title, (middle, units(10.0)))?;
    canvas.draw_text(&clean(&chart.x), &centred(label), (middle, units(height - 9.0)))?;
    let beside = (units(9.0), units(TITLE + 0.5 * (height - TITLE - BELOW)));
    canvas.draw_text(&clean(&chart.y), &turned, beside)
}

fn dots(axes: &mut Axes, series: &Series) -> DrawResult {
    let stride = series.points.len().div_ceil(MOST_DOTS).max(1);
    let colour = colour(series);
    let dot = |point: &Point| Circle::new(*point, units(DOT), colour.filled());
    axes.draw_series(series.points.iter().step_by(stride).map(dot))?;
    Ok(())
}

fn line(axes: &mut Axes, series: &Series, column: f64, tolerance: f64) -> DrawResult {
    // A single edge may be vertical, which is nothing to a line from left to right.
    let line = match series.points[..] {
        [_, _] => series.points.clone(),
        _ => decimate(&series.points, column, tolerance),
    };
    axes.draw_series([PathElement::new(line, colour(series).stroke_width(LINE))])?;
    Ok(())
}

fn colour(series: &Series) -> RGBColor {
    let [red, green, blue] = series.colour;
    RGBColor(red, green, blue)
}

/// Returns the range of a coordinate with a margin of 5 %; a width of 1 around a constant.
fn range(chart: &Chart, coordinate: fn(&Point) -> f64) -> [f64; 2] {
    let values = || points(chart).map(coordinate);
    let (low, high) =
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    // Values that differ by rounding only count as constant.
    match (low.is_finite(), high - low > 1e-9 * high.abs().max(low.abs()).max(1e-3)) {
        (true, true) => [low - MARGIN * (high - low), high + MARGIN * (high - low)],
        (true, false) => [low - 0.5, high + 0.5],
        _ => [0.0, 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use roxmltree::Document;

    #[test]
    fn dots_and_lines_are_drawn_and_texts_escaped() {
        let points: Vec<(f64, f64)> =
            (0..2000).map(|k| (0.01 * f64::from(k), (0.01 * f64::from(k)).sin())).collect();
        let chart = Chart {
            title: "a <b> & c".into(),
            x: "time [s]".into(),
            y: "torque [N m]".into(),
            area: vec![(0.0, -0.5), (20.0, -0.5), (20.0, 0.5), (0.0, 0.5)],
            series: vec![
                Series { points: points.clone(), dots: true, colour: [1, 2, 3] },
                Series { points, dots: false, colour: [9, 8, 7] },
            ],
        };
        let svg = chart_svg(&chart).unwrap();
        let document = Document::parse(&svg).unwrap();
        let tags = |name: &str| {
            document.descendants().filter(|node| node.tag_name().name() == name).count()
        };
        assert_eq!((tags("circle"), tags("b"), tags("polygon")), (500, 0, 1));
        assert_eq!(document.root_element().attribute("aria-label"), Some("a <b> & c"));
        assert!(
            svg.contains("stroke=\"#090807\"") && !svg.contains("<b>") && svg.ends_with("</svg>\n")
        );
    }

    #[test]
    fn infinite_points_are_refused_and_no_points_are_a_plot() {
        let mut chart = Chart {
            series: vec![Series { points: vec![(0.0, f64::NAN)], ..Series::default() }],
            ..Chart::default()
        };
        assert!(matches!(chart_svg(&chart), Err(Error::NotFinite { .. })));
        chart.series.clear();
        assert!(chart_svg(&chart).is_ok());
    }
}
