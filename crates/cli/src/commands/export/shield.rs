//! `reachtube export --to sara-shield`.

use reachtube::arm::ArmModel;
use reachtube::conform::SuiteReach;
use reachtube::finding::Table;
use reachtube::pipeline::{followed, robot_of};
use reachtube::tracking::{Plan, TrackingModel};
use std::path::{Path, PathBuf};

use reachtube::Robot;
use reachtube::export::shield::{LinkMargin, Shield, ShieldFile};
use reachtube::number::at_least;
use reachtube::verify::Capsules;
use reachtube::write;
use reachtube_files::SealedFile;
use schemars::JsonSchema;
use serde::Serialize;

use super::arguments::{Arguments, model_file, open, write_all};
use crate::commands::tracking::print_conditions;
use crate::error::{Error, Result};
use crate::outcome::Outcome;
use crate::output;

/// Writes what the shield reads of a model over recordings.
pub(super) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    write::try_at(&args.out.join("robot_parameters.yaml"))?;
    let updates = args.update.iter().map(|path| read(path)).collect::<Result<Vec<_>>>()?;
    let (robot, reached) = motions(args)?;
    let named = Capsules::open(args.capsules.as_deref(), &robot);
    let capsules = match (&args.capsules, updates.is_empty()) {
        // The shield's own file may have the capsules.
        (None, false) => named.ok(),
        _ => Some(named?),
    };
    let shield = Shield::new(&robot, capsules.as_ref(), &reached, &updates)?;
    let paths: Vec<PathBuf> = shield.files.iter().map(|file| args.out.join(&file.name)).collect();
    write_all(&paths, shield.files.iter())?;
    if shield.secure_radius > shield.largest_capsule {
        output::warn(&format!(
            "a link may be {} m from its nominal motion, more than the radius of any capsule; \
             --until with the time over which the shield looks ahead gives a smaller secure radius",
            at_least(shield.secure_radius)
        ));
    }
    output::show(json, &ShieldExport::new(&shield, &paths), || text(&shield, &paths))?;
    Ok(Outcome::Done)
}

/// Returns the robot, and its reachable sets: over recordings, or over plans that the arm follows
/// under its controller.
fn motions(args: &Arguments) -> Result<(Robot, Vec<SuiteReach>)> {
    let path = model_file(args)?;
    if !TrackingModel::is_at(path) {
        let opened = open(args, "the SaRA shield")?;
        return Ok((Robot::from_description(&opened.model.robot())?, opened.reach()?));
    }
    let model = TrackingModel::open(path)?;
    let (Some(robot), Some(plans)) = (&args.robot, &args.data) else {
        return Err(Error::setting(
            "the model is of an arm under its controller; give the robot with --robot and its \
             plans with --data",
        ));
    };
    let (plans, notes) = Plan::read(plans, &model, args.until)?;
    output::notes(&notes);
    let reached = plans.iter().map(|plan| followed(&model, plan)).collect::<Result<_, _>>()?;
    print_conditions(&model);
    Ok((robot_of(&model, robot)?, reached))
}

fn read(path: &Path) -> Result<ShieldFile> {
    let text = reachtube_files::read_text(path, "name a YAML file of the shield with --update")?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(ShieldFile { name, text })
}

/// The result of `export --to sara-shield`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ShieldExport<'a> {
    /// The tool.
    tool: &'static str,
    /// How far a link can be from its nominal motion, m; rounded up.
    secure_radius: f64,
    /// The margin of each link.
    margins: &'a [LinkMargin],
    /// Greatest speed of each joint that was covered, rad/s.
    velocity: &'a [f64],
    /// Greatest acceleration of each joint that was covered, rad/s².
    acceleration: &'a [f64],
    /// Paths of the files.
    files: Vec<String>,
}

impl<'a> ShieldExport<'a> {
    fn new(shield: &'a Shield, paths: &[PathBuf]) -> Self {
        Self {
            tool: "SaRA shield",
            secure_radius: shield.secure_radius,
            margins: &shield.margins,
            velocity: &shield.covered.velocity,
            acceleration: &shield.covered.acceleration,
            files: paths.iter().map(|path| path.display().to_string()).collect(),
        }
    }
}

fn text(shield: &Shield, paths: &[PathBuf]) -> String {
    let row = |margin: &LinkMargin| {
        let time = format!("{:.3}", margin.time);
        vec![margin.joint.clone(), at_least(margin.distance), margin.case.clone(), time]
    };
    let rows = shield.margins.iter().map(row).collect();
    let paths: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
    format!(
        "exported to the SaRA shield: secure_radius {} m is proved\n{}  {}\n",
        at_least(shield.secure_radius),
        Table::new(["link of", "margin [m]", "motion", "at [s]"], rows),
        paths.join("\n  ")
    )
}
