//! One panel of a figure: the lines of one state, and their drawing.

use super::canvas::{Canvas, DrawResult};
use super::decimate::{Point, decimate};
use super::layout::{self, Layout, Rect, units};
use super::style::{BAND, GRID, INNER, ring, tick_style};
use super::suite_figure::{Nominal, SuiteFigure, TightSpot, View};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use reachtube_scalar::number::tick_label;

/// Width of the line of a run, in drawing units.
const RUN_WIDTH: u32 = 7;
/// Width of the edge of a band, in drawing units.
const EDGE_WIDTH: u32 = 7;
/// Width of a panel per time label \[px\].
const TIME_LABEL: f64 = 28.0;
/// Largest distance of a thinned line from a sample \[px\].
const TOLERANCE: f64 = 0.25;

/// The lines of one state, ready to draw.
pub(super) struct Content {
    /// Lower and upper edge of each band, the outer one first.
    bands: Vec<[Vec<Point>; 2]>,
    runs: Vec<Vec<Point>>,
    /// The tight spots, and whether they lie outside.
    marks: Vec<(Point, bool)>,
    /// Ends of the time axis \[s\].
    time: [f64; 2],
    /// Ends of the value axis \[rad\] or \[rad/s\].
    value: [f64; 2],
}

impl Content {
    /// Returns every line and mark of one state, not thinned.
    pub(super) fn new(figure: &SuiteFigure, view: View, state: usize) -> Self {
        let nominal = match (&figure.nominal, view) {
            (Nominal::Shared(nominal), View::Deviation) => Some(nominal[state].as_slice()),
            _ => None,
        };
        let line = |times: &[f64], values: &[f64]| relative(times, values, &figure.times, nominal);
        let bands = [Some(&figure.band), figure.inner.as_ref()].into_iter().flatten();
        let bands = bands
            .map(|band| [&band.lower, &band.upper].map(|edge| line(&figure.times, &edge[state])))
            .collect();
        let runs: Vec<_> =
            figure.runs.iter().map(|run| line(&run.times, &run.states[state])).collect();
        let spots = figure.tight.iter().filter(|spot| spot.state == state);
        let marks = spots.filter_map(|spot| mark(spot, &runs[spot.run])).collect();
        Content { bands, runs, marks, time: [0.0; 2], value: [0.0; 2] }.ranged()
    }

    /// Sets the ranges of the axes: everything fits, with a margin above and below.
    fn ranged(mut self) -> Self {
        let points = || self.bands.iter().flatten().chain(&self.runs).flatten();
        let time = range(points().map(|point| point.0));
        let value = range(points().map(|point| point.1));
        let margin = 0.05 * (value[1] - value[0]).max(1e-6 * value[1].abs()).max(1e-9);
        self.time = time;
        self.value = [value[0] - margin, value[1] + margin];
        self
    }

    /// Thins the lines to what a plot of a width and height \[px\] shows.
    pub(super) fn thinned(mut self, (width, height): (f64, f64)) -> Self {
        let column = (self.time[1] - self.time[0]) / width;
        let tolerance = TOLERANCE * (self.value[1] - self.value[0]) / height;
        for line in self.bands.iter_mut().flatten().chain(&mut self.runs) {
            *line = decimate(line, column, tolerance);
        }
        self
    }
}

/// Returns the mark of a tight spot on the line of its run; none if the line is empty.
fn mark(spot: &TightSpot, line: &[Point]) -> Option<(Point, bool)> {
    (!line.is_empty()).then(|| ((spot.time_s, interpolate(line, spot.time_s)), spot.margin < 0.0))
}

/// Returns a line, minus the nominal motion if there is one. With a nominal motion, the line covers
/// only the times of `grid`, at which the nominal motion is given.
pub(super) fn relative(
    times: &[f64],
    values: &[f64],
    grid: &[f64],
    nominal: Option<&[f64]>,
) -> Vec<Point> {
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

/// Returns the value of a non-empty line at a time; beyond its ends, the value at the end.
pub(super) fn interpolate(line: &[Point], time: f64) -> f64 {
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
    let Content { time, value, .. } = content;
    let mut chart = ChartBuilder::on(&part(canvas, layout.panel(state)))
        .set_label_area_size(LabelAreaPosition::Left, units(layout::BESIDE_PLOT))
        .set_label_area_size(LabelAreaPosition::Bottom, units(layout.below_plot(state)))
        .margin_right(units(layout::AFTER_PLOT))
        .build_cartesian_2d(time[0]..time[1], value[0]..value[1])?;
    axes(&mut chart, layout, state, content)?;
    bands(&mut chart, content)?;
    let lines = content.runs.iter().zip(colours);
    chart.draw_series(
        lines.map(|(run, colour)| PathElement::new(run.clone(), colour.stroke_width(RUN_WIDTH))),
    )?;
    chart.draw_series(content.marks.iter().map(|&(point, outside)| ring(point, outside)))?;
    Ok(())
}

/// Draws the bands. The edges come after both fills, so that the edge of the outer set is visible
/// where the second set exceeds it.
fn bands(chart: &mut Chart, content: &Content) -> DrawResult {
    let styled = || content.bands.iter().zip([BAND, INNER]);
    chart.draw_series(styled().map(|(band, [colour, _])| fill(band, colour)))?;
    for (band, [_, colour]) in styled() {
        let edge =
            |line: &Vec<Point>| PathElement::new(line.clone(), colour.stroke_width(EDGE_WIDTH));
        chart.draw_series(band.iter().map(edge))?;
    }
    Ok(())
}

fn fill([lower, upper]: &[Vec<Point>; 2], colour: RGBColor) -> Polygon<Point> {
    Polygon::new(lower.iter().chain(upper.iter().rev()).copied().collect::<Vec<_>>(), colour)
}

fn part<'a>(canvas: &Canvas<'a>, at: Rect) -> Canvas<'a> {
    canvas.clone().shrink((units(at.x), units(at.y)), (units(at.width), units(at.height)))
}

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Draws the axes; the upper panel of a joint shares the time labels of the lower one.
fn axes(chart: &mut Chart, layout: &Layout, state: usize, content: &Content) -> DrawResult {
    let (time, value) = (content.time[1] - content.time[0], content.value[1] - content.value[0]);
    let time_label =
        |t: &f64| if layout.is_velocity(state) { tick_label(*t, time) } else { String::new() };
    let value_label = |x: &f64| tick_label(*x, value);
    chart
        .configure_mesh()
        .max_light_lines(0)
        .bold_line_style(GRID.stroke_width(6))
        .axis_style(BAND[1].stroke_width(8))
        .label_style(tick_style())
        .set_all_tick_mark_size(units(3.0))
        .x_labels((layout.plot().0 / TIME_LABEL) as usize)
        .y_labels(6)
        .x_label_formatter(&time_label)
        .y_label_formatter(&value_label)
        .draw()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

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
