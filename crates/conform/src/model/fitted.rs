//! What a fit of the nominal model adds to a model.

use std::collections::HashSet;

use crate::fit::record::FitRecord;
use crate::model::file::Model;
use crate::next_motion::calibration::Calibration;
use crate::next_motion::without_motion::LeftOut;
use crate::result::findings::plausibility::overfitted;

impl Model {
    /// Returns the model with the record of how its nominal model was fitted, and a warning where
    /// the fit suits its own motions only. Motions are left out of the fit of a linear model too.
    #[must_use]
    pub fn with_fit(mut self, record: FitRecord) -> Self {
        let calibrated_cost = self.calibration.as_ref().and(self.cost);
        let overfit = record.overfitted(calibrated_cost);
        self.warnings.extend(overfit.as_ref().map(overfitted));
        // The nominal model that was fitted to all motions has seen each of them.
        if record.taken && !self.a.is_empty() && !self.left_out.is_empty() {
            self.left_out = record.leave_one_out.iter().map(LeftOut::from).collect();
        }
        self.seen.extend(self.fitted_runs());
        self.seen.retain(|sha256| !sha256.is_empty());
        self.seen.sort();
        self.seen.dedup();
        Self { fit: Some(record), ..self }.sealed()
    }

    /// Returns the SHA-256 of the listed recordings that a fit has seen: recordings of motions that
    /// were not held out.
    fn fitted_runs(&self) -> Vec<String> {
        let held_out: HashSet<&str> =
            self.calibration.iter().flat_map(Calibration::held_out).collect();
        let suites = self.data.suites.iter().filter(|suite| !held_out.contains(suite.motion()));
        suites.flat_map(|suite| &suite.runs).map(|run| run.sha256.clone()).collect()
    }
}
