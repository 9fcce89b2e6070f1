//! How recorded points are looked at.

use crate::sets::UncertaintySets;
use crate::tube::judged::At;

/// Points outside the reachable set of `sets` shrunk by the factor `margin`, or close to its
/// boundary.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Near {
    pub sets: UncertaintySets,
    pub margin: f64,
}

/// How points are looked at under some sets.
#[derive(Debug, Clone)]
pub(crate) enum Look {
    /// In floating point: among the points that are in one of the lists `near`, the one furthest
    /// outside at each sample and in each projection, where the set must grow by more than
    /// 1 + `tolerance`.
    Search { tolerance: f64, near: Vec<Near> },
    /// With directed rounding: every point, or the points at the samples `at` alone. Also how far
    /// the sets reach in the directions `asked`.
    Proof { at: Option<Vec<At>>, asked: Vec<(At, Vec<f64>)> },
}

impl Look {
    pub(crate) fn proof() -> Self {
        Self::Proof { at: None, asked: Vec::new() }
    }
}
