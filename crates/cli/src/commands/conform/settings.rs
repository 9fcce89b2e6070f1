//! The settings of `conform` from its arguments.

use reachtube::abstraction::{Abstraction, PolynomialModel};
use reachtube::arm::{ArmSettings, Basis};
use reachtube::conform::Settings;
use reachtube_robot::Robot;

use super::arguments::Arguments;
use crate::error::{Error, NO_TORQUE, Result};
use crate::expansion::expansion_point;

pub(super) fn basis(args: &Arguments) -> Result<Basis> {
    Ok(match &args.abstraction {
        None => args.lock.load(args.robot.as_deref().unwrap_or_default())?.into(),
        Some(path) => PolynomialModel::load(path)?.into(),
    })
}

pub(super) fn settings(args: &Arguments, robot: &Robot) -> Result<(ArmSettings, Settings)> {
    let joints = robot.joint_count();
    let arm = ArmSettings {
        torque: args.data.torque.ok_or_else(|| Error::setting(NO_TORQUE))?,
        abstraction: Abstraction { model: args.paper_model, order: args.order },
        expansion_point: expansion_point(&args.expansion, robot)?,
        equations: args.sets.equations,
    };
    let usual = Settings {
        until: args.data.until,
        gap_limit: args.data.max_gap.into(),
        ..Settings::default()
    };
    let settings = args.sets.settings(usual, joints)?;
    settings.validate(joints)?;
    Ok((arm, settings))
}
