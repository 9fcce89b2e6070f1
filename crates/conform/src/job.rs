//! A conformance from recordings to an answer, as every front end poses it.

use std::path::PathBuf;

use reachtube_recordings::RunSource;

use crate::answer::Answer;
use crate::data::problem::{Keep, Problem};
use crate::data::setup::Setup;
use crate::error::{Error, Result};
use crate::fit::group::{FitSettings, Group};
use crate::progress::Progress;

/// A conformance to compute: a setup and recordings. It passes data between the steps, so
/// that every front end runs the same job in the same way.
#[derive(Debug)]
pub struct Job {
    setup: Setup,
    source: Box<dyn RunSource>,
    suites: Vec<String>,
    fit: Option<FitSettings>,
    keeps_runs: bool,
    is_certified: bool,
    resume: Option<PathBuf>,
}

impl Job {
    /// Makes a job that finds the sets of a setup for all suites of a source.
    pub fn new(setup: Setup, source: impl RunSource + 'static) -> Self {
        Self {
            setup,
            source: Box::new(source),
            suites: Vec::new(),
            fit: None,
            keeps_runs: false,
            is_certified: false,
            resume: None,
        }
    }

    /// Uses these suites only; all if none is named.
    #[must_use]
    pub fn suites<T: Into<String>>(self, names: impl IntoIterator<Item = T>) -> Self {
        Self { suites: names.into_iter().map(Into::into).collect(), ..self }
    }

    /// Fits the nominal model for small sets first.
    #[must_use]
    pub fn fit(self, fit: impl Into<Option<FitSettings>>) -> Self {
        Self { fit: fit.into(), ..self }
    }

    /// Keeps every recording in memory, for pages and figures.
    #[must_use]
    pub fn keep_runs(self, keeps_runs: bool) -> Self {
        Self { keeps_runs, ..self }
    }

    /// Asks for an answer that has a [certificate](Answer::certificate).
    #[must_use]
    pub fn certified(self, is_certified: bool) -> Self {
        Self { is_certified, ..self }
    }

    /// Keeps the progress of a long search in this file, and continues from it if it exists.
    #[must_use]
    pub fn resume(self, path: impl Into<Option<PathBuf>>) -> Self {
        Self { resume: path.into(), ..self }
    }

    /// Reads the recordings.
    ///
    /// # Errors
    ///
    /// Settings that do not fit each other or the model, all before anything is read; as
    /// [`Problem::read`].
    pub fn read(self, progress: &dyn Progress) -> Result<Problem> {
        let setup = self.setup;
        let has_points =
            setup.settings.notion.asks_points() && setup.dynamics.linear_system().is_some();
        if self.is_certified && !has_points {
            return Err(Error::NotPoints);
        }
        self.fit.iter().try_for_each(|fit| fit.check(&setup))?;
        // Friction that warms up is fitted to each run by itself.
        let by_run = self.fit.is_some_and(|fit| fit.groups.contains(&Group::WarmUp));
        let keep = if self.keeps_runs || by_run { Keep::All } else { Keep::Needed };
        Problem::read(setup, self.source, &self.suites, keep, progress)
    }

    /// Reads the recordings, fits the nominal model if that was requested, finds the smallest sets
    /// and proves them.
    ///
    /// # Guarantee
    ///
    /// As [`conform`](crate::conform).
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read) and [`Answer::new`].
    pub fn run(self, progress: &dyn Progress) -> Result<Answer> {
        let (fit, resume) = (self.fit.clone(), self.resume.clone());
        Answer::new(self.read(progress)?, fit.as_ref(), resume.as_deref(), progress)
    }
}
