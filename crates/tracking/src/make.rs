use std::collections::BTreeSet;
use std::ops::Range;

use rayon::prelude::*;
use reachtube_files::SealedFile;
use reachtube_finding::{Finding, Severity};
use reachtube_recordings::{ColumnSettings, LogSettings};
use reachtube_scalar::rounding::{add_up, sub_up};
use schemars::JsonSchema;
use serde::Serialize;

use crate::code::Code;
use crate::delay;
use crate::error::{Error, Result};
use crate::family::{BETTER, FAMILIES, FittedFamily, TrackedRows};
use crate::fit::TrackedSet;
use crate::links::TrackedLinks;
use crate::model::{JointTracking, NeedsOfMotions, RunOfModel, TrackingModel};
use crate::motion::{MotionRows, motions};
use crate::recording::{FEWEST_SAMPLES, TrackedRun, check};
use crate::slip::slips;

/// A model of an arm under its controller, and the families that were tried for it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MadeModel {
    /// The model.
    pub model: TrackingModel,
    /// What was tried, the simplest first.
    pub families: Vec<TriedFamily>,
    /// The place of the family of the model among them, from 0.
    pub chosen: usize,
    /// What speaks against the model.
    pub findings: Vec<Finding>,
}

/// A family of nominal errors that was tried.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TriedFamily {
    /// What the nominal error depends on, in words.
    pub depends_on: &'static str,
    /// Whether the sets grow with the commanded speed.
    pub grows: bool,
    /// The mean over samples and joints of the half-widths with the factor, rad.
    pub mean_half_width: f64,
    /// The factor of all sets.
    pub factor: f64,
}

impl MadeModel {
    /// Returns whether the sets are proved, say something of other motions, are narrower than what
    /// the logs alone give, and nothing contradicts them.
    #[must_use]
    pub fn is_useful(&self) -> bool {
        let is_contradicted = self.findings.iter().any(|of| of.severity == Severity::Failure);
        self.model.is_useful() && !is_contradicted
    }
}

/// Makes a model of commanded and actual positions of one arm.
///
/// The nominal error of each joint and the least radius that holds all samples are found together
/// by a linear program. The family of nominal errors, and one factor for all sets, come from
/// motions that are left out in turn; from 20 recordings on, from every second one, which nothing
/// else has seen. At last every sample is proved to lie in the sets, with directed rounding. With
/// links, the model says too how far they stray in the recorded poses.
///
/// # Errors
///
/// Recordings of different joints, actual positions that are no measurement, recordings without a
/// motion, and a program that cannot be solved.
pub fn make(recordings: &[TrackedRun], links: Option<&TrackedLinks>) -> Result<MadeModel> {
    check(recordings)?;
    recordings.iter().try_for_each(TrackedRun::refuse_copy)?;
    let (mut ranges, found): (Vec<_>, Vec<_>) =
        recordings.iter().map(TrackedRun::following).unzip();
    let is_short = |range: &&mut Range<usize>| range.len() < FEWEST_SAMPLES;
    ranges.iter_mut().filter(is_short).for_each(|range| range.end = range.start);
    let mut findings: Vec<Finding> = found.into_iter().flatten().collect();
    let parts = recordings.iter().zip(&ranges).filter(|(_, range)| !range.is_empty());
    let used: Vec<TrackedRun> = parts.map(|(of, range)| of.only(range.clone())).collect();
    if used.iter().all(|of| (0..of.times.len()).all(|k| of.speed(k) == 0.0)) {
        return Err(Error::NoMotion);
    }
    let motions = motions(&used);
    let Searched { delay, followed, rows, tried, at } = search(&used, &motions)?;
    let chosen = &tried[at];
    let recorded = recordings.iter().zip(&ranges).map(|(of, range)| RunOfModel {
        file: of.file.display().to_string(),
        sha256: of.sha256.clone(),
        samples: of.times.len(),
        set_aside: of.times.len() - range.len(),
    });
    let mut model = TrackingModel {
        format: String::new(),
        version: 0,
        tool: String::new(),
        verified: false,
        delay,
        joints: joints(&used, chosen),
        links: vec![],
        factor: chosen.factor,
        step: used.iter().map(TrackedRun::usual_step).fold(0.0, f64::max),
        left_out: left_out(&motions, &rows, chosen, rows.inside(chosen)?),
        recordings: recorded.collect(),
        columns: ColumnSettings::default(),
        log: LogSettings::default(),
        sha256: String::new(),
    };
    hold_all(&mut model, &followed);
    let strays =
        |links: &TrackedLinks| links.strays(&model, (&followed, &used), (&motions, &rows.is_kept));
    model.links = links.map(strays).unwrap_or_default();
    let model = model.sealed();
    findings.extend(followed.iter().filter_map(slips));
    findings.extend(against(&model));
    let family = |of: &FittedFamily| TriedFamily {
        depends_on: FAMILIES[of.family].words,
        grows: FAMILIES[of.family].form.grows,
        mean_half_width: of.mean_half_width,
        factor: of.factor,
    };
    Ok(MadeModel { model, families: tried.iter().map(family).collect(), chosen: at, findings })
}

/// Families that were tried under the delay that was chosen.
struct Searched {
    delay: f64,
    /// The recordings with their commands of so much before.
    followed: Vec<TrackedRun>,
    rows: TrackedRows,
    tried: Vec<FittedFamily>,
    /// The place of the chosen one.
    at: usize,
}

/// Chooses a family without a delay, and with the delay that explains the most of what the sets are
/// fitted to, if its sets are smaller.
fn search(used: &[TrackedRun], motions: &[MotionRows]) -> Result<Searched> {
    let with = |delay: f64| -> Result<Searched> {
        let followed: Vec<TrackedRun> = used.iter().map(|of| of.delayed(delay)).collect();
        let rows = TrackedRows::new(&followed, used, motions);
        let (tried, at) = rows.choose()?;
        Ok(Searched { delay, followed, rows, tried, at })
    };
    let plain = with(0.0)?;
    let is_kept = |recording: usize| {
        let mut of_all = motions.iter().zip(&plain.rows.is_kept);
        of_all.any(|(motion, is_kept)| motion.recording == recording && *is_kept)
    };
    let fitted = used.iter().enumerate().filter(|(recording, _)| !is_kept(*recording));
    let delay = delay::best(&fitted.map(|(_, of)| of).collect::<Vec<_>>());
    if delay == 0.0 {
        return Ok(plain);
    }
    let late = with(delay)?;
    let size = |of: &Searched| of.tried[of.at].mean_half_width;
    Ok(if size(&late) < (1.0 - BETTER) * size(&plain) { late } else { plain })
}

/// Returns the joints with their sets, scaled by the factor, and what the recordings show of them.
fn joints(recordings: &[TrackedRun], chosen: &FittedFamily) -> Vec<JointTracking> {
    let of_joint = |(joint, set): (usize, &TrackedSet)| {
        let TrackedSet { factors: [offset, speed, acceleration, direction], radius } = *set;
        let largest = |value: &dyn Fn(&TrackedRun, usize) -> f64| {
            let rows = recordings.iter().flat_map(|of| (0..of.times.len()).map(move |k| (of, k)));
            rows.map(|(of, k)| value(of, k).abs()).fold(0.0, f64::max)
        };
        JointTracking {
            name: recordings[0].joints[joint].clone(),
            unit: recordings[0].units[joint].into(),
            offset,
            speed,
            acceleration,
            direction,
            radius: radius[0] * chosen.factor,
            radius_per_speed: radius[1] * chosen.factor,
            largest_speed: largest(&|of, k| of.rates::<f64>(k, joint)[0]),
            largest_acceleration: largest(&|of, k| of.rates::<f64>(k, joint)[1]),
            largest_error: largest(&|of, k| of.error(k, joint)),
            largest_change: 0.0,
        }
    };
    chosen.sets.iter().enumerate().map(of_joint).collect()
}

/// Returns what the motions said that were left out.
fn left_out(
    motions: &[MotionRows],
    rows: &TrackedRows,
    chosen: &FittedFamily,
    inside: Option<usize>,
) -> NeedsOfMotions {
    let of_kept = motions.iter().zip(&rows.is_kept).filter(|(_, is_kept)| **is_kept);
    let kept = of_kept.map(|(motion, _)| motion.recording).collect::<BTreeSet<_>>().len();
    let seen = motions.iter().zip(&rows.is_kept);
    let needed = seen.filter(|(_, is_kept)| kept == 0 || **is_kept).zip(&chosen.needed);
    let furthest = needed.max_by(|(_, a), (_, b)| a.total_cmp(b));
    NeedsOfMotions {
        motions: motions.len(),
        calibrated: (kept > 0).then_some(kept),
        furthest: furthest.map(|((motion, _), _)| motion.name.clone()),
        inside,
    }
}

/// Raises each half-width at rest to what a proof of every sample needs, by rounding at most where
/// the program was solved, and states that they are proved.
fn hold_all(model: &mut TrackingModel, recordings: &[TrackedRun]) {
    for joint in 0..model.joints.len() {
        let beyond = |of_joint: &JointTracking| {
            let of = |of: &TrackedRun| {
                let rows = (0..of.times.len()).map(|k| {
                    let (rest, half_width) = of_joint.beside(of, k, joint);
                    sub_up(rest.mag(), half_width)
                });
                rows.fold(f64::NEG_INFINITY, f64::max)
            };
            recordings.par_iter().map(of).reduce(|| f64::NEG_INFINITY, f64::max)
        };
        let own = beyond(&model.joints[joint]);
        let of_joint = &mut model.joints[joint];
        of_joint.radius = add_up(of_joint.radius, own.max(0.0));
        // The sum may round by more than the first one did.
        if own > 0.0 {
            of_joint.radius *= 1.0 + 1e-12;
        }
    }
    let holds = |(joint, of_joint): (usize, &JointTracking)| {
        let of = |of: &TrackedRun| {
            (0..of.times.len()).all(|k| {
                let (rest, half_width) = of_joint.beside(of, k, joint);
                rest.mag() <= half_width
            })
        };
        recordings.par_iter().all(of)
    };
    model.verified = model.joints.iter().enumerate().all(holds);
    for joint in 0..model.joints.len() {
        let rest = |of: &TrackedRun, k: usize| model.joints[joint].beside(of, k, joint).0;
        let change = |of: &TrackedRun| {
            let steps = 1..of.times.len();
            steps.map(|k| (rest(of, k) - rest(of, k - 1)).mag()).fold(0.0, f64::max)
        };
        let largest = recordings.par_iter().map(change).reduce(|| 0.0, f64::max);
        model.joints[joint].largest_change = largest;
    }
}

/// Returns what speaks against a model.
fn against(model: &TrackingModel) -> Vec<Finding> {
    let mut found = Vec::new();
    if !model.has_motions() {
        let text = "With fewer than 3 motions, the sets describe these recordings only; record \
                    more, with a rest between motions.";
        found.push(Finding::new(Severity::Warning, Code::FewMotions, text));
    } else if model.mean_half_width() >= model.mean_without_model() {
        let text = "The sets are not narrower than the largest recorded error + 20 %, which needs \
                    no model; record more motions that are alike.";
        found.push(Finding::new(Severity::Warning, Code::NotNarrower, text));
    }
    found
}
