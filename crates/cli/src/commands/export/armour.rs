//! `reachtube export --to armour`.

use std::path::PathBuf;

use reachtube::export::armour::{Armour, ArmourSettings};
use reachtube::number::interval;
use reachtube::verify::Capsules;
use reachtube::write;
use serde_json::json;

use super::arguments::{Arguments, load_robot, write_all};
use crate::error::Result;
use crate::outcome::Outcome;
use crate::output;

/// Writes what the planner reads of a robot.
pub(super) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    write::try_at(&args.out.join("RobotInfo.h"))?;
    let robot = load_robot(args)?;
    let capsules = Capsules::open(args.capsules.as_deref(), &robot)?;
    let settings = ArmourSettings {
        uncertainty: args.uncertainty.unwrap_or_default(),
        torque_limits: args.torque_limits.clone(),
    };
    let armour = Armour::new(&robot, &capsules, &settings)?;
    if !robot.warms_by().is_empty() {
        output::warn("The bounds of friction hold at the reference of its law of warming only.");
    }
    let paths: Vec<PathBuf> = armour.files.iter().map(|file| args.out.join(&file.name)).collect();
    write_all(&paths, armour.files.iter())?;
    let names: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
    let [least, largest] = armour.mass_matrix;
    let result = json!({
        "tool": "ARMOUR",
        "robot": robot.name(),
        "uncertainty": settings.uncertainty,
        "mass_matrix": [least, largest],
        "friction": armour.friction,
        "files": names,
    });
    let text = || {
        format!(
            "exported {} to ARMOUR: the eigenvalues of the mass matrix are proved to lie in {} \
             kg m^2, for every arm within a ratio of {}\n  {}\n",
            robot.name(),
            interval((least, largest)),
            settings.uncertainty,
            names.join("\n  ")
        )
    };
    output::show(json, &result, text)?;
    Ok(Outcome::Done)
}
