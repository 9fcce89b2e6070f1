use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Result;
use crate::model::TrackingModel;
use crate::motion::{MotionRows, motions};
use crate::plan::AS_FAST;
use crate::recording::{TrackedRun, check};

/// What other recordings say of a model of an arm under its controller.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TrackingCheck {
    /// Whether every sample of all recordings is proved to lie in the sets.
    pub conformant: bool,
    /// The number of positions: one for each sample and joint.
    pub positions: usize,
    /// The number of positions that are not proved to lie in the sets.
    pub outside: usize,
    /// The motions, each with the part of the sets that it needs.
    pub motions: Vec<CheckedMotion>,
    /// The joints.
    pub joints: Vec<CheckedJoint>,
}

/// How a motion lies to the sets.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CheckedMotion {
    /// The recording, with the number of the motion if it has several.
    pub name: String,
    /// The largest part of a set that a sample needs; more than 1 is outside.
    pub needed: f64,
    /// The joint that needs it.
    pub joint: String,
    /// The time of that sample since the recording's first, s.
    pub time: f64,
}

/// How the samples of a joint lie to its set.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct CheckedJoint {
    /// The name of the joint.
    pub name: String,
    /// The largest part of its set that a sample needs; more than 1 is outside.
    pub needed: f64,
    /// The number of samples outside.
    pub outside: usize,
    /// The highest commanded speed, rad/s, if it is beyond what the model was made of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub too_fast: Option<f64>,
}

impl TrackingModel {
    /// Compares recordings with the model, sample by sample.
    ///
    /// # Guarantee
    ///
    /// A sample that is not counted as outside is proved to lie in the sets; directed rounding.
    ///
    /// # Errors
    ///
    /// [`Error::OtherJoints`](crate::Error::OtherJoints) for recordings of other joints than the
    /// model's.
    pub fn check(&self, recordings: &[TrackedRun]) -> Result<TrackingCheck> {
        check(recordings)?;
        recordings.iter().try_for_each(|of| self.refuse_other(&of.file, &of.joints))?;
        // For each motion and joint: the furthest sample, what it needs, and how many are outside.
        let motions = motions(recordings);
        let recordings: Vec<TrackedRun> =
            recordings.iter().map(|of| of.delayed(self.delay)).collect();
        let of_motion = |motion: &MotionRows| {
            let of = &recordings[motion.recording];
            let joint = |joint: usize| {
                let known = &self.joints[joint];
                let mut found = (motion.rows.start, 0.0, 0);
                for k in motion.rows.clone() {
                    let (rest, half_width) = known.beside(of, k, joint);
                    let needed = rest.mag() / half_width;
                    found.2 += usize::from(needed.is_nan() || rest.mag() > half_width);
                    if needed > found.1 {
                        (found.0, found.1) = (k, needed);
                    }
                }
                found
            };
            (0..self.joints.len()).map(joint).collect::<Vec<_>>()
        };
        let found: Vec<Vec<(usize, f64, usize)>> = motions.par_iter().map(of_motion).collect();
        let checked_motions = motions.iter().zip(&found).map(|(motion, joints)| {
            let needs = joints.iter().zip(&self.joints);
            let needs = needs.map(|((k, needed, _), of)| (*needed, *k, of));
            let (needed, k, of) = needs.max_by(|a, b| a.0.total_cmp(&b.0)).expect("a joint");
            let time = recordings[motion.recording].times[k];
            CheckedMotion { name: motion.name.clone(), needed, joint: of.name.clone(), time }
        });
        let joints = self.joints.iter().enumerate().map(|(joint, of)| {
            let rows = recordings.iter().flat_map(|of| (0..of.times.len()).map(move |k| (of, k)));
            let speed = rows.map(|(of, k)| of.rates::<f64>(k, joint)[0].abs()).fold(0.0, f64::max);
            CheckedJoint {
                name: of.name.clone(),
                needed: found.iter().map(|joints| joints[joint].1).fold(0.0, f64::max),
                outside: found.iter().map(|joints| joints[joint].2).sum(),
                too_fast: (speed > of.largest_speed * (1.0 + AS_FAST)).then_some(speed),
            }
        });
        let joints: Vec<CheckedJoint> = joints.collect();
        let outside = joints.iter().map(|joint| joint.outside).sum();
        let positions = recordings.iter().map(|of| of.times.len() * of.joint_count()).sum();
        let motions = checked_motions.collect();
        Ok(TrackingCheck { conformant: outside == 0, positions, outside, motions, joints })
    }
}
