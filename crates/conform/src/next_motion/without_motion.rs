use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::fit::record::UnseenMotion;

/// The sets of all motions but one, and how that one lies to them. A description, to rounding: it
/// is not proved, and bounds no probability.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LeftOut {
    /// The motion that is left out.
    pub motion: String,
    /// The cost of the smallest sets for the others, over the same samples as the cost of all; of a
    /// model that is not linear, the cost of the linearised sets. `None` if it was not computed.
    pub cost: Option<f64>,
    /// Number of rows of the motion, or of its points where the notion asks them.
    pub rows: usize,
    /// How many of them leave these sets.
    pub outside: Option<usize>,
    /// The factor, at least 1, by which the radii of these sets must grow to enclose the motion.
    /// `None` if no factor suffices, or where the reachable set of a model that is not linear
    /// is lost before one does.
    pub gauge: Option<f64>,
    /// The factor, at least 1, by which the radii of X0 must grow to enclose the starts of the
    /// motion. `None` if no factor suffices, and for a model that is not linear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_gauge: Option<f64>,
    /// The factor, at least 1, by which the radii of U must grow to enclose the rest of the motion
    /// once X0 has grown so. `None` if no factor suffices, and for a model that is not linear.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input_gauge: Option<f64>,
    /// The factor, at least 1, by which a set of positions at the end becomes wider, the one that
    /// does most, once X0 has grown in each state as the first samples of the motion need it, and
    /// then U by a factor. `None` as above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wider: Option<f64>,
}

impl LeftOut {
    /// Makes the record of a motion that was not compared with the sets of the others.
    pub(crate) fn unknown(motion: &str, rows: usize) -> Self {
        Self { motion: motion.into(), rows, ..Self::default() }
    }

    /// Returns by which factor sets become wider that enclose the motion, the least that is known:
    /// [`wider`](Self::wider) or [`gauge`](Self::gauge). Infinite if no factor suffices.
    #[must_use]
    pub fn growth(&self) -> f64 {
        [self.wider, self.gauge].into_iter().flatten().fold(f64::INFINITY, f64::min)
    }
}

impl From<&UnseenMotion> for LeftOut {
    fn from(unseen: &UnseenMotion) -> Self {
        Self {
            motion: unseen.motion.clone(),
            cost: unseen.cost_without,
            rows: unseen.rows,
            outside: unseen.outside,
            gauge: unseen.growth,
            initial_gauge: unseen.initial_growth,
            input_gauge: unseen.input_growth,
            wider: unseen.wider,
        }
    }
}
