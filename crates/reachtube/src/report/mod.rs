//! Figures and the HTML page: what was proved about which recordings, drawn so that a reader can
//! check it by eye.
//!
//! [`write_html`] writes one self-contained page (no network, no external font or script);
//! [`suite_svg`] writes one figure in the spirit of Figs. 2 and 4 of Liu & Althoff (IROS 2018). The
//! inputs are plain numbers and words, so the page can be made from any result, and the same input
//! always gives the same bytes.

mod assemble;
mod chart;
mod check;
mod colour;
mod decimate;
mod figure;
mod html;
mod identified;
mod layout;
mod legend;
mod number;
mod panel;
mod tables;
mod text;

#[cfg(test)]
mod browser;
#[cfg(test)]
mod sample;

pub use assemble::{Sources, page};
pub use chart::{Chart, Series, chart_svg};
pub use figure::suite_svg;
pub use html::write_html;
pub use identified::write_identified_html;

/// A closed interval `[lower, upper]`, in the unit that the field holding it names.
pub type Bounds = [f64; 2];

/// Everything the page says. Texts are plain text; the page escapes them.
#[derive(Debug, Clone, Default)]
pub struct Page {
    /// Heading, such as the robot's name.
    pub title: String,
    /// One line under the heading.
    pub subtitle: String,
    /// The answer, shown first.
    pub verdict: Verdict,
    /// The figures, in the order of their buttons; the first one is open.
    pub suites: Vec<SuiteFigure>,
    /// The uncertainty sets: one table a notion of conformance (Table II has two).
    pub sets: Vec<SetsTable>,
    /// Settings and provenance: name and value.
    pub facts: Vec<(String, String)>,
    /// What the reader may rely on.
    pub trust: Vec<String>,
    /// What the reader must not conclude.
    pub caution: Vec<String>,
    /// Anything else, a paragraph each.
    pub notes: Vec<String>,
}

/// The outcome in words.
#[derive(Debug, Clone, Default)]
pub struct Verdict {
    /// Whether every recording was proved to be enclosed, in the notion that the words name.
    pub ok: bool,
    /// The outcome as one sentence.
    pub words: String,
    /// What was checked with directed rounding.
    pub proved: Vec<String>,
    /// What was not checked, or holds only with a stated confidence.
    pub not_proved: Vec<String>,
}

/// Uncertainty sets of all joints for one notion of conformance (one half of Table II).
#[derive(Debug, Clone, Default)]
pub struct SetsTable {
    /// For example "position and velocity conformant".
    pub notion: String,
    /// One row a joint.
    pub joints: Vec<JointSets>,
}

/// The uncertainty sets of one joint (a row of Table II).
#[derive(Debug, Clone, Default)]
pub struct JointSets {
    /// The joint's name.
    pub joint: String,
    /// Initial position set X0 \[rad\].
    pub x0_q: Bounds,
    /// Initial velocity set X0 \[rad/s\].
    pub x0_qd: Bounds,
    /// Input set U \[N m\].
    pub u: Bounds,
    /// Measurement noise V of position \[rad\] and velocity \[rad/s\]; `None` where no noise was
    /// modelled.
    pub noise: Option<[Bounds; 2]>,
}

/// One test suite: the reachable set, its runs, and where they touch.
///
/// States are ordered q1..qn \[rad\], then q̇1..q̇n \[rad/s\]; a table of states has the shape
/// `[2n][times]`.
#[derive(Debug, Clone, Default)]
pub struct SuiteFigure {
    /// The suite's name.
    pub suite: String,
    /// Names of the n joints.
    pub joints: Vec<String>,
    /// Times of the bands and of the nominal \[s\], strictly increasing, at least two.
    pub times: Vec<f64>,
    /// The reachable set, drawn light grey.
    pub band: Band,
    /// A second reachable set, drawn dark grey, such as the position-conformant one of Fig. 4.
    pub inner: Option<Band>,
    /// What the states are measured against.
    pub nominal: Nominal,
    /// The recorded runs.
    pub runs: Vec<RunTrace>,
    /// The points that decide the sets, or lie outside the reachable set.
    pub tight: Vec<TightSpot>,
}

/// The interval hull of a reachable set over time.
#[derive(Debug, Clone, Default)]
pub struct Band {
    /// What the band is, for the legend.
    pub label: String,
    /// Lower bounds, shape `[2n][times]`.
    pub lower: Vec<Vec<f64>>,
    /// Upper bounds, shape `[2n][times]`.
    pub upper: Vec<Vec<f64>>,
}

/// The nominal trajectory x̂, and by it the views that can be drawn.
#[derive(Debug, Clone, Default)]
pub enum Nominal {
    /// Not known: the bands and runs are drawn as they are.
    #[default]
    Unknown,
    /// One nominal for all runs, shape `[2n][times]`: the motion is drawn, and the deviation x - x̂
    /// from it.
    Shared(Vec<Vec<f64>>),
    /// Each run has its own nominal: bands and runs are given as deviations already, and only these
    /// are drawn.
    PerRun,
}

/// One recorded run.
#[derive(Debug, Clone, Default)]
pub struct RunTrace {
    /// The run's name.
    pub name: String,
    /// Position in the order of recording; colours the line where a temperature is missing.
    pub order: usize,
    /// Temperature \[°C\]; colours the lines where every run has one.
    pub temperature: Option<f64>,
    /// Sample times \[s\], strictly increasing.
    pub times: Vec<f64>,
    /// Samples, shape `[2n][times]`.
    pub states: Vec<Vec<f64>>,
    /// How many support rows of the program are decided by this run.
    pub touches: usize,
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
    /// Distance to the boundary in the state's unit; negative where the sample lies outside. For
    /// [`Side::Plane`] in the scaled unit of the direction.
    pub margin: f64,
}

/// On which side of the reachable set a sample is tight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// At the lower bound of the state.
    Lower,
    /// At the upper bound of the state.
    Upper,
    /// At a facet in the (q, q̇) plane of the state's joint.
    Plane,
}

/// What a figure shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// The states themselves.
    Motion,
    /// The states minus the nominal.
    Deviation,
}

/// Why a page or figure could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// Two arrays that belong together differ in length.
    #[error(
        "suite {suite}: {what} has length {got}, but {expected} is needed; pass states as [2n][times], n joints"
    )]
    Shape {
        /// The suite.
        suite: String,
        /// The array.
        what: String,
        /// Its length.
        got: usize,
        /// The length it must have.
        expected: usize,
    },
    /// A number that cannot be drawn.
    #[error(
        "{place}: {what}[{index}] is {value}, which cannot be drawn; check the step that computed it"
    )]
    NotFinite {
        /// The suite or table.
        place: String,
        /// The array.
        what: String,
        /// Index of the sample.
        index: usize,
        /// The value.
        value: f64,
    },
    /// Times that do not increase.
    #[error(
        "suite {suite}: {what}[{index}] is {value} s, not later than the sample before; sort the samples by time"
    )]
    Order {
        /// The suite.
        suite: String,
        /// The array.
        what: String,
        /// Index of the sample.
        index: usize,
        /// Its time \[s\].
        value: f64,
    },
    /// The view needs a nominal that the suite does not have, or has for each run only.
    #[error("suite {suite} has no {view:?} view; SuiteFigure::views lists those that it has")]
    View {
        /// The suite.
        suite: String,
        /// The view asked for.
        view: View,
    },
    /// The drawing library refused.
    #[error("suite {suite}: the figure could not be drawn: {cause}")]
    Draw {
        /// The suite.
        suite: String,
        /// The library's words.
        cause: String,
    },
    /// The page could not be written.
    #[error("the page could not be written: {0}; check the folder and the free space")]
    Io(#[from] std::io::Error),
}

impl SuiteFigure {
    /// The views that [`suite_svg`] can draw of this suite.
    pub fn views(&self) -> &'static [View] {
        match self.nominal {
            Nominal::Unknown => &[View::Motion],
            Nominal::Shared(_) => &[View::Motion, View::Deviation],
            Nominal::PerRun => &[View::Deviation],
        }
    }

    /// What a spot is tight in, such as `elbow, velocity`; the joint alone for a facet of its
    /// plane.
    fn spot_label(&self, spot: &TightSpot) -> String {
        let n = self.joints.len();
        let joint = &self.joints[spot.state % n];
        match (spot.side, spot.state < n) {
            (Side::Plane, _) => joint.clone(),
            (_, true) => format!("{joint}, position"),
            (_, false) => format!("{joint}, velocity"),
        }
    }

    /// The unit of a state.
    fn state_unit(&self, state: usize) -> &'static str {
        if state < self.joints.len() { "rad" } else { "rad/s" }
    }
}
