use thiserror::Error;

/// Why a job could not be done. A model that is not conformant is no error but a value, as in
/// [`Check`](reachtube_conform::Check).
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] reachtube_files::Error),
    /// Recordings have defects, or could not be read.
    #[error(transparent)]
    Recordings(#[from] reachtube_recordings::Error),
    /// A robot could not be identified.
    #[error(transparent)]
    Identify(#[from] reachtube_identify::Error),
    /// A model could not be made, read or bounded.
    #[error(transparent)]
    Abstraction(#[from] reachtube_abstraction::Error),
    /// A conformance could not be decided.
    #[error(transparent)]
    Conform(#[from] reachtube_conform::Error),
    /// The robot's description is wrong.
    #[error(transparent)]
    Robot(#[from] reachtube_robot::RobotError),
    /// A virtual robot could not move.
    #[error(transparent)]
    VirtualRobot(#[from] crate::virtual_robot::error::VirtualRobotError),
    /// A campaign could not be recorded.
    #[error(transparent)]
    Campaign(#[from] crate::campaign::error::CampaignError),
    /// A table of the paper could not be reproduced.
    #[error(transparent)]
    Reproduce(#[from] crate::reproduce::error::ReproduceError),
    /// A figure or page could not be made.
    #[error(transparent)]
    Page(#[from] reachtube_page::Error),
}

reachtube_files::kinds!(Error {
    [File | Recordings | Identify | Abstraction | Conform | Robot | Page] => inner,
    _ => Setting,
});

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
