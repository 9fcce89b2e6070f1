//! The contents of a figure: one test suite with its reachable set, its runs, and its tight spots.

use super::chart::{Area, Chart, Mark, Series};
use super::decimate::Point;
use reachtube_conform::data::Side;
use reachtube_robot::JointKind;

/// One test suite: the reachable set, its runs, and the samples that touch the set.
///
/// States are ordered q1..qn \[rad; m for prismatic joints\], then q̇1..q̇n \[rad/s; m/s\]; a table
/// of states has the shape `[2n][times]`.
#[derive(Debug, Clone, Default)]
pub struct SuiteFigure {
    /// The suite's name.
    pub suite: String,
    /// Names of the n joints.
    pub joints: Vec<String>,
    /// Kinds of the joints; an empty list stands for revolute joints.
    pub kinds: Vec<JointKind>,
    /// Times of the bands and of the nominal motion \[s\], strictly increasing, at least two.
    pub times: Vec<f64>,
    /// The reachable set, drawn light grey.
    pub band: Band,
    /// A second band, drawn dark grey, such as the position-conformant reachable set of Fig. 4, or
    /// the lowest and highest values of all runs.
    pub inner: Option<Band>,
    /// Whether only positions are compared with the set, so that velocities may lie outside.
    pub positions_only: bool,
    /// The nominal motion, from which deviations are measured.
    pub nominal: Nominal,
    /// The recorded runs that are drawn.
    pub runs: Vec<RunTrace>,
    /// Number of further runs, which lie in the second band and are not drawn.
    pub undrawn: usize,
    /// The samples that decide the sets, or lie outside the reachable set.
    pub tight: Vec<TightSpot>,
    /// Number of rows of all runs that lie outside the reachable set, drawn or not.
    pub outside: usize,
    /// The largest [`RunTrace::gauge`] of all runs, drawn or not.
    pub furthest: Option<f64>,
    /// How far every run comes out, drawn or not.
    pub(crate) gauges: Vec<RunGauge>,
}

/// The interval hull of a reachable set over time.
#[derive(Debug, Clone, Default)]
pub struct Band {
    /// The band's entry in the legend.
    pub label: String,
    /// Lower bounds, shape `[2n][times]`.
    pub lower: Vec<Vec<f64>>,
    /// Upper bounds, shape `[2n][times]`.
    pub upper: Vec<Vec<f64>>,
}

/// The nominal motion x̂, which decides the views that can be drawn.
#[derive(Debug, Clone, Default)]
pub enum Nominal {
    /// Not known: the bands and runs are drawn as they are.
    #[default]
    Unknown,
    /// One nominal motion for all runs, shape `[2n][times]`: the motion is drawn, and the
    /// deviation x - x̂ from it.
    Shared(Vec<Vec<f64>>),
    /// Each run has its own nominal motion: bands and runs are given as deviations, and only
    /// these are drawn.
    PerRun,
}

/// One recorded run.
#[derive(Debug, Clone, Default)]
pub struct RunTrace {
    /// The run's name.
    pub name: String,
    /// Position in the order of recording; it colours the line where a temperature is missing.
    pub order: usize,
    /// Temperature \[°C\]; it colours the lines where every run has one.
    pub temperature: Option<f64>,
    /// Mean temperature of each joint over the run \[°C\], n; empty if none were recorded. Where
    /// every run has them, they colour the lines of each joint over its own range.
    pub temperatures: Vec<f64>,
    /// Sample times \[s\], strictly increasing.
    pub times: Vec<f64>,
    /// Samples, shape `[2n][times]`.
    pub states: Vec<Vec<f64>>,
    /// The part of the set's radius that the run reaches at most, over samples and states: 1 at the
    /// boundary, more outside. `None` if it is not known.
    pub gauge: Option<f64>,
    /// Number of support rows of the linear program that this run decides.
    pub touches: usize,
}

/// How far out a run comes, beside what it may depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RunGauge {
    /// [`RunTrace::order`].
    pub order: usize,
    /// [`RunTrace::temperature`] \[°C\].
    pub temperature: Option<f64>,
    /// [`RunTrace::gauge`].
    pub gauge: f64,
}

/// A sample that touches the boundary of the reachable set, or lies outside it.
#[derive(Debug, Clone, Copy)]
pub struct TightSpot {
    /// Index into [`SuiteFigure::runs`].
    pub run: usize,
    /// Time \[s\].
    pub time_s: f64,
    /// Index of the state, 0..2n.
    pub state: usize,
    /// The side of the reachable set.
    pub side: Side,
    /// Distance to the boundary in the state's unit; negative if the sample lies outside.
    pub margin: f64,
}

/// The quantity that a figure shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// The states themselves.
    Motion,
    /// The states minus the nominal motion.
    Deviation,
}

impl View {
    /// Returns the name by which the page's buttons and the files of figures call the view.
    pub(super) fn name(self) -> &'static str {
        match self {
            View::Motion => "motion",
            View::Deviation => "deviation",
        }
    }
}

/// Difference of times that are taken for the same \[s\]; nominal times are rounded to a
/// picosecond.
pub(super) const SAME_TIME: f64 = 1e-9;

impl Band {
    pub(super) fn label(&self) -> &str {
        if self.label.is_empty() { "reachable set" } else { &self.label }
    }
}

impl RunTrace {
    /// Returns whether the run's samples are at the first of some times.
    pub(super) fn has_times(&self, times: &[f64]) -> bool {
        let is_same = |(a, b): (&f64, &f64)| (a - b).abs() <= SAME_TIME;
        self.times.len() <= times.len() && self.times.iter().zip(times).all(is_same)
    }
}

impl SuiteFigure {
    /// Returns the views of this suite that [`suite_svg`](crate::suite_svg) can draw.
    #[must_use]
    pub(crate) fn views(&self) -> &'static [View] {
        match self.nominal {
            Nominal::Unknown => &[View::Motion],
            Nominal::Shared(_) => &[View::Motion, View::Deviation],
            Nominal::PerRun => &[View::Deviation],
        }
    }

    /// Names a state by joint and quantity, such as `elbow, velocity`.
    pub(super) fn state_label(&self, state: usize) -> String {
        format!("{}, {}", self.joints[state % self.joints.len()], self.quantity(state))
    }

    fn quantity(&self, state: usize) -> &'static str {
        if state < self.joints.len() { "position" } else { "velocity" }
    }

    pub(super) fn bands(&self) -> impl Iterator<Item = &Band> {
        [Some(&self.band), self.inner.as_ref()].into_iter().flatten()
    }

    /// Returns the heading of a joint's plots, with its units if joints have different ones.
    pub(super) fn heading(&self, joint: usize) -> String {
        let unit = self.shared_unit(joint).is_none().then(|| self.state_unit(joint));
        let unit = unit.map_or_else(String::new, |unit| format!(" [{unit}, {unit}/s]"));
        format!("{}{unit}", self.joints[joint])
    }

    /// Returns the label of the vertical axis of a state, with the unit if all joints share it.
    pub(super) fn axis(&self, state: usize) -> String {
        let unit = self.shared_unit(state).map_or_else(String::new, |unit| format!(" [{unit}]"));
        format!("{}{unit}", self.quantity(state))
    }

    /// Describes the plot of a state, runs in the given colours.
    pub(super) fn chart(&self, state: usize, colours: &[[u8; 3]]) -> Chart {
        let line = |times: &[f64], values: &[f64]| -> Vec<Point> {
            times.iter().copied().zip(values.iter().copied()).collect()
        };
        let area = |Band { lower, upper, .. }: &Band| {
            let [lower, upper] = [lower, upper].map(|edge| line(&self.times, &edge[state]));
            Area { lower, upper }
        };
        let runs = self.runs.iter().zip(colours);
        let mut series: Vec<Series> = runs
            .map(|(run, colour)| Series::line(line(&run.times, &run.states[state]), *colour))
            .collect();
        let spots = self.tight.iter().filter(|spot| spot.state == state);
        let ring = |spot: &TightSpot| {
            let line = &series[spot.run].points;
            let mark = if spot.margin < 0.0 { Mark::Outside } else { Mark::Decides };
            let point = (!line.is_empty()).then(|| (spot.time_s, interpolate(line, spot.time_s)));
            point.map(|point| Series { points: vec![point], mark, colour: Default::default() })
        };
        let rings: Vec<Series> = spots.filter_map(ring).collect();
        series.extend(rings);
        Chart {
            title: self.heading(state % self.joints.len()),
            x: "time [s]".into(),
            y: self.axis(state),
            areas: self.bands().map(area).collect(),
            series,
            rows: Vec::new(),
        }
    }

    /// Returns the figure of the deviations from the nominal motion, over its times.
    pub(super) fn deviations(&self) -> SuiteFigure {
        let Nominal::Shared(nominal) = &self.nominal else { return self.clone() };
        let minus = |rows: &[Vec<f64>]| {
            let row = |(row, nominal): (&Vec<f64>, &Vec<f64>)| {
                row.iter().zip(nominal).map(|(x, nominal)| x - nominal).collect()
            };
            rows.iter().zip(nominal).map(row).collect()
        };
        let band = |Band { label, lower, upper }: &Band| Band {
            label: label.clone(),
            lower: minus(lower),
            upper: minus(upper),
        };
        let nominal: Vec<Vec<Point>> = nominal
            .iter()
            .map(|row| self.times.iter().copied().zip(row.iter().copied()).collect())
            .collect();
        let known = self.times[0]..=self.times[self.times.len() - 1];
        let run = |run: &RunTrace| {
            let known: Vec<usize> =
                (0..run.times.len()).filter(|k| known.contains(&run.times[*k])).collect();
            let row = |(row, nominal): (&Vec<f64>, &Vec<Point>)| {
                let deviation = |k: &usize| row[*k] - interpolate(nominal, run.times[*k]);
                known.iter().map(deviation).collect()
            };
            let states = run.states.iter().zip(&nominal).map(row).collect();
            RunTrace { times: known.iter().map(|k| run.times[*k]).collect(), states, ..run.clone() }
        };
        SuiteFigure {
            band: band(&self.band),
            inner: self.inner.as_ref().map(band),
            runs: self.runs.iter().map(run).collect(),
            nominal: Nominal::PerRun,
            ..self.clone()
        }
    }

    /// Returns the number of drawn samples that decide the sets; samples outside decide nothing.
    pub(super) fn decided(&self) -> usize {
        self.tight.iter().filter(|spot| spot.margin >= 0.0).count()
    }

    /// Returns the unit that the positions or the velocities of all joints share, for the quantity
    /// of a state.
    fn shared_unit(&self, state: usize) -> Option<&'static str> {
        let shared = self.kinds.iter().all(|kind| *kind == self.kinds[0]);
        shared.then(|| self.state_unit(state))
    }

    pub(super) fn state_unit(&self, state: usize) -> &'static str {
        let n = self.joints.len();
        let kind = self.kinds.get(state % n).copied().unwrap_or_default();
        if state < n { kind.position_unit() } else { kind.velocity_unit() }
    }
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
        let states = &figure.deviations().runs[0].states;
        assert!(states[3].len() == figure.times.len() && states[3].iter().all(|x| *x == 0.0));
    }

    #[test]
    fn a_run_on_its_own_times_is_measured_against_the_interpolated_nominal() {
        let figure = SuiteFigure {
            joints: vec!["a".into()],
            times: vec![0.0, 1.0],
            nominal: Nominal::Shared(vec![vec![2.0, 4.0]]),
            runs: vec![RunTrace {
                times: vec![-1.0, 0.5, 1.0, 9.0],
                states: vec![vec![0.0, 7.0, 9.0, 0.0]],
                ..RunTrace::default()
            }],
            ..SuiteFigure::default()
        };
        let RunTrace { times, states, .. } = &figure.deviations().runs[0];
        assert_eq!((&times[..], &states[0][..]), (&[0.5, 1.0][..], &[4.0, 5.0][..]));
    }

    #[test]
    fn marks_sit_on_their_run() {
        let figure = sample::suite("S", 2);
        let spot = figure.tight[0];
        let series = figure.chart(spot.state, &[[0; 3]; 3]).series;
        let ring = &series[figure.runs.len()];
        assert_eq!(ring.points[0].1, interpolate(&series[spot.run].points, spot.time_s));
        assert_eq!(ring.mark, Mark::Decides);
    }
}
