//! Errors of a campaign.

use std::path::PathBuf;

/// The reason why a campaign could not be recorded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CampaignError {
    /// A number of things to record, or a duration, is not supported.
    #[error("campaign: {name}: {given} is not in {least} to {most}; give a number in this range")]
    Range {
        /// What is counted, or what lasts so long.
        name: &'static str,
        /// The number given.
        given: f64,
        /// The least number.
        least: f64,
        /// The largest number.
        most: f64,
    },
    /// All motions are held out.
    #[error(
        "campaign: {motions} motions, of which {held_out} are held out, leave none to train with; \
         hold out fewer motions"
    )]
    NoTrainingMotion {
        /// Number of motions.
        motions: usize,
        /// Number of motions held out.
        held_out: usize,
    },
    /// The folder holds files that no campaign has written.
    #[error(
        "{}: the folder holds files that no campaign has written; give an empty folder",
        folder.display()
    )]
    ForeignFolder {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder holds another campaign.
    #[error(
        "{}: the folder holds a campaign with other options, another robot or another version of \
         the program: campaign.json names them; give the same, or an empty folder",
        folder.display()
    )]
    OtherCampaign {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder has no options of a campaign.
    #[error(
        "{}: the folder has no campaign.json of `reachtube campaign`, from which the planned \
         motion and the arm follow; give the folder of a campaign",
        folder.display()
    )]
    NotACampaign {
        /// The folder.
        folder: PathBuf,
    },
}
