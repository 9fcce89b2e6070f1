use rayon::prelude::*;
use reachtube_finding::{Finding, Severity};
use schemars::JsonSchema;
use serde::Serialize;

use crate::code::Code;
use crate::error::{Error, Result};
use crate::family::{Evidence, FAMILIES, Tried};
use crate::model::{JointTracking, LeftOutMotions, TrackedRecording, TrackingModel};
use crate::motion::{Motion, motions};
use crate::recording::Recording;

/// A model of an arm under its controller, and the families that were tried for it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MadeModel {
    /// The model.
    pub model: TrackingModel,
    /// What the nominal error of the model depends on, in words.
    pub family: &'static str,
    /// What was tried, the simplest first.
    pub families: Vec<TriedFamily>,
    /// What speaks against the model.
    pub findings: Vec<Finding>,
}

/// A family of nominal errors that was tried.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TriedFamily {
    /// What the nominal error depends on, in words.
    pub depends_on: &'static str,
    /// The mean over the joints of the half-widths with the factor, rad.
    pub mean_half_width: f64,
    /// The factor of all sets.
    pub factor: f64,
}

/// Makes a model of commanded and actual positions of one arm.
///
/// The nominal error of each joint and the least radius that holds all samples are found together
/// by a linear program. The family of nominal errors, and one factor for all sets, come from motions
/// that are left out in turn; from 20 recordings on, from every second one, which nothing else has
/// seen. At last every sample is proved to lie in the sets, with directed rounding.
///
/// # Errors
///
/// Recordings without a motion, and a program that cannot be solved.
///
/// # Panics
///
/// Panics without a recording.
pub fn make(recordings: &[Recording]) -> Result<MadeModel> {
    if recordings.iter().all(|of| (0..of.times.len()).all(|k| of.speed(k) == 0.0)) {
        return Err(Error::NoMotion);
    }
    let motions = motions(recordings);
    let evidence = Evidence::new(recordings, &motions);
    let (tried, at) = evidence.choose()?;
    let chosen = &tried[at];
    let inside = evidence.inside(chosen)?;
    let joints = (0..recordings[0].joint_count()).map(|joint| {
        let of_joint = chosen.joints[joint];
        let [offset, speed, acceleration] = of_joint.factors;
        let largest = |value: &dyn Fn(&Recording, usize) -> f64| {
            let rows = recordings.iter().flat_map(|of| (0..of.times.len()).map(move |k| (of, k)));
            rows.map(|(of, k)| value(of, k).abs()).fold(0.0, f64::max)
        };
        JointTracking {
            name: recordings[0].joints[joint].clone(),
            unit: recordings[0].units[joint].into(),
            offset,
            speed,
            acceleration,
            radius: of_joint.radius * chosen.factor,
            largest_speed: largest(&|of, k| of.terms::<f64>(k, joint)[1]),
            largest_acceleration: largest(&|of, k| of.terms::<f64>(k, joint)[2]),
            largest_error: largest(&|of, k| of.error(k, joint)),
        }
    });
    let mut model = TrackingModel {
        format: String::new(),
        version: 0,
        tool: String::new(),
        verified: false,
        joints: joints.collect(),
        factor: chosen.factor,
        left_out: left_out(&motions, &evidence, chosen, inside),
        recordings: recordings
            .iter()
            .map(|of| TrackedRecording {
                file: of.file.display().to_string(),
                sha256: of.sha256.clone(),
                samples: of.times.len(),
                set_aside: 0,
            })
            .collect(),
        sha256: String::new(),
    };
    hold_all(&mut model, recordings);
    let family = |of: &Tried| TriedFamily {
        depends_on: FAMILIES[of.family].1,
        mean_half_width: of.mean_width(),
        factor: of.factor,
    };
    let families = tried.iter().map(family).collect();
    let (model, family) = (model.sealed(), FAMILIES[chosen.family].1);
    let findings = findings(&model);
    Ok(MadeModel { model, family, families, findings })
}

/// Returns what the motions said that were left out.
fn left_out(
    motions: &[Motion],
    evidence: &Evidence,
    chosen: &Tried,
    inside: Option<(usize, usize)>,
) -> LeftOutMotions {
    let kept = evidence.is_kept.iter().filter(|is_kept| **is_kept).count();
    let seen = motions.iter().zip(&evidence.is_kept);
    let needed = seen.filter(|(_, is_kept)| kept == 0 || **is_kept).zip(&chosen.needed);
    let furthest = needed.max_by(|(_, a), (_, b)| a.total_cmp(b));
    LeftOutMotions {
        motions: motions.len(),
        calibrated: (kept > 0).then_some(kept),
        furthest: furthest.map(|((motion, _), _)| motion.name.clone()),
        inside: inside.map(|(inside, _)| inside),
    }
}

/// Raises each radius to what a proof of every sample needs, by rounding at most where the program
/// was solved, and states that they are proved.
fn hold_all(model: &mut TrackingModel, recordings: &[Recording]) {
    for joint in 0..model.joints.len() {
        let of_joint = &model.joints[joint];
        let furthest = |of: &Recording| {
            let rests = (0..of.times.len()).map(|k| of_joint.rest(of, k, joint).mag());
            rests.fold(0.0, f64::max)
        };
        let needed = recordings.par_iter().map(furthest).reduce(|| 0.0, f64::max);
        model.joints[joint].radius = of_joint.radius.max(needed);
    }
    // The radius is at least the upper end of every enclosed distance.
    model.verified = model.joints.iter().all(|joint| joint.radius.is_finite());
}

/// Returns what speaks against a model.
fn findings(model: &TrackingModel) -> Vec<Finding> {
    let mut found = Vec::new();
    if !model.has_motions() {
        let text = "With fewer than 3 motions nothing is known of others; record more of them, with \
                    a rest between them.";
        found.push(Finding::new(Severity::Warning, Code::FewMotions, text));
    } else if model.mean_radius() >= model.mean_without_model() {
        let text = "The sets are not narrower than the largest recorded error + 20 %, which needs no \
                    model; record more motions that are alike.";
        found.push(Finding::new(Severity::Warning, Code::NotNarrower, text));
    }
    found
}
