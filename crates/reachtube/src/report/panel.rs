//! One panel: what of a suite it shows, and the drawing of it.

use super::decimate::{Point, decimate};
use super::figure::{Canvas, DrawResult};
use super::layout::{self, Layout, Rect, units};
use super::number::tick;
use super::{Nominal, Side, SuiteFigure, TightSpot, View};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// Fill and edge of the reachable set.
pub(super) const BAND: [RGBColor; 2] = [RGBColor(226, 230, 235), RGBColor(140, 149, 159)];
/// Fill and edge of the second reachable set.
pub(super) const INNER: [RGBColor; 2] = [RGBColor(180, 188, 197), RGBColor(99, 108, 118)];
/// Text and axes.
pub(super) const INK: RGBColor = RGBColor(31, 35, 40);
/// Rings of tight spots, and of samples outside the set.
pub(super) const RINGS: [RGBColor; 2] = [INK, RGBColor(207, 19, 34)];

pub(super) const GRID: RGBColor = RGBColor(238, 240, 243);
const RUN_WIDTH: u32 = 7;
const EDGE_WIDTH: u32 = 7;
/// How far a thinned line may pass from a sample \[px\].
const TOLERANCE: f64 = 0.1;

/// The lines of one state, ready to draw.
pub(super) struct Content {
    /// Lower and upper edge of each band, the outer one first.
    bands: Vec<[Vec<Point>; 2]>,
    runs: Vec<Vec<Point>>,
    /// The tight spots, and whether they lie outside.
    marks: Vec<(Point, bool)>,
    time: [f64; 2],
    value: [f64; 2],
}

impl Content {
    /// Everything of one state, in full.
    pub(super) fn new(figure: &SuiteFigure, view: View, state: usize) -> Self {
        let nominal = match (&figure.nominal, view) {
            (Nominal::Shared(nominal), View::Deviation) => Some(nominal[state].as_slice()),
            _ => None,
        };
        let line = |times: &[f64], values: &[f64]| relative(times, values, &figure.times, nominal);
        let bands = [Some(&figure.band), figure.inner.as_ref()].into_iter().flatten();
        let bands = bands
            .map(|band| [&band.lower, &band.upper].map(|edge| line(&figure.times, &edge[state])));
        let runs: Vec<_> =
            figure.runs.iter().map(|run| line(&run.times, &run.states[state])).collect();
        let n = figure.joints.len();
        let shown = |spot: &&TightSpot| {
            spot.state == state || (spot.side == Side::Plane && spot.state % n == state % n)
        };
        let marks = figure.tight.iter().filter(shown);
        let marks = marks.filter_map(|spot| {
            let line = &runs[spot.run];
            (!line.is_empty())
                .then(|| ((spot.time_s, interpolate(line, spot.time_s)), spot.margin < 0.0))
        });
        let marks = marks.collect();
        Content { bands: bands.collect(), runs, marks, time: [0.0; 2], value: [0.0; 2] }.ranged()
    }

    /// The ranges of the axes: everything fits, with a little air above and below.
    fn ranged(mut self) -> Self {
        let points = || self.bands.iter().flatten().chain(&self.runs).flatten();
        let time = range(points().map(|point| point.0));
        let value = range(points().map(|point| point.1));
        let air = 0.05 * (value[1] - value[0]).max(1e-6 * value[1].abs()).max(1e-9);
        self.time = time;
        self.value = [value[0] - air, value[1] + air];
        self
    }

    /// The same thinned to what a plot of this size \[px\] shows.
    pub(super) fn thinned(mut self, (width, height): (f64, f64)) -> Self {
        let column = (self.time[1] - self.time[0]) / width;
        let tolerance = TOLERANCE * (self.value[1] - self.value[0]) / height;
        for line in self.bands.iter_mut().flatten().chain(&mut self.runs) {
            *line = decimate(line, column, tolerance);
        }
        self
    }
}

/// A line, minus the nominal where there is one; then only over the nominal's times.
fn relative(times: &[f64], values: &[f64], grid: &[f64], nominal: Option<&[f64]>) -> Vec<Point> {
    let points = times.iter().copied().zip(values.iter().copied());
    let Some(nominal) = nominal else {
        return points.collect();
    };
    let nominal: Vec<Point> = grid.iter().copied().zip(nominal.iter().copied()).collect();
    let known = grid[0]..=grid[grid.len() - 1];
    points
        .filter(|(t, _)| known.contains(t))
        .map(|(t, x)| (t, x - interpolate(&nominal, t)))
        .collect()
}

/// The value of a line (not empty) at a time; beyond its ends, that of the end.
fn interpolate(line: &[Point], time: f64) -> f64 {
    let after = line.partition_point(|point| point.0 < time);
    if after == 0 || after == line.len() {
        return line[after.min(line.len() - 1)].1;
    }
    let (a, b) = (line[after - 1], line[after]);
    if time == b.0 { b.1 } else { a.1 + (b.1 - a.1) * ((time - a.0) / (b.0 - a.0)) }
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

/// Draws the panel of a state, runs in the given colours.
pub(super) fn draw(
    canvas: &Canvas,
    layout: &Layout,
    state: usize,
    content: &Content,
    colours: &[RGBColor],
) -> DrawResult {
    let mut chart = ChartBuilder::on(&place(canvas, layout.panel(state)))
        .set_label_area_size(LabelAreaPosition::Left, units(layout::BESIDE_PLOT))
        .set_label_area_size(LabelAreaPosition::Bottom, units(layout.below_plot(state)))
        .margin_right(units(layout::AFTER_PLOT))
        .build_cartesian_2d(content.time[0]..content.time[1], content.value[0]..content.value[1])?;
    axes(&mut chart, layout, state, content)?;
    chart.draw_series(
        content.bands.iter().zip([BAND, INNER]).map(|(band, style)| fill(band, style[0])),
    )?;
    for (band, style) in content.bands.iter().zip([BAND, INNER]) {
        // After both fills, so that the edge of the outer set is seen where the second one exceeds
        // it.
        let edge =
            |line: &Vec<Point>| PathElement::new(line.clone(), style[1].stroke_width(EDGE_WIDTH));
        chart.draw_series(band.iter().map(edge))?;
    }
    let lines = content.runs.iter().zip(colours);
    chart.draw_series(
        lines.map(|(run, colour)| PathElement::new(run.clone(), colour.stroke_width(RUN_WIDTH))),
    )?;
    chart.draw_series(content.marks.iter().map(|&(point, outside)| ring(point, outside)))?;
    Ok(())
}

fn fill([lower, upper]: &[Vec<Point>; 2], colour: RGBColor) -> Polygon<Point> {
    Polygon::new(lower.iter().chain(upper.iter().rev()).copied().collect::<Vec<_>>(), colour)
}

/// The mark of a tight spot; larger and red where it lies outside.
pub(super) fn ring<Coord>(point: Coord, outside: bool) -> Circle<Coord, i32> {
    let (radius, width) = if outside { (6.0, 16) } else { (4.0, 10) };
    Circle::new(point, units(radius), RINGS[usize::from(outside)].stroke_width(width))
}

fn place<'a>(canvas: &Canvas<'a>, at: Rect) -> Canvas<'a> {
    canvas.clone().shrink((units(at.x), units(at.y)), (units(at.width), units(at.height)))
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

fn axes(chart: &mut Chart, layout: &Layout, state: usize, content: &Content) -> DrawResult {
    let (time, value) = (content.time[1] - content.time[0], content.value[1] - content.value[0]);
    let time_labels = (layout.plot().0 / 28.0) as usize;
    let time_label =
        |t: &f64| if layout.is_velocity(state) { tick(*t, time) } else { String::new() };
    let value_label = |x: &f64| tick(*x, value);
    let mut mesh = chart.configure_mesh();
    mesh.max_light_lines(0)
        .bold_line_style(GRID.stroke_width(6))
        .axis_style(BAND[1].stroke_width(8))
        .label_style(("sans-serif", units(10.5) as f64 * 1.24, &INK))
        .set_all_tick_mark_size(units(3.0))
        .x_labels(time_labels)
        .y_labels(6)
        .x_label_formatter(&time_label)
        .y_label_formatter(&value_label);
    mesh.draw()
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn the_deviation_of_the_nominal_is_zero() {
        let mut figure = sample::suite("S", 2);
        let Nominal::Shared(nominal) = figure.nominal.clone() else {
            panic!("the sample has a nominal")
        };
        figure.runs[0].times = figure.times.clone();
        figure.runs[0].states = nominal;
        let content = Content::new(&figure, View::Deviation, 3);
        assert!(content.runs[0].iter().all(|point| point.1 == 0.0));
    }

    #[test]
    fn a_run_on_its_own_times_is_measured_against_the_interpolated_nominal() {
        let line =
            relative(&[-1.0, 0.5, 1.0, 9.0], &[0.0, 7.0, 9.0, 0.0], &[0.0, 1.0], Some(&[2.0, 4.0]));
        assert_eq!(line, [(0.5, 4.0), (1.0, 5.0)]);
    }

    #[test]
    fn everything_lies_within_the_axes() {
        let figure = sample::suite("S", 2);
        for (view, state) in [(View::Motion, 0), (View::Deviation, 3)] {
            let content = Content::new(&figure, view, state).thinned((150.0, 150.0));
            let [low, high] = content.value;
            let mut points = content.bands.iter().flatten().chain(&content.runs).flatten();
            assert!(points.all(|point| low < point.1 && point.1 < high));
        }
    }

    #[test]
    fn marks_sit_on_their_run() {
        let figure = sample::suite("S", 2);
        let spot = figure.tight[0];
        let content = Content::new(&figure, View::Motion, spot.state);
        let (point, outside) = content.marks[0];
        assert_eq!(point.1, interpolate(&content.runs[spot.run], spot.time_s));
        assert_eq!(outside, spot.margin < 0.0);
    }
}
