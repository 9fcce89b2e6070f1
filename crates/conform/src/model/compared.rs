//! Folds of recordings that are compared with a model's.

use crate::data::fold::fold::Fold;
use crate::data::setup::Setup;
use crate::error::Result;
use crate::model::file::Model;

impl Fold {
    /// Returns the fold of no recording, to check `model`; `setup` is the one that
    /// its loader returned with it. The fold counts the recordings that the model was fitted
    /// to, where the model file lists them. Folds merge where they check the same model.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new), but a model may have explanations.
    pub fn to_check(setup: &Setup, model: &Model) -> Result<Self> {
        let runs = model.data.suites.iter().flat_map(|suite| &suite.runs);
        let fitted = runs.map(|run| run.sha256.clone()).collect();
        Self::comparing(setup, model.data.sha256.clone(), fitted)
    }
}
