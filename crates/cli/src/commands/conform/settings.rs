//! The settings of `conform` from its arguments.

use reachtube::abstraction::{Abstraction, PolynomialModel};
use reachtube::conform::{Basis, Settings};
use reachtube_robot::Robot;

use super::arguments::Arguments;
use crate::error::{Error, NO_TORQUE, Result};
use crate::expansion::expansion_point;

/// Returns the robot, or the model in the file that `--abstraction` names.
pub(super) fn basis(args: &Arguments) -> Result<Basis> {
    Ok(match &args.abstraction {
        None => args.lock.load(args.robot.as_deref().unwrap_or_default())?.into(),
        Some(path) => PolynomialModel::load(path)?.into(),
    })
}

pub(super) fn settings(args: &Arguments, robot: &Robot) -> Result<Settings> {
    let joints = robot.joint_count();
    let usual = Settings {
        abstraction: Abstraction { model: args.paper_model, order: args.order },
        expansion_point: expansion_point(&args.expansion, robot)?,
        until: args.data.until,
        gap_limit: args.data.max_gap.into(),
        ..Settings::new(args.data.torque.ok_or_else(|| Error::setting(NO_TORQUE))?, joints)
    };
    let settings = args.sets.settings(usual, joints)?;
    settings.validate(joints)?;
    Ok(settings)
}
