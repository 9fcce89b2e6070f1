use serde::{Deserialize, Serialize};

use crate::operating_box::OperatingBox;

/// A bound of the truncation error f(x, u) - f_p(x, u): acceleration of the robot minus
/// acceleration of the model, over an operating box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Remainder {
    /// The box over which the bound holds.
    pub operating_box: OperatingBox,
    /// Interval \[low, high\] that contains the truncation error of each joint, n, rad/s²; `None`
    /// where no bound was found.
    pub bounds: Vec<Option<[f64; 2]>>,
    /// Largest magnitude of the truncation error that a search found for each joint, n, rad/s². No
    /// bound can be smaller. The key in a file is `seen`.
    #[serde(rename = "seen")]
    pub sampled_error: Vec<f64>,
    /// Number of boxes that the operating box was cut into.
    pub boxes: usize,
}

impl Remainder {
    /// Returns whether the sizes fit n joints and the box is not empty.
    pub(crate) fn is_valid_for(&self, n: usize) -> bool {
        self.operating_box.is_valid_for(n)
            && self.bounds.len() == n
            && self.sampled_error.len() == n
    }
}
