//! The answer of a conformance.

use std::path::Path;

use crate::check::Check;
use crate::claim::certificate::Certificate;
use crate::conformance::{Conformance, conform_fitted};
use crate::data::problem::Problem;
use crate::error::Result;
use crate::fit::fit::{Fitted, fit};
use crate::fit::group::FitSettings;
use crate::fit::record::FitRecord;
use crate::model::file::Model;
use crate::next_motion::without_motion::LeftOut;
use crate::progress::Progress;
use crate::reach::{SuiteReach, reach};
use crate::result::findings;
use reachtube_finding::{Finding, Report};

/// The answer of a [`Job`](crate::Job): a model, the recordings it was made from, and all that was
/// found.
#[derive(Debug)]
pub struct Answer {
    /// The model with its sets.
    pub model: Model,
    /// The recordings.
    pub problem: Problem,
    /// What was found for them.
    pub found: Conformance,
}

impl Answer {
    /// Fits the nominal model of a problem if `fit` selects it, finds the smallest sets and proves
    /// them; `resume` is the file of a search that is continued.
    ///
    /// # Errors
    ///
    /// As [`fit`](fn@crate::fit) and [`conform`](crate::conform).
    pub fn new(
        problem: Problem,
        fit: Option<&FitSettings>,
        resume: Option<&Path>,
        progress: &dyn Progress,
    ) -> Result<Self> {
        let (problem, record, left_out) = match fit {
            None => (problem, None, None),
            Some(settings) => {
                let Fitted { problem, record, left_out } = self::fit(&problem, settings, progress)?;
                (problem, Some(record), left_out)
            }
        };
        // A fit has left the rows of each motion out already, also out of the nominal model.
        let is_linear = problem.dynamics().linear_system().is_some();
        let asks_rows = is_linear && !problem.settings().notion.asks_points();
        let left_out = left_out.filter(|_| asks_rows);
        let found = conform_fitted(&problem, left_out, progress, resume)?;
        Ok(Self { model: Self::model(&problem, &found, record), problem, found })
    }

    fn model(problem: &Problem, found: &Conformance, record: Option<FitRecord>) -> Model {
        let model = Model::new(problem, found);
        match record {
            Some(record) => model.with_fit(record),
            None => model,
        }
    }

    /// Adds radii to X0 and U, 3n, rad, rad/s and N m, and proves the wider sets: an allowance for
    /// motions that were not recorded.
    ///
    /// # Errors
    ///
    /// As [`conform`](crate::conform()).
    pub fn widened(self, allowance: Vec<f64>) -> Result<Self> {
        let Self { problem, found, model } = self;
        let found = found.widened(&problem, allowance)?;
        Ok(Self { model: Self::model(&problem, &found, model.fit), problem, found })
    }

    /// Replaces how motions lie to a model without them, such as by what
    /// [`carry_over`](crate::carry_over) finds for models that have seen less of them.
    #[must_use]
    pub fn with_left_out(mut self, left_out: Vec<LeftOut>) -> Self {
        self.found.left_out.clone_from(&left_out);
        Self { model: self.model.with_left_out(left_out), ..self }
    }

    /// Returns whether the sets were proved to enclose every recording.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.model.verified
    }

    /// Returns the findings of the answer: the verdict first, notes on the recordings last.
    #[must_use]
    pub fn findings(&self) -> Vec<Finding> {
        let notes = self.problem.recordings().notes.iter();
        let mut findings = self.model.findings();
        findings.extend(notes.map(|note| findings::note(note)));
        findings
    }

    /// Returns the answer for people.
    #[must_use]
    pub fn report(&self) -> Report {
        self.model.report()
    }

    /// Returns what another program needs to prove that every recorded point lies in the reachable
    /// set.
    ///
    /// # Errors
    ///
    /// As [`Certificate::new`].
    pub fn certificate(&self) -> Result<Certificate> {
        Certificate::new(&self.problem, &self.model)
    }

    /// Returns the verdict as a check of the model on its own recordings, without computing it
    /// again.
    #[must_use]
    pub fn check(&self) -> Check {
        Check::new(&self.model, &self.problem, self.found.verdict.clone())
    }

    /// Returns the reachable set of each suite, at samples and between them.
    ///
    /// # Errors
    ///
    /// As [`reach()`](crate::reach()).
    pub fn reach(&self) -> Result<Vec<SuiteReach>> {
        reach(&self.problem, &self.found.tube)
    }
}
