//! A comparison of a model with recordings, as every front end poses it.

use reachtube_recordings::{GapLimit, RunSource};

use crate::check::{Check, check};
use crate::data::notion::Notion;
use crate::data::problem::{Keep, Problem};
use crate::data::setup::Setup;
use crate::error::Result;
use crate::model::file::Model;
use crate::progress::Progress;
use crate::reach::{SuiteReach, reach};
use crate::tube::tube::Tube;

/// A model to compare with recordings, whose torques are of the model's kind.
#[derive(Debug)]
pub struct CheckJob {
    model: Model,
    setup: Setup,
    source: Box<dyn RunSource>,
    suites: Vec<String>,
    notion: Option<Notion>,
    until: Option<f64>,
    gap_limit: GapLimit,
    keep: Keep,
}

/// A model, recordings that were read for it, and its reachable sets over them.
#[derive(Debug)]
pub struct Opened {
    /// The model.
    pub model: Model,
    /// The recordings.
    pub problem: Problem,
    /// The reachable sets.
    pub tube: Tube,
}

impl CheckJob {
    /// Makes a job of a model and its setup.
    pub fn new(model: Model, setup: Setup, source: impl RunSource + 'static) -> Self {
        Self {
            model,
            setup,
            source: Box::new(source),
            suites: Vec::new(),
            notion: None,
            until: None,
            gap_limit: GapLimit::Usual,
            keep: Keep::Needed,
        }
    }

    /// Uses these suites only; all if none is named.
    #[must_use]
    pub fn suites<T: Into<String>>(self, names: impl IntoIterator<Item = T>) -> Self {
        Self { suites: names.into_iter().map(Into::into).collect(), ..self }
    }

    /// Judges recordings by this notion; without one, by the model's.
    #[must_use]
    pub fn notion(self, notion: Option<Notion>) -> Self {
        Self { notion, ..self }
    }

    /// Uses samples up to this time after the first only, s; without one, up to the model's.
    #[must_use]
    pub fn until(self, until: Option<f64>) -> Self {
        Self { until, ..self }
    }

    /// Limits the time between two samples.
    #[must_use]
    pub fn gap_limit(self, gap_limit: GapLimit) -> Self {
        Self { gap_limit, ..self }
    }

    /// Chooses which recordings stay in memory; pages and figures need all.
    #[must_use]
    pub fn keep(self, keep: Keep) -> Self {
        Self { keep, ..self }
    }

    /// Reads the recordings and computes the reachable sets over them.
    ///
    /// # Errors
    ///
    /// As [`Problem::read`] and [`Tube::new`].
    pub fn open(self, progress: &dyn Progress) -> Result<Opened> {
        let Self { model, setup, source, suites, keep, .. } = self;
        let setup = setup.judged_by(self.notion, self.until, self.gap_limit);
        let problem = Problem::read(setup, source, &suites, keep, progress)?;
        let tube = Tube::new(&problem, model.sets())?;
        Ok(Opened { model, problem, tube })
    }

    /// Checks whether the recordings lie in the reachable sets.
    ///
    /// # Guarantee
    ///
    /// As [`check()`](crate::check()).
    ///
    /// # Errors
    ///
    /// As [`open`](Self::open). Recordings that do not lie in the sets are no error.
    pub fn run(self, progress: &dyn Progress) -> Result<Check> {
        self.open(progress)?.check()
    }
}

impl Opened {
    /// Checks whether the recordings lie in the reachable sets.
    ///
    /// # Errors
    ///
    /// As [`check()`](crate::check()).
    pub fn check(&self) -> Result<Check> {
        check(&self.model, &self.problem, &self.tube)
    }

    /// Returns the reachable set of each suite, at samples and between them.
    ///
    /// # Errors
    ///
    /// As [`reach()`](crate::reach()).
    pub fn reach(&self) -> Result<Vec<SuiteReach>> {
        reach(&self.problem, &self.tube)
    }
}
