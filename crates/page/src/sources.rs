//! What a page is made from.

use std::collections::HashSet;

use reachtube_conform::model::DataRecord;
use reachtube_conform::{Check, Model, Problem, SuiteReach};
use reachtube_finding::FrontEnd;

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

impl Sources<'_> {
    /// Tells whether the model was made from recordings of the page: others decide none of its
    /// sets. A model that does not list its recordings counts as made from them: names decide.
    pub(super) fn are_own(&self) -> bool {
        let [of_model, of_page] = [&self.model.data, &self.check.provenance.data];
        let runs = |data: &'_ DataRecord| -> HashSet<String> {
            let runs = data.suites.iter().flat_map(|suite| &suite.runs);
            runs.map(|run| run.sha256.clone()).collect()
        };
        let own = runs(of_model);
        let is_same = own.is_empty() || of_model.sha256 == of_page.sha256;
        is_same || !own.is_disjoint(&runs(of_page))
    }
}

pub(super) fn joint_name(model: &Model, joint: usize) -> String {
    let part = model.signals.parts.get(joint);
    part.map_or_else(|| format!("{}", joint + 1), |part| part.name.clone())
}
