//! A conformance from recordings to an answer, as every front end poses it.

use std::borrow::Cow;
use std::path::PathBuf;

use reachtube_abstraction::PolynomialModel;
use reachtube_recordings::{RunSource, Torque};
use reachtube_robot::Robot;

use crate::answer::Answer;
use crate::data::notion::Notion;
use crate::data::problem::{Keep, Problem};
use crate::data::settings::Settings;
use crate::data::setup::Setup;
use crate::error::{Error, Result};
use crate::fit::group::{FitSettings, Group};
use crate::progress::Progress;

/// What the nominal model is made of.
#[derive(Debug, Clone)]
pub enum Basis {
    /// A robot, whose model the settings select.
    Robot(Box<Robot>),
    /// A model of a robot, with its own expansion point and order.
    Abstraction(Box<PolynomialModel>),
}

/// A conformance to compute: a robot, recordings and settings. It passes data between the steps, so
/// that every front end runs the same job in the same way.
///
/// # Examples
///
/// ```
/// use reachtube_conform::{Job, Silent};
/// use reachtube_recordings::{MemoryRuns, Run, Torque};
/// use reachtube_robot::Robot;
///
/// // An arm at rest.
/// let times = vec![0.0, 0.004, 0.008];
/// let run = Run::new(6, times, vec![0.0; 36], vec![0.0; 18])?;
/// let mut runs = MemoryRuns::default();
/// runs.push("rest", Some("A"), None, run);
///
/// let answer = Job::new(Robot::lwa4p(), runs, Torque::Compensated).suites(["A"]).run(&Silent)?;
/// assert!(answer.holds());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Job {
    basis: Basis,
    source: Box<dyn RunSource>,
    suites: Vec<String>,
    settings: Settings,
    fit: Option<FitSettings>,
    keeps_runs: bool,
    is_certified: bool,
    resume: Option<PathBuf>,
}

impl From<Robot> for Basis {
    fn from(robot: Robot) -> Self {
        Self::Robot(Box::new(robot))
    }
}

impl From<PolynomialModel> for Basis {
    fn from(model: PolynomialModel) -> Self {
        Self::Abstraction(Box::new(model))
    }
}

impl Basis {
    /// Returns the number of joints n.
    #[must_use]
    pub fn joints(&self) -> usize {
        match self {
            Self::Robot(robot) => robot.joint_count(),
            Self::Abstraction(model) => model.joints(),
        }
    }

    /// Returns the robot.
    ///
    /// # Errors
    ///
    /// A description in the file of an abstraction that is none.
    pub fn robot(&self) -> Result<Cow<'_, Robot>> {
        Ok(match self {
            Self::Robot(robot) => Cow::Borrowed(robot),
            Self::Abstraction(model) => Cow::Owned(Robot::from_description(model.robot())?),
        })
    }

    /// Makes the setup of a conformance.
    ///
    /// # Errors
    ///
    /// As [`Setup::new`]; an abstraction that does not fit the settings; a robot that is not
    /// physical.
    pub fn setup(self, settings: Settings) -> Result<Setup> {
        match self {
            Self::Robot(robot) => {
                robot.check_physical()?;
                Setup::new(*robot, settings)
            }
            Self::Abstraction(model) => {
                let setup = Setup::with_abstraction(*model, settings)?;
                setup.robot().check_physical()?;
                Ok(setup)
            }
        }
    }
}

impl Job {
    /// Makes a job with default settings: a linear model, the notion hull, all suites.
    pub fn new(basis: impl Into<Basis>, source: impl RunSource + 'static, torque: Torque) -> Self {
        let basis = basis.into();
        Self {
            settings: Settings::new(torque, basis.joints()),
            basis,
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

    /// Replaces all settings.
    #[must_use]
    pub fn settings(self, settings: Settings) -> Self {
        Self { settings, ..self }
    }

    /// Chooses in which directions recordings must lie in the reachable set.
    #[must_use]
    pub fn notion(mut self, notion: Notion) -> Self {
        self.settings.notion = notion;
        self
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
    /// Settings that do not fit each other, the robot or the model, all before anything is read; as
    /// [`Problem::read`].
    pub fn read(self, progress: &dyn Progress) -> Result<Problem> {
        let setup = self.basis.setup(self.settings)?;
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
