use reachtube::identify::prepare::{
    LogEntry, PrepareSettings, RawLog, cut_off, prepare, read, windows,
};
use reachtube::{Result, write};
use reachtube_robot::Robot;
use serde_json::json;

use super::Outcome;
use crate::args::PrepareArgs;
use crate::output;

pub fn run(args: &PrepareArgs, json: bool) -> Result<Outcome> {
    let robot = Robot::load(&args.robot)?;
    let settings = PrepareSettings {
        gains: args.gains.clone(),
        joints: args.joints.clone(),
        cut_off: args.cut_off,
        max_gap: args.max_gap,
        ..PrepareSettings::default()
    };
    write::try_at(&args.out.join("runs.csv"))?;
    let entries: Vec<LogEntry> = args.logs.iter().cloned().map(LogEntry::from).collect();
    let raw = read(&entries, std::path::Path::new(""), &robot, &settings)?;
    let cut_off = cut_off(&raw.iter().collect::<Vec<&RawLog>>(), &settings)?;
    let prepared = prepare(&raw, &settings, cut_off)?;
    let cut = windows(&prepared.logs, args.window, args.repeats);
    cut.write(&args.out)?;
    output::notes(&[prepared.changes, cut.changes].concat());
    output::note(&format!(
        "wrote {} recordings and runs.csv into {}",
        cut.windows.len(),
        args.out.display()
    ));
    if json {
        output::print_json(&json!({ "cut_off": cut_off, "recordings": cut.windows.len() }))?;
    }
    Ok(Outcome::Done)
}
