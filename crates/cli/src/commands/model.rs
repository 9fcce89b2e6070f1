//! `reachtube model`: from logs to a model, a page and a verdict.

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::conform::Group;
use reachtube::finding::{FrontEnd, Summary};
use reachtube::page::{Assets, built_pages};
use reachtube::pipeline::{Built, Choice, Choices, Error as PipelineError, build};
use reachtube::recordings::Torque;
use reachtube::robot::{Lock, Robot};
use reachtube::write;

use crate::commands::conform::GROUPS;
use crate::commands::tracking::{self, TrackingArguments};
use crate::data_arguments::TORQUES;
use crate::error::{Error, NO_ROBOT, NO_TORQUE, Result};
use crate::global::global;
use crate::lock_arguments::LockArguments;
use crate::log_files::LogArguments;
use crate::option_values::{choice, seconds};
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::{output, report_files};

/// The file in the folder that keeps the steps that are finished.
const JOURNAL: &str = "progress.json";

const HELP: &str = "\
Examples:
  reachtube model --robot arm.urdf --data logs --torque motor --out arm
      every choice is made from the logs, printed, and written to arm/choices.toml
  reachtube model --settings arm/choices.toml --out again
      the same choices give the same model
  reachtube model --data logs --out arm
      logs of commanded and actual positions: how far the arm strays from its command

If the command is killed, it continues where it was when it is run again with the same options.

Exit codes: 0 conformant and useful, 1 not proved conformant, 2 error, 3 too wide to be of use.";

/// Make a model of a robot's logs: sets, horizon, page and verdict, in one command
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long)]
    pub robot: Option<String>,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Logs: CSV and Parquet files, MCAP, rosbag2, or folders of them
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub data: Vec<PathBuf>,
    /// Meaning of the recorded torques
    #[arg(long, value_parser = choice::<Torque>(TORQUES))]
    pub torque: Option<Torque>,
    /// TOML file with choices, as this command writes it
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
    /// Time up to which the model predicts, above 0 s [default: the longest at which no set is
    /// wider than the motion]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub horizon: Option<f64>,
    /// Motions that are held out from every choice, such as M1,N* [default: every fourth]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    pub held_out: Vec<String>,
    /// Factors of the recorded torques, one per joint; for motor currents in N m/A [default: 1]
    #[arg(long, value_name = "G,..", value_delimiter = ',', allow_hyphen_values = true)]
    pub gains: Vec<f64>,
    /// Fit these parameters of the nominal model for small sets, separated by commas; takes minutes
    #[arg(long, value_name = "GROUP,..", value_delimiter = ',')]
    #[arg(value_parser = choice::<Group>(GROUPS))]
    pub fit: Vec<Group>,
    #[command(flatten)]
    pub log: LogArguments,
    /// Folder for model.json, robot.toml, choices.toml and the page
    #[arg(long, value_name = "FOLDER")]
    pub out: PathBuf,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    if args.settings.is_none() && args.torque.is_none() {
        return under_controller(args, json);
    }
    let made = Made::new(args)?;
    let outcome = made.outcome();
    if json {
        made.written.iter().for_each(|path| output::wrote(path));
        output::print_json(&made.built.to_json())?;
    } else {
        made.print(args, &outcome)?;
    }
    Ok(outcome)
}

/// Makes a model of commanded and actual positions, without torques.
fn under_controller(args: &Arguments, json: bool) -> Result<Outcome> {
    let Arguments { horizon, held_out, gains, fit, log, .. } = args;
    let is_made = !(held_out.is_empty() && gains.is_empty() && fit.is_empty());
    if horizon.is_some() || is_made || log.marker.is_some() {
        return Err(Error::setting(NO_TORQUE));
    }
    let of = TrackingArguments {
        data: &args.data,
        robot: args.robot.as_deref(),
        lock: &args.lock.lock,
        columns: log.columns.clone().unwrap_or_default(),
        log: log.settings(),
        out: &args.out,
    };
    tracking::model(&of, json)
}

/// A model with the files that were written of it.
pub(crate) struct Made {
    pub built: Built,
    written: Vec<PathBuf>,
}

impl Made {
    /// Makes a model and writes its files.
    pub(crate) fn new(args: &Arguments) -> Result<Self> {
        let choices = choices(args)?;
        let name = choices.robot.clone().ok_or_else(|| Error::setting(NO_ROBOT))?;
        let lock: Vec<Lock> =
            choices.lock.iter().map(|lock| lock.parse()).collect::<Result<_, _>>()?;
        let (robot, impossible) = Robot::load_to_identify(&name, &lock)?;
        let torque = choices.torque.ok_or_else(|| Error::setting(NO_TORQUE))?;
        if choices.data.is_empty() {
            return Err(Error::setting(
                "no recordings are given; name some with --data, or with data = [..] in the \
                 settings file",
            ));
        }
        let files = ["model.json", "robot.toml", "choices.toml"].map(|file| args.out.join(file));
        output::claim_all(&files)?;
        let pages = ["page", "held-out"].map(|folder| args.out.join(folder));
        output::claim_all(&pages.map(|folder| report_files::page_in(&folder)))?;
        let bar = Progress::of("making a model");
        let mut say = |choice: &Choice| {
            bar.note(&format!("{}: {} ({})", choice.key, choice.value, choice.reason));
        };
        let journal = args.out.join(JOURNAL);
        let built = build(&robot, torque, &choices, Some(&journal), &mut say, &bar);
        drop(bar);
        let built = built.map_err(|error| {
            // A model that was made says it among its findings.
            impossible.iter().for_each(|warning| output::warn(warning));
            forget(&journal);
            in_settings(error, args)
        })?;
        let built = built.among_others(&args.out.join("model.json"));
        output::notes(&built.notes);
        let mut written = Vec::new();
        for (name, text) in built.files() {
            let path = args.out.join(name);
            write::atomically(&path, |out| out.write_all(text.as_bytes()))?;
            written.push(path);
        }
        for (folder, page) in built_pages(&built)? {
            let folder = args.out.join(folder);
            written.push(report_files::write_page(&page, Assets::Inside, &folder)?);
        }
        forget(&journal);
        Ok(Self { built, written })
    }

    pub(crate) fn outcome(&self) -> Outcome {
        match self.built.answer.holds() {
            false => Outcome::NotConformant,
            true if self.built.is_useful() => Outcome::Done,
            true => Outcome::Vacuous,
        }
    }

    /// Prints the answer on a few lines, or as a whole if the user asks for it.
    pub(crate) fn print(&self, args: &Arguments, outcome: &Outcome) -> Result<()> {
        let mut text = summary(&self.built, &self.written, args).to_string();
        if global().verbose {
            text += &format!("\n{}", self.built.answer.report());
        }
        output::print_verdict(&text, outcome)
    }
}

/// Names the settings file in an error of a choice that it makes.
fn in_settings(error: PipelineError, args: &Arguments) -> PipelineError {
    let is_option = |key: &str| match key {
        "fit" => !args.fit.is_empty(),
        "horizon" => args.horizon.is_some(),
        _ => false,
    };
    match (&args.settings, &error) {
        (Some(path), PipelineError::Choice { key, .. }) if !is_option(key) => {
            PipelineError::Settings { path: path.clone(), message: error.to_string() }
        }
        _ => error,
    }
}

/// Removes the journal: the job is done, or refused.
fn forget(journal: &Path) {
    // A journal that stays is replaced by the next job.
    let _ = std::fs::remove_file(journal);
}

/// Returns the choices of the settings file and the command line, with paths from the working
/// directory.
fn choices(args: &Arguments) -> Result<Choices> {
    let of_file = args.settings.as_deref().map(Choices::load).transpose()?.unwrap_or_default();
    Ok(of_file.replaced_by(Choices {
        robot: args.robot.clone(),
        data: args.data.clone(),
        torque: args.torque,
        horizon: args.horizon,
        held_out: (!args.held_out.is_empty()).then(|| args.held_out.clone()),
        gains: args.gains.clone(),
        lock: args.lock.lock.iter().map(ToString::to_string).collect(),
        columns: args.log.columns.clone().unwrap_or_default(),
        log: args.log.settings(),
        fit: (!args.fit.is_empty()).then(|| args.fit.clone()),
        ..Choices::default()
    }))
}

/// Returns the answer on a few lines, with the files that were written.
fn summary(built: &Built, written: &[PathBuf], args: &Arguments) -> Summary {
    let mut summary = built.summary(FrontEnd::CommandLine);
    let inside =
        |path: &PathBuf| path.strip_prefix(&args.out).unwrap_or(path).display().to_string();
    let names: Vec<String> = written.iter().map(inside).collect();
    summary.fact(format!("wrote to {}", args.out.display()), names.join(", "));
    summary.next = Some(match built.is_useful() {
        true => format!("open {}", report_files::page_in(&args.out.join("page")).display()),
        false => {
            let choices = args.out.join("choices.toml").display().to_string();
            match built.remedies.iter().any(|finding| finding.remedy.is_some()) {
                _ if built.is_contradicted() => "correct what the first line names".into(),
                true => format!(
                    "change {choices} so, then `reachtube model --settings {choices} --out FOLDER`"
                ),
                false => format!("read {choices}"),
            }
        }
    });
    summary
}
