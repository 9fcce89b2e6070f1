//! One module a command.

mod r#abstract;
mod check;
mod conform;
mod demo;
mod excite;
mod files;
mod identify;
mod inspect;
mod prepare;
mod reach;
mod report;
mod reproduce;
mod robot;

use reachtube::conform::{Check, Recordings, Settings, check as check_recordings};
use reachtube::conform::{SuiteReach, reach as reach_suites};
use reachtube::recordings::DataSet;
use reachtube::report::Sources;
use reachtube::{Model, Result};
use reachtube_robot::Robot;

use crate::args::{Cli, Command, DataArgs, ModelArgs, ReproduceCommand, RobotCommand, gap_limit};
use crate::output;
use crate::progress::Progress;

/// What a command came to when it did not fail.
pub enum Outcome {
    /// Done; where there is a verdict, it is conformant.
    Done,
    /// Not conformant.
    NotConformant,
}

impl Outcome {
    fn of(conformant: bool) -> Self {
        if conformant { Self::Done } else { Self::NotConformant }
    }
}

/// Runs the command asked for.
pub fn run(cli: &Cli) -> Result<Outcome> {
    match &cli.command {
        Command::Demo(args) => demo::run(args, cli.json),
        Command::Robot(RobotCommand::Show(args)) => robot::show(args, cli.json),
        Command::Identify(args) => identify::run(args, cli.json),
        Command::Inspect(args) => inspect::run(args, cli.json),
        Command::Abstract(args) => r#abstract::run(args, cli.json),
        Command::Excite(args) => excite::run(args, cli.json),
        Command::Prepare(args) => prepare::run(args, cli.json),
        Command::Conform(args) => conform::run(args, cli.json),
        Command::Check(args) => check::run(args, cli.json),
        Command::Reach(args) => reach::run(args, cli.json),
        Command::Report(args) => report::run(args, cli.json),
        Command::Reproduce(ReproduceCommand::Table1(args)) => reproduce::table1(args, cli.json),
    }
}

/// A model, and recordings read with its settings.
struct Opened {
    model: Model,
    robot: Robot,
    settings: Settings,
    data: DataSet,
    suites: Vec<String>,
}

impl Opened {
    fn new(args: &ModelArgs) -> Result<Self> {
        let model = Model::load(&args.model)?;
        let robot = model.robot()?;
        Self::with(model, robot, &args.data)
    }

    fn with(model: Model, robot: Robot, args: &DataArgs) -> Result<Self> {
        if let (None, Some(until)) = (args.until, model.settings.until) {
            output::note(&format!(
                "samples later than {until} s after the first are not used, as in the fit; --until changes that"
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

    fn check(&self) -> Result<Check> {
        let bar = Progress::new();
        let show = |done: usize, total: usize| bar.show(done, total);
        Ok(check_recordings(&self.model, &self.data, &self.suites, &self.settings, &show)?)
    }

    fn recordings(&self) -> Result<Recordings> {
        let bar = Progress::new();
        let show = |done: usize, total: usize| bar.show(done, total);
        Ok(Recordings::read(&self.data, &self.suites, &self.robot, &self.settings, &show)?)
    }

    fn reach(&self, recordings: &Recordings) -> Result<Vec<SuiteReach>> {
        let _bar = Progress::new();
        let Self { model, robot, settings, data, .. } = self;
        Ok(reach_suites(data, robot, settings, &model.dynamics()?, &model.sets(), recordings)?)
    }

    /// What the page is made from.
    fn sources<'a>(
        &'a self,
        recordings: &'a Recordings,
        reach: &'a [SuiteReach],
        check: &'a Check,
    ) -> Sources<'a> {
        let Self { model, settings, data, .. } = self;
        Sources { model, settings, data, recordings, reach, check }
    }
}
