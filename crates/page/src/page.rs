//! The contents of a page: verdict, figures, uncertainty sets, settings, and what they mean.

use super::chart::Chart;
use super::suite_figure::SuiteFigure;
use reachtube_finding::Table;
use reachtube_robot::JointKind;

/// A closed interval `[lower, upper]`, in the unit that the field holding it names.
pub(crate) type Bounds = [f64; 2];

/// The contents of a page. Texts are plain text; the page escapes them.
#[derive(Debug, Clone, Default)]
pub struct Page {
    /// Heading, such as the robot's name.
    pub(crate) title: String,
    /// One line under the heading.
    pub(crate) subtitle: String,
    /// The answer, shown first.
    pub(crate) verdict: Verdict,
    /// The first lines below it.
    pub(crate) lead: Lead,
    /// The figures, in the order of their buttons; the first one is open.
    pub(crate) suites: Vec<SuiteFigure>,
    /// The phase planes of the joints, if the model is linear.
    pub(crate) phase_planes: Vec<Chart>,
    /// What was fitted of the nominal model, for a model that was.
    pub(crate) nominal: Vec<Table>,
    /// The uncertainty sets: one table per notion of conformance (Table II has two).
    pub(crate) sets: Vec<SetsTable>,
    /// What the cost of the sets comes from.
    pub(crate) cost: Vec<Table>,
    /// The runs over what the cost may depend on.
    pub(crate) cost_charts: Vec<Chart>,
    /// Settings and provenance: name and value.
    pub(crate) facts: Vec<(String, String)>,
    /// Claims that the reader may rely on.
    pub(crate) trust: Vec<String>,
    /// Conclusions that the reader must not draw.
    pub(crate) caution: Vec<String>,
    /// Further remarks, one paragraph each.
    pub(crate) notes: Vec<String>,
}

/// The first lines of a page: the answer in numbers, and one figure, before any table.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lead {
    /// Marks of the whole page, such as "simulated data".
    pub badges: Vec<String>,
    /// The answer in numbers with units: name and value.
    pub facts: Vec<(String, String)>,
    /// The figure of the widest set.
    pub figure: Option<Chart>,
    /// The caption.
    pub caption: String,
    /// Other pages about the same model: words, and the address from this page.
    pub links: Vec<(String, String)>,
}

/// The outcome in words.
#[derive(Debug, Clone, Default)]
pub(crate) struct Verdict {
    /// Whether every recording was proved to be enclosed, in the notion that `words` names.
    pub ok: bool,
    /// Whether the model is vacuous: its sets do not limit the motion of some joint.
    pub vacuous: bool,
    /// Whether the sets are narrow enough beside the motion; `None` if no limit was set.
    pub useful: Option<bool>,
    /// The outcome as one sentence.
    pub words: String,
    /// Implausible results, one sentence each.
    pub warnings: Vec<String>,
    /// Claims that were checked with directed rounding.
    pub proved: Vec<String>,
    /// Claims that were not checked, or hold only with a stated confidence.
    pub not_proved: Vec<String>,
}

/// The uncertainty sets of all joints for one notion of conformance (one half of Table II).
#[derive(Debug, Clone, Default)]
pub(crate) struct SetsTable {
    /// The notion, such as "position and velocity conformant".
    pub notion: String,
    /// One row per joint.
    pub joints: Vec<JointSets>,
}

/// The uncertainty sets of one joint (a row of Table II).
#[derive(Debug, Clone, Default)]
pub(crate) struct JointSets {
    /// The joint's name.
    pub joint: String,
    /// The joint's kind, from which the units follow.
    pub kind: JointKind,
    /// Initial position set X0 \[rad; m for a prismatic joint\].
    pub x0_q: Bounds,
    /// Initial velocity set X0 \[rad/s; m/s\].
    pub x0_qd: Bounds,
    /// Input set U \[N m; N\].
    pub u: Bounds,
    /// Measurement noise V of position and velocity; `None` if no noise was modelled.
    pub noise: Option<[Bounds; 2]>,
}
