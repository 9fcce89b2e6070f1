//! A model and the recordings it is compared with.

use reachtube::Model;
use reachtube::conform::{Check, Recordings, Settings, check as check_recordings};
use reachtube::conform::{SuiteReach, reach as reach_suites};
use reachtube::recordings::DataSet;
use reachtube::report::Sources;
use reachtube_robot::Robot;

use crate::data_arguments::{DataArguments, ModelArguments, gap_limit};
use crate::error::Result;
use crate::output;
use crate::progress::Progress;

/// A model, and the data set that is read with its settings.
pub struct Opened {
    pub model: Model,
    robot: Robot,
    settings: Settings,
    data: DataSet,
    suites: Vec<String>,
}

impl Opened {
    /// Opens the model file and the data set.
    pub fn new(args: &ModelArguments) -> Result<Self> {
        let model = Model::load(&args.model)?;
        let robot = model.robot()?;
        Self::with(model, robot, &args.data)
    }

    /// Opens the data set for a model in memory.
    pub fn with(model: Model, robot: Robot, args: &DataArguments) -> Result<Self> {
        if let (None, Some(until)) = (args.until, model.settings.until) {
            output::note(&format!(
                "samples later than {until} s after the first are not used, as when the sets were \
                 found; --until changes the limit"
            ));
        }
        let settings = Settings {
            torque: args.torque,
            until: args.until.or(model.settings.until),
            gap_limit: gap_limit(args.max_gap),
            ..model.settings.clone()
        };
        settings.validate(robot.joint_count())?;
        let data = DataSet::open(&args.data)?;
        Ok(Self { model, robot, settings, data, suites: args.suites.clone() })
    }

    /// Checks the recordings against the model.
    pub fn check(&self) -> Result<Check> {
        let bar = Progress::new();
        let show = |done: usize, total: usize| bar.show(done, total);
        Ok(check_recordings(&self.model, &self.data, &self.suites, &self.settings, &show)?)
    }

    /// Reads the recordings.
    pub fn recordings(&self) -> Result<Recordings> {
        let bar = Progress::new();
        let show = |done: usize, total: usize| bar.show(done, total);
        Ok(Recordings::read(&self.data, &self.suites, &self.robot, &self.settings, &show)?)
    }

    /// Computes the reachable set of each suite.
    pub fn reach(&self, recordings: &Recordings) -> Result<Vec<SuiteReach>> {
        let _bar = Progress::new();
        let Self { model, robot, settings, data, .. } = self;
        Ok(reach_suites(data, robot, settings, &model.dynamics()?, &model.sets(), recordings)?)
    }

    /// Returns the parts that the report page is made from.
    pub fn sources<'a>(
        &'a self,
        recordings: &'a Recordings,
        reach: &'a [SuiteReach],
        check: &'a Check,
    ) -> Sources<'a> {
        let Self { model, settings, data, .. } = self;
        Sources { model, settings, data, recordings, reach, check }
    }
}
