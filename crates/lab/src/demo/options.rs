//! The options of a demo.

use super::error::DemoError;
use crate::virtual_robot::VirtualRobotParameters;

/// Largest number of suites per motion, which are named by letters.
const MOST_START_POINTS: usize = 26;

/// Shortest and longest duration of a motion \[s\].
const DURATIONS: [f64; 2] = [0.5, 60.0];

/// The number of motions, suites and runs, and the seed of everything random.
#[derive(Debug, Clone, PartialEq)]
pub struct DemoOptions {
    /// Seed; the same seed gives the same recordings.
    pub seed: u64,
    /// Number of point-to-point motions, those held out included.
    pub motions: usize,
    /// Number of motions, taken before those held out, that calibrate the sets.
    pub calibration_motions: usize,
    /// Number of motions, taken from the last ones, that are held out for a check of the model.
    pub held_out_motions: usize,
    /// Number of points of each motion from which the open loop starts; each gives a suite.
    pub start_points: usize,
    /// Number of runs of each suite.
    pub runs: usize,
    /// Duration of a motion \[s\]. Suites last 0.9 of it, or less where they start later.
    pub duration: f64,
    /// The virtual robot.
    pub robot: VirtualRobotParameters,
}

impl Default for DemoOptions {
    /// Returns 10 motions of 3 s, 2 of them held out, with 2 suites of 8 runs per motion.
    fn default() -> Self {
        Self {
            seed: 1,
            motions: 10,
            calibration_motions: 0,
            held_out_motions: 2,
            start_points: 2,
            runs: 8,
            duration: 3.0,
            robot: VirtualRobotParameters::default(),
        }
    }
}

impl DemoOptions {
    pub(super) fn validate(&self) -> Result<(), DemoError> {
        let [shortest, longest] = DURATIONS;
        let held_out = self.held_out_motions + self.calibration_motions;
        if self.motions <= held_out {
            let motions = self.motions;
            Err(DemoError::NoTrainingMotion { motions, held_out })
        } else if !(1..=MOST_START_POINTS).contains(&self.start_points) {
            Err(DemoError::StartPoints { given: self.start_points, most: MOST_START_POINTS })
        } else if self.runs == 0 {
            Err(DemoError::NoRuns)
        } else if !(shortest..=longest).contains(&self.duration) {
            Err(DemoError::Duration { given: self.duration, shortest, longest })
        } else {
            Ok(())
        }
    }
}
