//! Errors of a campaign.

use std::path::PathBuf;

/// The reason why a campaign could not be recorded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CampaignError {
    /// A number of things to record is not supported.
    #[error("campaign: {name}: {given} is not in {least} to {most}; give a number in this range")]
    Count {
        /// What is counted.
        name: &'static str,
        /// The number given.
        given: usize,
        /// The least number.
        least: usize,
        /// The largest number.
        most: usize,
    },
    /// The longest duration of a run is not supported.
    #[error("campaign: runs of at most {given} s; give 0.1 to 3600 s")]
    Longest {
        /// The duration given \[s\].
        given: f64,
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
         the program: {} names them; give the same, or an empty folder",
        folder.display(),
        super::mark::MARK
    )]
    OtherCampaign {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder has no options of a campaign.
    #[error(
        "{}: the folder has no {} of `reachtube campaign`, from which the planned motion follows; \
         give the folder of a campaign",
        folder.display(),
        super::mark::MARK
    )]
    NotACampaign {
        /// The folder.
        folder: PathBuf,
    },
}
