//! The contents of a figure: one test suite with its reachable set, its runs, and its tight spots.

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
    pub gauges: Vec<RunGauge>,
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
pub struct RunGauge {
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

/// Difference of times that are taken for the same \[s\]; nominal times are rounded to a
/// picosecond.
pub(super) const SAME_TIME: f64 = 1e-9;

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
        let n = self.joints.len();
        let quantity = if state < n { "position" } else { "velocity" };
        format!("{}, {quantity}", self.joints[state % n])
    }

    /// Returns the number of drawn samples that decide the sets; samples outside decide nothing.
    pub(super) fn decided(&self) -> usize {
        self.tight.iter().filter(|spot| spot.margin >= 0.0).count()
    }

    /// Returns the unit that the positions or the velocities of all joints share, for the quantity
    /// of a state.
    pub(super) fn shared_unit(&self, state: usize) -> Option<&'static str> {
        let shared = self.kinds.iter().all(|kind| *kind == self.kinds[0]);
        shared.then(|| self.state_unit(state))
    }

    /// Returns the unit of a state.
    pub(super) fn state_unit(&self, state: usize) -> &'static str {
        let n = self.joints.len();
        let kind = self.kinds.get(state % n).copied().unwrap_or_default();
        if state < n { kind.position_unit() } else { kind.velocity_unit() }
    }
}
