use std::path::Path;

use reachtube::conform::{Check, Settings, Watch, conform};
use reachtube::demo::{DemoOptions, RecordedDemo, record};
use reachtube::recordings::{DataSet, Torque};
use reachtube::{Model, Result, write};
use reachtube_robot::Robot;
use serde_json::json;

use super::{Opened, Outcome, report};
use crate::args::{DataArgs, DemoArgs};
use crate::progress::Progress;
use crate::{output, words};

/// The whole job on a virtual arm. Its outcome is that of the model on the recordings it was made
/// from; that motions held out leave its sets is part of what the demo shows.
pub fn run(args: &DemoArgs, json: bool) -> Result<Outcome> {
    let robot = Robot::lwa4p();
    let folder = args.out.join("recordings");
    let options = DemoOptions { seed: args.seed, ..DemoOptions::default() };
    let bar = Progress::new();
    let recorded = record(&robot, &options, &folder)?;
    drop(bar);
    output::note(&format!(
        "recorded {} runs of a virtual {} in {}",
        recorded.runs,
        robot.name(),
        folder.display()
    ));
    let model = identify(&robot, &folder, &recorded)?;
    let path = args.out.join("model.json");
    write::atomically(&path, |out| out.write_all(model.to_json().as_bytes()))?;
    output::note(&format!("wrote {}", path.display()));
    page(&model, &robot, &folder, &recorded.training, &args.out.join("report"))?;
    let held_out = page(&model, &robot, &folder, &recorded.check, &args.out.join("held-out"))?;
    if json {
        output::print_json(&json!({ "model": model, "held_out": held_out }))?;
    } else {
        let words = format!(
            "{}\n{}\n{}",
            words::model(&model),
            held_out_words(&recorded),
            words::check(&held_out)
        );
        output::print(&words)?;
    }
    Ok(Outcome::of(model.verified))
}

fn identify(robot: &Robot, folder: &Path, recorded: &RecordedDemo) -> Result<Model> {
    let settings = Settings::new(Torque::Compensated, robot.joint_count());
    let data = DataSet::open(folder)?;
    let bar = Progress::new();
    let show = |done: usize, total: usize| bar.show(done, total);
    let watch = Watch { reading: &show, ..Watch::SILENT };
    let found = conform(robot, &data, &recorded.training, &settings, &watch)?;
    Ok(Model::new(robot, &data, &settings, &found))
}

/// Checks the model on some suites and writes the page about them.
fn page(
    model: &Model,
    robot: &Robot,
    folder: &Path,
    suites: &[String],
    to: &Path,
) -> Result<Check> {
    let args = DataArgs {
        data: folder.to_path_buf(),
        suites: suites.to_vec(),
        torque: Torque::Compensated,
        until: None,
        max_gap: None,
    };
    let opened = Opened::with(model.clone(), robot.clone(), &args)?;
    let (page, _) = report::write(&opened, to)?;
    output::note(&format!("wrote {}", page.display()));
    opened.check()
}

fn held_out_words(recorded: &RecordedDemo) -> String {
    format!(
        "Suites {} were held out. Sets that just enclose the recordings they were made from need not enclose the next motion:",
        recorded.check.join(", ")
    )
}
