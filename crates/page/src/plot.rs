//! The drawing of charts between their axes, as SVG.

use super::chart::{Chart, Mark, Series};
use super::decimate::{Point, decimate};
use super::error::Error;
use super::layout::Rect;
use super::svg::{Anchor, Colour, GREY, GRID, INK, Place, RED, Svg};
use reachtube_scalar::number::tick_label;

/// Fill and edge of each area of a chart.
pub(super) const BANDS: [[Colour; 2]; 2] =
    [[[226, 230, 235], GREY], [[180, 188, 197], [99, 108, 118]]];
/// Part of the range of the values that is free beyond its ends.
const MARGIN: f64 = 0.05;
/// Largest distance of a thinned line from a sample \[px\].
const TOLERANCE: f64 = 0.25;
/// Height of a plot per number on its vertical axis \[px\].
const VALUE: f64 = 30.0;
/// Length of the mark of a tick \[px\].
const TICK: f64 = 3.0;
/// Largest number of dots drawn of a series; more would hide each other.
const MOST_DOTS: usize = 500;

/// Width and height of a chart \[px\].
pub(super) const CHART: [f64; 2] = [400.0, 230.0];
/// Room above, to the right of and below the plot of a chart \[px\].
const ROOM: [f64; 3] = [20.0, 10.0, 36.0];
/// Room to the left of it: for numbers, and for names \[px\].
const LEFT: [f64; 2] = [56.0, 190.0];

/// Draws a chart as a complete SVG document.
///
/// # Errors
///
/// Fails for numbers that are not finite.
pub(super) fn chart_svg(chart: &Chart) -> Result<String, Error> {
    chart_svg_of_size(chart, CHART)
}

/// Draws a chart as [`chart_svg`] does, with a width and a height \[px\].
pub(super) fn chart_svg_of_size(chart: &Chart, size: [f64; 2]) -> Result<String, Error> {
    grid_svg(std::slice::from_ref(chart), 1, size, &chart.title)
}

/// Draws charts side by side, `columns` in a row, as one complete SVG document. Readers that do not
/// see it get `label`.
///
/// # Errors
///
/// Fails for numbers that are not finite.
pub fn charts_svg(charts: &[Chart], columns: usize, label: &str) -> Result<String, Error> {
    grid_svg(charts, columns, CHART, label)
}

fn grid_svg(
    charts: &[Chart],
    columns: usize,
    [width, height]: [f64; 2],
    label: &str,
) -> Result<String, Error> {
    let (mut svg, [above, right, below]) = (Svg::default(), ROOM);
    for (index, chart) in charts.iter().enumerate() {
        check(chart)?;
        let left = LEFT[usize::from(!chart.rows.is_empty())];
        let plot = Rect {
            x: width * (index % columns) as f64 + left,
            y: height * (index / columns) as f64 + above,
            width: width - left - right,
            height: height - above - below,
        };
        let pen = if chart.rows.is_empty() { [1.25, 1.6] } else { [1.75, 3.0] };
        let (beside, margin, tick) = (left - 9.0, MARGIN, 45.0);
        let frame = Frame { plot, beside, margin, tick, has_numbers: true, pen };
        draw(&mut svg, chart, &frame);
    }
    let rows = charts.len().div_ceil(columns);
    let size = [width * columns.min(charts.len()) as f64, height * rows as f64];
    Ok(svg.document(size, label))
}

fn check(chart: &Chart) -> Result<(), Error> {
    let mut points = chart.points().enumerate();
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

/// Where a chart is drawn, and how.
pub(super) struct Frame {
    /// The plot between the axes; labels stand around it.
    pub(super) plot: Rect,
    /// Distance of the vertical axis' label \[px\].
    pub(super) beside: f64,
    /// Part of the range that is free beyond the ends of the horizontal axis.
    pub(super) margin: f64,
    /// Width of the plot per tick of the horizontal axis \[px\].
    pub(super) tick: f64,
    /// Whether the ticks of the horizontal axis have numbers.
    pub(super) has_numbers: bool,
    /// Width of a line and radius of a dot \[px\].
    pub(super) pen: [f64; 2],
}

/// Maps a range of values to pixels.
struct Axis {
    range: [f64; 2],
    pixels: [f64; 2],
}

impl Axis {
    fn at(&self, value: f64) -> f64 {
        let [[low, high], [from, to]] = [self.range, self.pixels];
        from + (to - from) * ((value - low) / (high - low))
    }

    fn span(&self) -> f64 {
        self.range[1] - self.range[0]
    }

    /// Returns the multiples of 1, 2 or 5 times a power of ten in the range, at most `most`.
    fn ticks(&self, most: f64) -> Vec<f64> {
        let power = 10f64.powf((self.span() / (most + 1.0)).log10().floor());
        let ends = |step: f64| ((self.range[0] / step).ceil(), (self.range[1] / step).floor());
        let count = |step: f64| ends(step).1 - ends(step).0 + 1.0;
        let steps = [1.0, 2.0, 5.0, 10.0, 20.0].map(|part| part * power);
        let Some(step) = steps.into_iter().find(|step| count(*step) <= most) else {
            return Vec::new();
        };
        (0..count(step) as usize).map(|k| (ends(step).0 + k as f64) * step).collect()
    }
}

pub(super) fn draw(svg: &mut Svg, chart: &Chart, frame: &Frame) {
    let Rect { x, y, width, height } = frame.plot;
    let [across, up] = [
        Axis { range: range(chart, frame.margin, |p| p.0), pixels: [x, x + width] },
        Axis { range: range(chart, MARGIN, |p| p.1), pixels: [y + height, y] },
    ];
    axes(svg, chart, frame, [&across, &up]);
    let place = |point: &Point| -> Place { (across.at(point.0), up.at(point.1)) };
    let line = |points: &[Point]| -> Vec<Place> {
        // Only a line from left to right can be thinned.
        let is_line = points.windows(2).all(|pair| pair[0].0 < pair[1].0);
        let (column, tolerance) = (across.span() / width, TOLERANCE * up.span() / height);
        match is_line {
            true => decimate(points, column, tolerance).iter().map(place).collect(),
            false => points.iter().map(place).collect(),
        }
    };
    let edges: Vec<_> =
        chart.areas.iter().map(|area| [line(&area.lower), line(&area.upper)]).collect();
    for ([lower, upper], [fill, _]) in edges.iter().zip(BANDS) {
        let back = upper.iter().rev();
        svg.polygon(&lower.iter().chain(back).copied().collect::<Vec<_>>(), fill);
    }
    // The edges come after all fills, so that the outer one shows where the inner area exceeds it.
    for (edges, [_, edge]) in edges.iter().zip(BANDS) {
        edges.iter().for_each(|line| svg.line(line, edge, frame.pen[0].min(0.9)));
    }
    for Series { points, mark, colour } in &chart.series {
        let stride = points.len().div_ceil(MOST_DOTS).max(1);
        let places = || points.iter().map(place);
        match mark {
            Mark::Line => svg.line(&line(points), *colour, frame.pen[0]),
            Mark::Dots => {
                places().step_by(stride).for_each(|at| svg.dot(at, frame.pen[1], *colour));
            }
            Mark::Decides | Mark::Outside => places().for_each(|at| ring(svg, *mark, at)),
        }
    }
}

pub(super) fn ring(svg: &mut Svg, mark: Mark, at: Place) {
    match mark {
        Mark::Outside => svg.ring(at, 6.0, RED, 2.0),
        _ => svg.ring(at, 4.0, INK, 1.25),
    }
}

/// Draws the axes with their ticks, and all labels.
fn axes(svg: &mut Svg, chart: &Chart, frame: &Frame, [across, up]: [&Axis; 2]) {
    let Rect { x, y, width, height } = frame.plot;
    let (right, bottom) = (x + width, y + height);
    for value in across.ticks((width / frame.tick).floor()) {
        let at = across.at(value);
        svg.line(&[(at, y), (at, bottom)], GRID, 0.75);
        svg.line(&[(at, bottom), (at, bottom + TICK)], GREY, 1.0);
        if frame.has_numbers {
            let number = tick_label(value, across.span());
            svg.text((at, bottom + 10.0), &number, &Anchor::Middle, 10.5);
        }
    }
    let rows = chart.rows.iter().zip(1..);
    let rows: Vec<(f64, String)> =
        rows.map(|(name, row)| (0.5 - f64::from(row), name.clone())).collect();
    let numbers = up.ticks((height / VALUE).floor()).into_iter();
    let numbers = || numbers.clone().map(|value| (value, tick_label(value, up.span()))).collect();
    let values: Vec<(f64, String)> = if rows.is_empty() { numbers() } else { rows };
    for (value, text) in values {
        let at = up.at(value);
        if chart.rows.is_empty() {
            svg.line(&[(x, at), (right, at)], GRID, 0.75);
            svg.line(&[(x - TICK, at), (x, at)], GREY, 1.0);
        }
        svg.text((x - 6.0, at), &text, &Anchor::End, 10.5);
    }
    svg.line(&[(x, y), (x, bottom), (right, bottom)], GREY, 1.0);
    let (middle, half) = (x + 0.5 * width, y + 0.5 * height);
    svg.bold((middle, y - 11.0), &chart.title, &Anchor::Middle, 12.0);
    svg.text((middle, bottom + 27.0), &chart.x, &Anchor::Middle, 11.0);
    svg.text((x - frame.beside, half), &chart.y, &Anchor::Turned, 11.0);
}

/// Returns the range of a coordinate with a margin; a width of 1 around a constant.
fn range(chart: &Chart, margin: f64, coordinate: fn(&Point) -> f64) -> [f64; 2] {
    let [low, high] = chart
        .points()
        .map(coordinate)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(value), high.max(value)]
        });
    // Values that differ by rounding only count as constant.
    match (low.is_finite(), high - low > 1e-9 * high.abs().max(low.abs()).max(1e-3)) {
        (true, true) => [low - margin * (high - low), high + margin * (high - low)],
        (true, false) => [low - 0.5, high + 0.5],
        _ => [0.0, 1.0],
    }
}

#[cfg(test)]
mod tests {
    use super::super::chart::Area;
    use super::*;
    use roxmltree::Document;

    #[test]
    fn dots_and_lines_are_drawn_and_texts_escaped() {
        let points: Vec<(f64, f64)> =
            (0..2000).map(|k| (0.01 * f64::from(k), (0.01 * f64::from(k)).sin())).collect();
        let edge = |y: f64| vec![(0.0, y), (20.0, y)];
        let chart = Chart {
            title: "a <b> & c".into(),
            x: "time [s]".into(),
            y: "torque [N m]".into(),
            areas: vec![Area { lower: edge(-0.5), upper: edge(0.5) }],
            series: vec![Series::dots(points.clone(), [1, 2, 3]), Series::line(points, [9, 8, 7])],
            rows: Vec::new(),
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

    #[test]
    fn ticks_are_round_numbers_in_the_range() {
        let ticks = |range, most| Axis { range, pixels: [0.0, 1.0] }.ticks(most);
        assert_eq!(ticks([-0.1, 2.1], 5.0), [0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(ticks([-0.1, 2.1], 3.0), [0.0, 1.0, 2.0]);
        assert_eq!(ticks([31.0, 82.0], 6.0), [40.0, 50.0, 60.0, 70.0, 80.0]);
        for most in 2..12 {
            for high in [1e-4, 0.3, 1.0, 7.7, 123.0] {
                let count = ticks([-0.37 * high, high], f64::from(most)).len();
                assert!(count <= most as usize && 3 * count >= most as usize, "{most} {high}");
            }
        }
    }
}
