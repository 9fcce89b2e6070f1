//! `reachtube demo`: every step on a simulated arm.

use std::path::{Path, PathBuf};

use clap::Args;
use reachtube::conform::{Check, Settings, Watch, conform};
use reachtube::demo::{DemoOptions, RecordedDemo, record};
use reachtube::recordings::{DataSet, Torque};
use reachtube::{Model, write};
use reachtube_robot::Robot;
use serde_json::json;

use super::{check, conform};
use crate::data_arguments::DataArguments;
use crate::error::Result;
use crate::opened::Opened;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::report_files;

const HELP: &str = "\
Example:
  reachtube demo --out demo
      then open demo/report/report.html in a browser";

/// Run every step on a simulated arm: record, conform, check, report
///
/// The folder receives the recordings, the model and two report pages: one on the recordings that
/// the model was made from, one on motions that were held out.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct Arguments {
    /// Folder for the recordings, the model and the reports
    #[arg(long, value_name = "FOLDER", default_value = "reachtube-demo")]
    pub out: PathBuf,
    /// Seed of the random numbers; the same seed gives the same recordings
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// Runs the demo. The outcome is the model's verdict on the recordings that it was made from;
/// motions that were held out may leave its sets, which the demo shows.
pub fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = Robot::lwa4p();
    let folder = args.out.join("recordings");
    let options = DemoOptions { seed: args.seed, ..DemoOptions::default() };
    let bar = Progress::new();
    let recorded = record(&robot, &options, &folder)?;
    drop(bar);
    output::note(&format!(
        "recorded {} runs of a simulated {} in {}",
        recorded.runs,
        robot.name(),
        folder.display()
    ));
    let model = fit(&robot, &folder, &recorded)?;
    let path = args.out.join("model.json");
    write::atomically(&path, |out| out.write_all(model.to_json().as_bytes()))?;
    output::wrote(&path);
    page(&model, &robot, &folder, &recorded.training, &args.out.join("report"))?;
    let held_out = page(&model, &robot, &folder, &recorded.check, &args.out.join("held-out"))?;
    if json {
        output::print_json(&json!({ "model": model, "held_out": held_out }))?;
    } else {
        let text = format!(
            "{}\n{}\n{}",
            conform::summary(&model),
            held_out_heading(&recorded),
            check::summary(&held_out)
        );
        output::print(&text)?;
    }
    Ok(Outcome::of(model.verified))
}

/// Finds the smallest uncertainty sets for the training suites.
fn fit(robot: &Robot, folder: &Path, recorded: &RecordedDemo) -> Result<Model> {
    let settings = Settings::new(Torque::Compensated, robot.joint_count());
    let data = DataSet::open(folder)?;
    let bar = Progress::new();
    let show = |done: usize, total: usize| bar.show(done, total);
    let watch = Watch { reading: &show, ..Watch::SILENT };
    let found = conform(robot, &data, &recorded.training, &settings, &watch)?;
    Ok(Model::new(robot, &data, &settings, &found))
}

/// Checks the model on some suites and writes a report page about them.
fn page(
    model: &Model,
    robot: &Robot,
    folder: &Path,
    suites: &[String],
    to: &Path,
) -> Result<Check> {
    let args = DataArguments {
        data: folder.to_path_buf(),
        suites: suites.to_vec(),
        torque: Torque::Compensated,
        until: None,
        max_gap: None,
    };
    let opened = Opened::with(model.clone(), robot.clone(), &args)?;
    let (page, _) = report_files::write(&opened, to)?;
    output::wrote(&page);
    opened.check()
}

fn held_out_heading(recorded: &RecordedDemo) -> String {
    format!(
        "Suites {} were held out. The smallest sets that enclose some recordings need not enclose \
         the next motion:",
        recorded.check.join(", ")
    )
}
