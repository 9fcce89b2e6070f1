//! Usefulness of a model, and preparation of its logs.

use reachtube_recordings::{Preparation, Torque};

use crate::model::file::Model;
use crate::next_motion::without_motion::LeftOut;

impl Model {
    /// Returns whether the sets were proved to enclose every recording and say something about the
    /// motion of every part. A model is vacuous otherwise if it is proved.
    #[must_use]
    pub fn is_useful(&self) -> bool {
        self.verified && !self.is_vacuous()
    }

    /// Returns whether the sets were proved to enclose every recording but do not limit the
    /// motion of some part.
    #[must_use]
    pub fn is_vacuous(&self) -> bool {
        self.verified && self.usefulness.as_ref().is_some_and(|said| !said.vacuous.is_empty())
    }

    pub(crate) fn with_left_out(self, left_out: Vec<LeftOut>) -> Self {
        Self { left_out, ..self }.sealed()
    }

    /// Returns the model with what was done to logs before its sets were found. That is no longer a
    /// remedy of any warning. A scenario bound becomes an indication where the cut-off or the
    /// horizon was chosen from the logs. Logs that were not cut into windows were used up to the
    /// horizon of the sets, and later samples of other logs are not compared.
    #[must_use]
    pub fn with_preparation(mut self, preparation: Preparation) -> Self {
        let has_input = preparation.torque != Torque::Compensated;
        for warning in self.warnings.iter_mut().filter(|_| has_input) {
            warning.remedy.take_if(|remedy| remedy.setting == "torque");
        }
        if preparation.window.is_none() {
            self.settings.until = self.usefulness.as_ref().map(|said| said.horizon);
        }
        let are_chosen = preparation.cut_off.is_some() || preparation.window.is_none();
        let trust = if are_chosen { self.trust.of_chosen_settings() } else { self.trust };
        Self { preparation: Some(preparation), trust, ..self }.sealed()
    }
}
