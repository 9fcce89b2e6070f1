use crate::error::{Error, Result};
use crate::prepare::changes::described as described_changes;
use crate::prepare::cut_off::chosen_cut_off;
use crate::prepare::entry::LogEntry;
use crate::prepare::log::PreparedLog;
use crate::prepare::prepared::prepare_one;
use crate::prepare::read::{Source, sources};
use crate::prepare::survey::{Survey, check_held_out};
use crate::prepare::turns::missing_turns;
use crate::prepare::velocity::velocity_warnings;
use crate::samples::{Sampling, most_samples};
use crate::settings::IdentifySettings;
use rayon::prelude::*;
use reachtube_diagnose::{Signals, median};
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

/// Numbers of recordings of one kind that are kept in memory: 64 MB.
const MOST_NUMBERS: usize = 8_000_000;

/// The prepared recordings of an identification, and how samples are taken from them.
pub(crate) struct Inputs {
    /// Poses at rest.
    pub rest: Vec<PreparedLog>,
    /// Slow motions of one joint at a time.
    pub friction: Vec<PreparedLog>,
    /// Exciting motions.
    pub excitation: Vec<PreparedLog>,
    /// Validation recordings.
    validate: Vec<PreparedLog>,
    /// The rules for taking samples.
    pub sampling: Sampling,
    /// Whether torques of exciting motions contain the gravity torque of the description.
    pub compensated: bool,
    /// Changes to the recordings, one sentence each.
    pub changes: Vec<String>,
    /// Warnings about the recordings.
    pub warnings: Vec<String>,
    /// SHA-256 of the recordings that parameters are fitted to.
    pub seen: Vec<String>,
}

impl Inputs {
    /// Reads and prepares all recordings of a job; the cut-off suits the exciting motions.
    ///
    /// Recordings are read twice, one by one: first for what decides how all are prepared, then to
    /// prepare them. If there are many exciting motions, not all samples are kept.
    ///
    /// The controllers of `robot` compensate, if a recording has the input u.
    pub(crate) fn read(robot: &Robot, settings: &IdentifySettings, folder: &Path) -> Result<Self> {
        let IdentifySettings { rest, one_joint, excitation, validate, prepare, model, .. } =
            settings;
        let groups = [rest, one_joint, excitation, validate];
        let sources = groups.map(|entries| sources(entries, folder, robot, prepare)).into_iter();
        let mut sources: Vec<Vec<Source>> = sources.collect::<Result<_>>()?;
        let survey = |source: &Source| Ok(Survey::of(&source.read(robot, prepare)?));
        let surveys = sources.iter().map(|group| group.par_iter().map(survey).collect());
        let surveys: Vec<Vec<Survey>> = surveys.collect::<Result<_>>()?;
        let fitted: Vec<&Survey> = surveys[..3].iter().flatten().collect();
        check_held_out(&surveys[3], &fitted)?;
        let cut_off = chosen_cut_off(&surveys[2], prepare)?;
        let margin = MARGIN_PERIODS / cut_off;
        // All groups get one sample time, and count turns alike.
        let all: Vec<&Survey> = surveys.iter().flatten().collect();
        let mut notes = turns(robot, &all, sources.iter_mut().flatten());
        notes.extend(all.iter().flat_map(|log| log.notes.clone()));
        let common = median(all.iter().filter_map(|survey| survey.step)).unwrap_or(0.0);
        let strides = [1, 1, stride(&surveys[2]), stride(&surveys[3])];
        let (mut logs, mut changes) = (Vec::new(), Vec::new());
        let [mut samples, mut short] = [0; 2];
        for (group, stride) in sources.iter().zip(strides) {
            let prepared = |source: &Source| {
                let raw = source.read(robot, prepare)?;
                let (log, change) = prepare_one(&raw, prepare, cut_off, common, None)?;
                Ok((log.len(), log.thinned(stride, margin), change))
            };
            let done = group.par_iter().map(prepared).collect::<Vec<Result<_>>>();
            let (done, few) = without_short(done, logs.len() >= 2)?;
            short += few;
            samples += done.iter().map(|(count, ..)| count).sum::<usize>();
            changes.extend(done.iter().map(|(.., change)| *change));
            logs.push(done.into_iter().map(|(_, log, _)| log).collect::<Vec<PreparedLog>>());
        }
        let [rest, friction, excitation, validate] = logs.try_into().expect("four groups");
        let moving: Vec<&PreparedLog> = friction.iter().chain(&excitation).collect();
        let sampling = Sampling {
            rate: SAMPLES_PER_CUT_OFF * cut_off,
            slow: slow_speeds(&moving, robot.joint_count(), model.slow),
            margin,
            velocities: velocities(&moving, robot.joint_count()),
        };
        notes.extend(described_changes(samples, &changes, prepare, cut_off));
        notes.extend(too_short(short, cut_off));
        notes.push(described(&sampling, &moving, robot));
        notes.extend(thinning(&excitation, strides[2], &sampling));
        let warnings = velocity_warnings(robot, &all);
        let compensated = settings.excitation.iter().any(LogEntry::is_compensated);
        Ok(Self {
            rest,
            friction,
            excitation,
            validate,
            sampling,
            compensated,
            changes: notes,
            warnings,
            seen: fitted.iter().map(|survey| survey.sha256.clone()).collect(),
        })
    }

    /// Returns whether there are validation recordings, and the recordings for the validation:
    /// these or else the exciting motions.
    pub(crate) fn validation(&self) -> (bool, &[PreparedLog]) {
        let held_out = !self.validate.is_empty();
        (held_out, if held_out { &self.validate } else { &self.excitation })
    }
}

/// Sets the turns that recordings lack against the others, and returns a sentence for each.
fn turns<'a>(
    robot: &Robot,
    surveys: &[&Survey],
    sources: impl Iterator<Item = &'a mut Source>,
) -> Vec<String> {
    let names: Vec<String> = surveys.iter().map(|log| log.file.display().to_string()).collect();
    let extents: Vec<_> = surveys.iter().map(|log| log.extents.clone()).collect();
    let (turns, notes) = missing_turns(robot, &names, &extents);
    sources.zip(turns).for_each(|(source, turns)| source.turns = turns);
    notes
}

/// Returns the recordings of a group that are long enough for the low-pass, and the number of the
/// others.
///
/// # Errors
///
/// The first error, if there is another one or all recordings of a group that `is_needed` are too
/// short.
fn without_short<T>(done: Vec<Result<T>>, is_needed: bool) -> Result<(Vec<T>, usize)> {
    let all = done.len();
    let is_short = |done: &Result<T>| matches!(done, Err(Error::TooShort { .. }));
    if is_needed && done.iter().all(is_short) {
        return Ok((done.into_iter().collect::<Result<_>>()?, 0));
    }
    let kept = done.into_iter().filter(|done| !is_short(done)).collect::<Result<Vec<T>>>()?;
    let short = all - kept.len();
    Ok((kept, short))
}

/// Returns the number of samples from one that is kept of recordings to the next.
fn stride(surveys: &[Survey]) -> usize {
    let numbers: usize = surveys.iter().map(|survey| survey.samples * survey.width).sum();
    numbers.div_ceil(MOST_NUMBERS).max(1)
}

/// Describes in a sentence which samples of the exciting motions are used, if not all.
fn thinning(excitation: &[PreparedLog], stride: usize, sampling: &Sampling) -> Option<String> {
    let total: usize = excitation.iter().map(|log| log.len().div_ceil(sampling.stride(log))).sum();
    let used = total.div_ceil(most_samples(total));
    (stride > 1 || used > 1).then(|| {
        format!(
            "of the samples of the exciting motions one in {stride} was kept in memory, and of \
             {total} samples at the sampling rate one in {used} was fitted"
        )
    })
}

/// Describes in a sentence how many recordings were left out, if some were.
fn too_short(count: usize, cut_off: f64) -> Option<String> {
    (count > 0).then(|| {
        let (left, they) = match count {
            1 => ("recording was", "it is"),
            _ => ("recordings were", "they are"),
        };
        format!("{count} {left} left out: {they} too short for a low-pass of {cut_off:.2} Hz")
    })
}

/// Describes the sampling of the moving recordings in a sentence. A rate above half the recordings'
/// own takes all samples.
fn described(sampling: &Sampling, moving: &[&PreparedLog], robot: &Robot) -> String {
    let is_thinned = moving.iter().any(|log| sampling.stride(log) > 1);
    let slow: Vec<String> = sampling.slow.iter().map(|slow| format!("{slow:.3}")).collect();
    format!(
        "{}; the torque of a joint is not used within {:.0} ms of a sample in which the joint is \
         slower than {} {} (one limit per joint)",
        match is_thinned {
            true => format!("recordings were downsampled to {:.1} Hz", sampling.rate),
            false => "all samples of the recordings are used".into(),
        },
        1e3 * sampling.margin,
        slow.join(", "),
        JointKind::column(&robot.kinds(), JointKind::velocity_unit).list()
    )
}

/// Returns what a diagnosis takes of recordings that were filtered with a cut-off \[Hz\].
pub fn signals(logs: &[PreparedLog], cut_off: f64) -> Vec<Signals<'_>> {
    let Some(first) = logs.first() else { return Vec::new() };
    let slow = slow_speeds(&logs.iter().collect::<Vec<_>>(), first.joints, None);
    logs.iter().map(|log| log.signals(&slow, MARGIN_PERIODS / cut_off)).collect()
}

/// Returns the lowest and the highest velocity of each joint \[rad/s\].
fn velocities(moving: &[&PreparedLog], joints: usize) -> Vec<[f64; 2]> {
    let of_joint = |joint: usize| {
        let all = moving.iter().flat_map(|log| log.qd.iter().skip(joint).step_by(joints));
        all.fold([0.0f64; 2], |[low, high], qd| [low.min(*qd), high.max(*qd)])
    };
    (0..joints).map(of_joint).collect()
}

/// Returns the speed limit of slow samples \[rad/s\] for each joint: the one given, or else 2 % of
/// the 99th percentile of the joint's speed.
fn slow_speeds(moving: &[&PreparedLog], joints: usize, given: Option<f64>) -> Vec<f64> {
    let of_joint = |joint: usize| {
        let in_log = |log: &&PreparedLog| {
            log.qd.iter().skip(joint).step_by(joints).map(|v| v.abs()).collect::<Vec<_>>()
        };
        let mut speeds: Vec<f64> = moving.iter().flat_map(in_log).collect();
        speeds.sort_by(f64::total_cmp);
        let high = speeds.get((HIGH_SPEED * speeds.len() as f64) as usize).copied().unwrap_or(0.0);
        (SLOW_SHARE * high).max(MIN_SLOW)
    };
    (0..joints).map(|joint| given.unwrap_or_else(|| of_joint(joint))).collect()
}
