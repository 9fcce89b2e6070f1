//! What a page is made from.

use reachtube_conform::result::FrontEnd;
use reachtube_conform::{Check, Model, Problem, SuiteReach};

/// The sources of a page.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// The model.
    pub model: &'a Model,
    /// The recordings that are drawn.
    pub problem: &'a Problem,
    /// The reachable sets over them.
    pub reach: &'a [SuiteReach],
    /// Whether the recordings lie in the sets.
    pub check: &'a Check,
    /// How the page writes settings.
    pub front_end: FrontEnd,
}

pub(super) fn joint_name(model: &Model, joint: usize) -> String {
    model
        .robot
        .joints
        .get(joint)
        .map_or_else(|| format!("{}", joint + 1), |description| description.name.clone())
}
