//! `reachtube demo`: every step on a simulated arm.

use reachtube::arm::{ArmSettings, Basis};
use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::campaign::{CampaignOptions, RecordedCampaign, record};
use reachtube::conform::{Answer, Check, FitSettings, Group, Job, Keep, Settings, Setup, conform};
use reachtube::finding::{FrontEnd, Summary, Table};
use reachtube::page::{Assets, Sources};
use reachtube::recordings::{DataSet, Torque};
use reachtube::{Model, write};
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::Serialize;

use super::conform as conform_command;
use crate::data_arguments::DataArguments;
use crate::error::Result;
use crate::global::global;
use crate::opened::OpenedCheck;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::report_files;
use crate::virtual_robot_arguments::VirtualRobotArguments;

/// What of the nominal model is fitted.
const GROUPS: [Group; 2] = [Group::Viscous, Group::Coulomb];

/// A scenario and brakes for `verify` and `stop`, by their names in the folder.
const SAFETY: [(&str, &str); 2] = [
    ("cell.toml", include_str!("../../demo/cell.toml")),
    ("brakes.toml", include_str!("../../demo/brakes.toml")),
];

/// The weight of the pull toward the nominal values.
const PULL: f64 = 0.05;

const HELP: &str = "\
Example:
  reachtube demo --out demo
      then open demo/report/report.html in a browser";

/// Run every step on a simulated arm: record, fit, conform, calibrate, check, report
///
/// The folder receives the recordings, the model, pages, and cell.toml and brakes.toml for `verify`
/// and `stop`, which are kept where they exist.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Folder for the recordings, the model and the reports
    #[arg(long, value_name = "FOLDER", default_value = "reachtube-demo")]
    pub out: PathBuf,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    #[command(flatten)]
    pub robot: VirtualRobotArguments,
}

/// Returns the files for `verify` and `stop` that a folder lacks. A user may have changed existing
/// ones.
fn missing(folder: &Path) -> Vec<(PathBuf, &'static str)> {
    let files = SAFETY.map(|(name, text)| (folder.join(name), text));
    files.into_iter().filter(|(path, _)| !path.exists()).collect()
}

/// Runs the demo. The outcome is the model's verdict on the recordings that it was made from;
/// motions that were held out may leave its sets, which the demo shows.
pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = Robot::lwa4p();
    let folder = args.out.join("recordings");
    let path = args.out.join("model.json");
    let pages = [args.out.join("report"), args.out.join("held-out")];
    let safety = missing(&args.out);
    output::claim_all([&path].into_iter().chain(safety.iter().map(|(path, _)| path)))?;
    output::claim_all(&pages.each_ref().map(|folder| report_files::page_in(folder)))?;
    let sizes = CampaignOptions { seed: args.seed, ..CampaignOptions::demo() };
    let options = CampaignOptions { robot: args.robot.parameters()?, ..sizes };
    let bar = Progress::of("recording");
    let recorded = record(&robot, &options, &folder, &|done, total| bar.show(done, total))?;
    drop(bar);
    output::note(&format!(
        "recorded {} runs of a simulated {} in {}",
        recorded.runs,
        robot.name(),
        folder.display()
    ));
    // The sets of the nominal model, calibrated by the held-out motions.
    let settings = Settings { calibrate: recorded.calibration.clone(), ..Settings::default() };
    let arm = ArmSettings::new(Torque::Compensated, robot.joint_count());
    let bar = Progress::new();
    let nominal = Job::new(Basis::from(robot).setup(arm, settings)?, DataSet::open(&folder)?)
        .suites(&recorded.training)
        .keep_runs(true)
        .read(&bar)?;
    let before = conform(&nominal, &bar, None)?;
    // The same with a model that is fitted for small sets.
    let fit = FitSettings { groups: GROUPS.to_vec(), pull: Some(PULL) };
    let answer = Answer::new(nominal, Some(&fit), None, &bar)?;
    drop(bar);
    answer.model.save(&path)?;
    output::wrote(&path);
    for (path, text) in &safety {
        write::atomically(path, |file| file.write_all(text.as_bytes()))?;
    }
    let mut page = conform_command::page_of(&answer, FrontEnd::CommandLine)?;
    page.link_to_held_out();
    output::wrote(&report_files::write_page(&page, Assets::Inside, &pages[0])?);
    let summary = answer.summary(FrontEnd::CommandLine);
    // Try them on the motions held out.
    let Answer { model, problem, .. } = answer;
    let setup = problem.setup().clone();
    let (opened, held_out) = check_held_out(model, setup, &folder, &recorded.check, &pages[1])?;
    let model = &opened.model;
    let outcome = Outcome::of_model(model.verified, model);
    if json {
        output::print_json(&DemoOutput { nominal_cost: before.cost, model, held_out: &held_out })?;
    } else {
        let text = text(&opened, &held_out, summary, &recorded, &pages[0]);
        output::print_verdict(&text, &outcome)?;
    }
    Ok(outcome)
}

/// The result of `demo`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct DemoOutput<'a> {
    /// Cost of the sets of the model before its fit.
    nominal_cost: f64,
    /// The model.
    model: &'a Model,
    /// The check of the motions that were held out.
    held_out: &'a Check,
}

/// Returns the answer about the model, and the one about motions that were held out.
fn text(
    opened: &OpenedCheck,
    held_out: &Check,
    summary: Summary,
    recorded: &RecordedCampaign,
    page: &Path,
) -> String {
    let heading = held_out_heading(recorded);
    let model = &opened.model;
    if global().verbose {
        let report = held_out.report(&model.signals);
        return format!("{}\n{heading}\n{report}", model.report());
    }
    let model = Summary { next: None, ..summary };
    // The sets are those above.
    let tried = Summary { table: Table::default(), next: None, ..opened.summary(held_out) };
    let page = report_files::page_in(page);
    format!("{model}\n{heading}\n{tried}\nnext: open {} in a browser\n", page.display())
}

/// Checks the model on the suites held out and writes a report page about them.
fn check_held_out(
    model: Model,
    setup: Setup,
    folder: &Path,
    suites: &[String],
    page: &Path,
) -> Result<(OpenedCheck, Check)> {
    let args = DataArguments {
        data: folder.to_path_buf(),
        suites: suites.to_vec(),
        torque: Some(Torque::Compensated),
        until: None,
        max_gap: None,
    };
    let opened = OpenedCheck::with(model, setup, &args, None, Keep::All)?;
    let (check, reach) = (opened.check()?, opened.reach()?);
    let OpenedCheck { model, problem, .. } = &opened;
    let sources =
        Sources { model, problem, reach: &reach, check: &check, front_end: FrontEnd::CommandLine };
    let mut own = reachtube::page::page(&sources)?;
    own.link_to_own("report");
    output::wrote(&report_files::write_page(&own, Assets::Inside, page)?);
    Ok((opened, check))
}

fn held_out_heading(recorded: &RecordedCampaign) -> String {
    format!("Suites {} were held out and tried last:", recorded.check.join(", "))
}
