//! The options of a campaign, and the file that keeps them in its folder.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::virtual_robot::VirtualRobotParameters;

/// The file that marks the folder of a campaign and holds its options.
pub(super) const MARK: &str = "campaign.json";

/// Largest number of suites per motion, which are named by letters.
const MOST_START_POINTS: f64 = 26.0;

/// Largest number of anything else that is counted.
const MOST: f64 = 100_000.0;

/// The sizes of a campaign, and the seed of everything random.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CampaignOptions {
    /// Seed; the same seed gives the same recordings.
    pub seed: u64,
    /// Number of random point-to-point motions, those held out included.
    pub motions: usize,
    /// Number of motions, taken from the last ones, that are held out for a check of the model.
    pub held_out_motions: usize,
    /// Number of points of each motion from which the open loop starts; each gives a suite.
    pub start_points: usize,
    /// Number of runs of each suite.
    pub runs: usize,
    /// Duration of each motion \[s\]; if `None`, each motion goes from one random pose to another
    /// at a random speed.
    pub duration: Option<f64>,
    /// Longest duration of a run \[s\].
    pub longest: f64,
    /// Number of static poses: rests, two at each position, from both sides.
    pub rest: usize,
    /// Number of recordings of slow motions for each joint.
    pub one_joint: usize,
    /// Number of exciting motions to identify with.
    pub excitation: usize,
    /// Number of exciting motions to validate with.
    pub validation: usize,
    /// Number of samples of an exciting motion from one that is logged to the next.
    pub stride: usize,
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
            held_out_motions: 0,
            start_points: 4,
            runs: 15,
            duration: None,
            longest: 5.0,
            rest: 1000,
            one_joint: 6,
            excitation: 6,
            validation: 2,
            stride: 1,
            robot: VirtualRobotParameters::default(),
        }
    }
}

impl CampaignOptions {
    /// Returns the sizes of the demo: the logs of 8 exciting motions for a model and of 4 to
    /// compare it with, 125 samples per second, and no other recordings.
    #[must_use]
    pub fn demo() -> Self {
        let logs = Self { motions: 0, ..Self::default() }.suites_only();
        Self { excitation: 8, validation: 4, stride: 2, ..logs }
    }

    /// Returns the sizes of a small experiment: 14 motions of 3 s, of which 2 are held out, with 2
    /// suites of 5 runs per motion, and no other recordings.
    #[must_use]
    pub fn small() -> Self {
        let few = Self { motions: 14, start_points: 2, runs: 5, ..Self::default() };
        Self { held_out_motions: 2, duration: Some(3.0), ..few.suites_only() }
    }

    pub(crate) fn suites_only(self) -> Self {
        Self { rest: 0, one_joint: 0, excitation: 0, validation: 0, ..self }
    }

    pub(super) fn has_suites_only(&self) -> bool {
        [self.rest, self.one_joint, self.excitation, self.validation] == [0; 4]
    }

    pub(super) fn validate(&self) -> Result<()> {
        let count = |name, given: usize, least: f64| (name, given as f64, [least, MOST]);
        for (name, given, [least, most]) in [
            count("motions", self.motions, f64::from(u8::from(self.has_suites_only()))),
            count("samples of exciting motions per logged one", self.stride, 1.0),
            ("start points", self.start_points as f64, [1.0, MOST_START_POINTS]),
            count("runs", self.runs, 1.0),
            count("poses at rest", self.rest, 0.0),
            count("motions of one joint", self.one_joint, 0.0),
            count("exciting motions", self.excitation, 0.0),
            count("validating motions", self.validation, 0.0),
            ("longest run in s", self.longest, [0.1, 3600.0]),
            ("duration of a motion in s", self.duration.unwrap_or(1.0), [0.5, 60.0]),
        ] {
            if !(least..=most).contains(&given) {
                return Err(Error::Range { name, given, least, most });
            }
        }
        let (motions, held_out) = (self.motions, self.held_out_motions);
        if motions <= held_out && held_out > 0 {
            return Err(Error::NoTrainingMotion { motions, held_out });
        }
        Ok(())
    }
}

/// Returns the options of the campaign that was recorded in `folder`.
///
/// # Errors
///
/// [`Error::NotACampaign`] if the folder has no options of a campaign.
pub(crate) fn campaign_options(folder: &Path) -> Result<CampaignOptions> {
    #[derive(Deserialize)]
    struct Mark {
        options: CampaignOptions,
    }
    let not = || Error::NotACampaign { folder: folder.into() };
    let text = std::fs::read(folder.join(MARK)).map_err(|_| not())?;
    let Mark { options } = serde_json::from_slice(&text).map_err(|_| not())?;
    options.validate()?;
    Ok(options)
}
