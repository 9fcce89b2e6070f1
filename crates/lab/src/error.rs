use std::path::PathBuf;

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
    /// A figure or page could not be made.
    #[error(transparent)]
    Page(#[from] reachtube_page::Error),
    /// A parameter is outside its range.
    #[error("virtual robot: {name} = {given} is outside [{low:e}, {high:e}]; give a value inside")]
    Parameter {
        /// The parameter.
        name: &'static str,
        /// The value given.
        given: f64,
        /// The least value.
        low: f64,
        /// The largest value.
        high: f64,
    },
    /// The simulation diverged.
    #[error(
        "virtual robot: the simulation of {recording} of {robot} diverged; the robot's inertias \
         are too small for its friction and controller, or not physical: use lwa4p"
    )]
    Diverged {
        /// The recording.
        recording: String,
        /// The robot's name.
        robot: String,
    },
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
    /// There is nothing to simulate.
    #[error("Table I: no motions or no orders to simulate; give at least 1 of each")]
    NothingToSimulate,
    /// There is no campaign or no further motion to simulate.
    #[error("coverage: no campaigns or no further motions to simulate; give at least 1 of each")]
    NoCampaigns,
    /// The campaign is one of another robot.
    #[error(
        "{}: the campaign's robot is {robot}, but Table III belongs to the LWA 4P; record it with \
         --robot lwa4p",
        folder.display()
    )]
    OtherRobot {
        /// The folder.
        folder: PathBuf,
        /// The robot's name.
        robot: String,
    },
    /// A joint cannot move within the range.
    #[error(
        "joint `{joint}` cannot move within {range} rad of the expansion point 0: its limits are \
         {limits:?} rad; choose a wider range"
    )]
    NoRange {
        /// The joint's name.
        joint: String,
        /// Largest distance from the expansion point \[rad\].
        range: f64,
        /// The joint's position limits \[rad\].
        limits: [f64; 2],
    },
    /// There is no suite to draw.
    #[error("there is no suite with two samples or more to draw")]
    NoSuite,
    /// A campaign has no suite of this name.
    #[error("the campaign has no suite {suite}; its runs.csv names the suites")]
    UnknownSuite {
        /// The suite.
        suite: String,
    },
}

reachtube_files::kinds!(Error {
    [File | Recordings | Identify | Abstraction | Conform | Robot | Page] => inner,
    _ => Setting,
});

/// A result of this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;
