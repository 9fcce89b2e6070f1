//! The option that holds joints at positions.

use clap::Args;
use reachtube_robot::{Lock, Robot};

use crate::error::Result;
use crate::output;

// A comment, not a doc comment: clap would show it as the description of the command.
// The option that holds joints of a robot file at positions.
#[derive(Debug, Args)]
pub(crate) struct LockArguments {
    /// Hold a joint at a position, in rad or m, with the joints that mimic it; repeat the option
    /// for more joints
    #[arg(long, hide_short_help = true, value_name = "JOINT=VALUE", help_heading = "Model")]
    pub lock: Vec<Lock>,
}

impl LockArguments {
    pub(crate) fn load(&self, robot: &str) -> Result<Robot> {
        Ok(Robot::load_locked(robot, &self.lock)?)
    }

    /// Loads a robot whose parameters are to be identified, so that links of a URDF may have
    /// inertias that no body has; a warning names them.
    pub(crate) fn load_to_identify(&self, robot: &str) -> Result<Robot> {
        let (robot, warning) = Robot::load_to_identify(robot, &self.lock)?;
        warning.iter().for_each(|warning| output::warn(warning));
        Ok(robot)
    }
}
