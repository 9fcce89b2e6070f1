//! A conformance over windows, as every step of the pipeline uses it.

use reachtube_abstraction::ExpansionPoint;
use reachtube_arm::{ArmSettings, Basis, Equations};
use reachtube_conform::settings::NominalStart;
use reachtube_conform::{Answer, FitSettings, Job, Noise, Problem, Progress, Settings};
use reachtube_files::hex;
use reachtube_recordings::{MemoryRuns, RunSource, Torque};
use reachtube_robot::Robot;
use reachtube_scalar::number::counted;
use sha2::{Digest, Sha256};

use crate::error::Result;
use crate::fold::Fold;
use crate::steps::Steps;

/// What a conformance over windows needs besides the windows.
#[derive(Clone)]
pub(crate) struct Trial<'a> {
    /// The robot, whose own equations the nominal motions may satisfy.
    pub robot: Robot,
    /// What the recorded torques are.
    pub torque: Torque,
    /// The position about which deviations are linear, n, rad.
    pub expansion: Vec<f64>,
    /// Radii of the sensors' noise, 2n, rad and rad/s.
    pub sensor_noise: Vec<f64>,
    /// Whose equations of motion nominal motions satisfy.
    pub equations: Equations,
    /// Where nominal motions start.
    pub nominal: NominalStart,
    /// The accelerations of nominal motions at which U is twice what it is at rest, n, rad/s², if
    /// it grows with them.
    pub input_doubling: Option<Vec<f64>>,
    /// Radii added to X0 and U, 3n, if it is given.
    pub allowance: Option<Vec<f64>>,
    /// The part of the rows of motions left out that may leave the sets without an allowance, and
    /// the factor that one of them may need.
    pub largest_outside: f64,
    pub largest_growth: f64,
    /// Robots that were identified without some motions, which these are compared with.
    pub folds: &'a [Fold],
    /// What is fitted.
    pub fit: Option<FitSettings>,
    /// Who may cancel the job.
    pub progress: &'a dyn Progress,
    /// The steps that are finished.
    pub journal: &'a Steps<'a>,
}

/// An observer of a job of many trials, who cancels each of them and counts none. The parts of a
/// fit, which takes long, are reported.
pub(crate) struct TrialProgress<'a> {
    job: &'a dyn Progress,
    is_fit: bool,
    /// The motion that is left out.
    without: Option<&'a str>,
}

impl Progress for TrialProgress<'_> {
    fn finished(&self, what: &str) {
        match self.without {
            Some(motion) if self.is_fit => self.job.finished(&format!("without {motion}: {what}")),
            None if self.is_fit => self.job.finished(what),
            _ => {}
        }
    }

    fn is_cancelled(&self) -> bool {
        self.job.is_cancelled()
    }
}

impl Trial<'_> {
    /// Returns what differs between the trials of a job, in words.
    pub(crate) fn name(&self) -> String {
        let Self { robot, equations, expansion, fit, allowance, input_doubling, .. } = self;
        let robot = serde_json::to_string(robot.description());
        let robot = hex(&Sha256::digest(robot.expect("the keys of a description are strings")));
        format!(
            "{equations:?} about {expansion:?}, {fit:?}, {allowance:?}, {input_doubling:?}, robot \
             {robot}"
        )
    }

    /// Returns the observer of one of the trials; `without` names a motion that it does not see.
    pub(crate) fn observer<'a>(&'a self, without: Option<&'a str>) -> TrialProgress<'a> {
        TrialProgress { job: self.progress, is_fit: self.fit.is_some(), without }
    }

    /// Returns the trial of several horizons. With the horizon, an allowance is given for that one
    /// alone, and the others have what they ask for.
    pub(crate) fn of_horizons(&self, given: Option<f64>) -> Self {
        let allowance = self.allowance.clone().filter(|_| given.is_none());
        Self { allowance, ..self.clone() }
    }

    /// Finds the sets for windows.
    ///
    /// # Errors
    ///
    /// As [`Job::run`].
    pub(crate) fn run(&self, windows: MemoryRuns) -> Result<Answer> {
        Ok(self.job(windows)?.run(&self.observer(None))?)
    }

    /// Does what [`run`](Self::run) does for windows of `horizon` \[s\], and reports a fit.
    ///
    /// # Errors
    ///
    /// As [`run`](Self::run).
    pub(crate) fn run_over(&self, horizon: f64, windows: MemoryRuns) -> Result<Answer> {
        if self.fit.is_some() {
            let count = counted(windows.runs().len(), "window");
            self.progress.finished(&format!("fitting over {horizon} s, {count}"));
        }
        self.run(windows)
    }

    /// Reads windows.
    ///
    /// # Errors
    ///
    /// As [`Job::read`].
    pub(crate) fn read(&self, windows: MemoryRuns) -> Result<Problem> {
        Ok(self.job(windows)?.read(&self.observer(None))?)
    }

    fn job(&self, windows: MemoryRuns) -> Result<Job> {
        let n = self.robot.joint_count();
        let settings = Settings {
            noise: Noise::Fitted,
            sensor_noise: Some(self.sensor_noise.clone()),
            input_doubling: self.input_doubling.clone(),
            nominal: self.nominal,
            ..Settings::default()
        };
        let arm = ArmSettings {
            expansion_point: ExpansionPoint::from_values(&self.expansion, n)?,
            equations: self.equations,
            ..ArmSettings::new(Torque::Compensated, n)
        };
        let robot = match self.torque {
            Torque::Link => self.robot.without_motors(),
            Torque::Motor | Torque::Compensated => self.robot.clone(),
        };
        let setup = Basis::from(robot).setup(arm, settings)?;
        Ok(Job::new(setup, windows).fit(self.fit.clone()))
    }
}
