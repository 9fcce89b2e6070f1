use crate::error::Result;
use crate::held_out::check_held_out;
use crate::prepare::cut_off::cut_off;
use crate::prepare::entry::LogEntry;
use crate::prepare::log::Log;
use crate::prepare::prepared::prepare;
use crate::prepare::raw_log::RawLog;
use crate::prepare::read::read;
use crate::prepare::velocity::velocity_warnings;
use crate::samples::Sampling;
use crate::settings::IdentifySettings;
use reachtube_robot::{JointKind, Robot};
use std::path::Path;

/// Ratio of the sample rate of the regression to the cut-off: faster samples would only repeat what
/// the low-pass lets pass.
const SAMPLES_PER_CUT_OFF: f64 = 6.0;

/// Margin around slow samples, in periods of the cut-off: the low-pass spreads the step of
/// friction.
const MARGIN_PERIODS: f64 = 0.5;

/// Speed limit of slow samples, relative to a joint's high speed.
const SLOW_SHARE: f64 = 0.02;

/// Quantile of a joint's speed that counts as its high speed.
const HIGH_SPEED: f64 = 0.99;

/// Least speed limit of slow samples \[rad/s\].
const MIN_SLOW: f64 = 1e-4;

/// The prepared recordings of an identification, and how samples are taken from them.
pub struct Inputs {
    /// Poses at rest.
    pub rest: Vec<Log>,
    /// Slow motions of one joint at a time.
    pub friction: Vec<Log>,
    /// Exciting motions.
    pub dynamic: Vec<Log>,
    /// Validation recordings.
    validate: Vec<Log>,
    /// The rules for taking samples.
    pub sampling: Sampling,
    /// Changes to the recordings, one sentence each.
    pub changes: Vec<String>,
    /// Warnings about the recordings.
    pub warnings: Vec<String>,
}

impl Inputs {
    /// Reads and prepares all recordings of a job; the cut-off suits the exciting motions.
    pub fn read(robot: &Robot, settings: &IdentifySettings, folder: &Path) -> Result<Self> {
        let raw = |entries: &[LogEntry]| read(entries, folder, robot, &settings.prepare);
        let groups = [
            raw(&settings.rest)?,
            raw(&settings.friction)?,
            raw(&settings.dynamic)?,
            raw(&settings.validate)?,
        ];
        check_held_out(&groups[3], groups[..3].iter().flatten())?;
        let exciting: Vec<&RawLog> = groups[2].iter().collect();
        let cut_off = cut_off(&exciting, &settings.prepare)?;
        // All groups are prepared together, so that they get one sample time.
        let counts = groups.each_ref().map(Vec::len);
        let all = groups.concat();
        let prepared = prepare(&all, &settings.prepare, cut_off)?;
        let mut logs = prepared.logs.into_iter();
        let [rest, friction, dynamic, validate] =
            counts.map(|count| logs.by_ref().take(count).collect::<Vec<Log>>());
        let moving: Vec<&Log> = friction.iter().chain(&dynamic).collect();
        let sampling = Sampling {
            rate: SAMPLES_PER_CUT_OFF * cut_off,
            slow: slow_speeds(&moving, robot.joint_count(), settings.model.slow),
            margin: MARGIN_PERIODS / cut_off,
            laws: vec![],
        };
        let mut changes = prepared.changes;
        changes.push(described(&sampling, robot));
        let warnings = velocity_warnings(robot, &all);
        Ok(Self { rest, friction, dynamic, validate, sampling, changes, warnings })
    }

    /// Returns whether there are validation recordings, and the recordings for the validation:
    /// these or else the exciting motions.
    pub fn validation(&self) -> (bool, &[Log]) {
        let kept_back = !self.validate.is_empty();
        (kept_back, if kept_back { &self.validate } else { &self.dynamic })
    }
}

/// Describes the sampling in a sentence.
fn described(sampling: &Sampling, robot: &Robot) -> String {
    let slow: Vec<String> = sampling.slow.iter().map(|slow| format!("{slow:.3}")).collect();
    format!(
        "recordings were downsampled to {:.1} Hz; the torque of a joint is not used within {:.0} \
         ms of a sample in which the joint is slower than {} {} (one limit per joint)",
        sampling.rate,
        1e3 * sampling.margin,
        slow.join(", "),
        JointKind::units(&robot.kinds(), JointKind::velocity_unit)
    )
}

/// Returns the speed limit of slow samples \[rad/s\] for each joint: the one given, or else 2 % of
/// the 99th percentile of the joint's speed.
fn slow_speeds(moving: &[&Log], joints: usize, given: Option<f64>) -> Vec<f64> {
    let of_joint = |joint: usize| {
        let in_log = |log: &&Log| {
            log.qd.iter().skip(joint).step_by(joints).map(|v| v.abs()).collect::<Vec<_>>()
        };
        let mut speeds: Vec<f64> = moving.iter().flat_map(in_log).collect();
        speeds.sort_by(f64::total_cmp);
        let high = speeds.get((HIGH_SPEED * speeds.len() as f64) as usize).copied().unwrap_or(0.0);
        (SLOW_SHARE * high).max(MIN_SLOW)
    };
    (0..joints).map(|joint| given.unwrap_or_else(|| of_joint(joint))).collect()
}
