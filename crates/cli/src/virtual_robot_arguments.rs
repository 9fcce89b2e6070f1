//! The arguments that describe a virtual robot.

use std::path::PathBuf;

use clap::Args;
use reachtube::virtual_robot::VirtualRobotParameters;

use crate::error::{Error, Result};

/// Remedy if a file of parameters cannot be opened.
const REMEDY: &str = "give a TOML file with parameters of the virtual robot, as docs/paper.md has";

/// Parameters of the virtual robot.
#[derive(Debug, Args)]
pub(crate) struct VirtualRobotArguments {
    /// TOML file with parameters of the virtual robot, see docs/paper.md
    #[arg(long, value_name = "FILE")]
    pub parameters: Option<PathBuf>,
}

impl VirtualRobotArguments {
    pub(crate) fn parameters(&self) -> Result<VirtualRobotParameters> {
        let Some(path) = &self.parameters else { return Ok(VirtualRobotParameters::default()) };
        let text = reachtube_files::read_text(path, REMEDY)?;
        toml::from_str(&text).map_err(|error| Error::settings_file(path, error))
    }
}
