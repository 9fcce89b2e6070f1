//! The plan of a campaign that was recorded, made again from its options.

use std::path::Path;

use reachtube_robot::Robot;
use serde::Deserialize;

use super::error::CampaignError;
use super::job::PlannedSuite;
use super::mark::MARK;
use super::options::CampaignOptions;
use super::plan;
use crate::error::Result;
use crate::virtual_robot::VirtualRobot;

/// What is read of the file that marks a campaign.
#[derive(Deserialize)]
struct Mark {
    options: CampaignOptions,
}

/// Returns the suites of the campaign of the LWA 4P in `folder`, in the order of the index.
///
/// # Errors
///
/// [`CampaignError::NotACampaign`] where the folder has no options of a campaign.
pub(crate) fn planned_suites(folder: &Path) -> Result<Vec<PlannedSuite>> {
    let not = || CampaignError::NotACampaign { folder: folder.into() };
    let text = std::fs::read(folder.join(MARK)).map_err(|_| not())?;
    let Mark { options } = serde_json::from_slice(&text).map_err(|_| not())?;
    options.validate()?;
    let robot = VirtualRobot::new(&Robot::lwa4p(), options.robot.clone())?;
    Ok(plan::jobs(&robot, &options).into_iter().filter_map(|job| job.planned()).collect())
}
