//! The options of a campaign.

use serde::{Deserialize, Serialize};

use super::error::CampaignError;
use crate::virtual_robot::VirtualRobotParameters;

/// Largest number of suites per motion, which are named by letters.
const MOST_START_POINTS: usize = 26;

/// Largest number of anything else that is counted.
const MOST: usize = 100_000;

/// The sizes of a campaign, and the seed of everything random.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CampaignOptions {
    /// Seed; the same seed gives the same recordings.
    pub seed: u64,
    /// Number of random point-to-point motions.
    pub motions: usize,
    /// Number of points of each motion from which the open loop starts; each gives a suite.
    pub start_points: usize,
    /// Number of runs of each suite.
    pub runs: usize,
    /// Longest duration of a run \[s\].
    pub longest: f64,
    /// Number of static poses: rests, two at each position, from both sides.
    pub poses: usize,
    /// Number of recordings of slow motions for each joint.
    pub friction: usize,
    /// Number of exciting motions to identify with.
    pub excitation: usize,
    /// Number of exciting motions to validate with.
    pub validation: usize,
    /// The virtual robot.
    pub robot: VirtualRobotParameters,
}

impl Default for CampaignOptions {
    /// Returns the sizes of the paper: 38 motions with four start points and 15 runs each, of up to
    /// 5 s, and 1000 poses. The paper does not give the numbers of its other recordings.
    fn default() -> Self {
        Self {
            seed: 1,
            motions: 38,
            start_points: 4,
            runs: 15,
            longest: 5.0,
            poses: 1000,
            friction: 6,
            excitation: 6,
            validation: 2,
            robot: VirtualRobotParameters::default(),
        }
    }
}

impl CampaignOptions {
    pub(super) fn validate(&self) -> Result<(), CampaignError> {
        for (name, given, least, most) in [
            ("motions", self.motions, 1, MOST),
            ("start points", self.start_points, 1, MOST_START_POINTS),
            ("runs", self.runs, 1, MOST),
            ("poses", self.poses, 0, MOST),
            ("friction", self.friction, 0, MOST),
            ("excitation", self.excitation, 0, MOST),
            ("validation", self.validation, 0, MOST),
        ] {
            if !(least..=most).contains(&given) {
                return Err(CampaignError::Count { name, given, least, most });
            }
        }
        if !(0.1..=3600.0).contains(&self.longest) {
            return Err(CampaignError::Longest { given: self.longest });
        }
        Ok(())
    }
}
