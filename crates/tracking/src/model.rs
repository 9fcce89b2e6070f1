//! The model file of an arm under its controller.

use std::path::Path;

use reachtube_files::{FileHead, SealedFile};
use reachtube_recordings::{Axis, ColumnSettings, LogSettings};
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_down, mul_down};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::basis::{TERMS, enclosed_direction};
use crate::error::{Error, Result};
use crate::recording::{Reading, TrackedRun};

/// What the field `format` of every file says.
pub(crate) const FORMAT: &str = "reachtube-tracking-model";

/// The version of the format.
pub(crate) const VERSION: u32 = 2;

/// A model of an arm under its controller: at each sample, the actual position y of each joint
/// satisfies |y - r - c - l ṙ - a r̈ - s d(ṙ)| <= ρ0 + ρ1 |ṙ|, where r is the command of a delay
/// before. The parabola through the sample and its neighbours has the speed ṙ and the acceleration
/// r̈; d is the direction of the command, from -1 to 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TrackingModel {
    /// The name of the format, "reachtube-tracking-model".
    #[schemars(extend("const" = FORMAT))]
    pub format: String,
    /// The version of the format.
    #[schemars(extend("const" = VERSION))]
    pub version: u32,
    /// Name and version of the program that wrote the file.
    pub tool: String,
    /// Whether every sample was proved to lie in the sets, with directed rounding.
    pub verified: bool,
    /// The delay of the command, the same for all joints, s.
    pub delay: f64,
    /// The joints.
    pub joints: Vec<JointTracking>,
    /// The links, if the robot was known that has the joints.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub links: Vec<LinkTracking>,
    /// The factor of the sets: the largest by which the smallest sets of other motions had to grow
    /// for a motion, over all joints.
    pub factor: f64,
    /// The usual time between two samples, of the recording that has the longest, s.
    pub step: f64,
    /// The motions that decided the factor, and how it was found.
    pub left_out: NeedsOfMotions,
    /// The recordings.
    pub recordings: Vec<RunOfModel>,
    /// Columns whose names do not tell, with which other logs are read too.
    #[serde(default, skip_serializing_if = "is_default")]
    pub columns: ColumnSettings,
    /// Topics and times of MCAP and rosbag2 logs, and names of joints in logs, with which others
    /// are read too.
    #[serde(default, skip_serializing_if = "is_default")]
    pub log: LogSettings,
    /// SHA-256 of the rest of the file's content, so that a change is noticed.
    pub sha256: String,
}

/// What a joint does with its command.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointTracking {
    /// The name of the joint.
    pub name: String,
    /// The unit of its position: rad, or m.
    pub unit: String,
    /// The offset c, rad.
    pub offset: f64,
    /// The factor l of the commanded speed, s; a joint that comes late has a negative one.
    pub speed: f64,
    /// The factor a of the commanded acceleration, s².
    pub acceleration: f64,
    /// The factor s of the direction of the command, rad: what friction takes.
    pub direction: f64,
    /// The half-width ρ0 of the set at rest with its factor, rad.
    pub radius: f64,
    /// By how much it grows with the commanded speed, ρ1 with its factor, s.
    pub radius_per_speed: f64,
    /// The highest commanded speed of the recordings, rad/s. The sets are not for faster ones.
    pub largest_speed: f64,
    /// The highest commanded acceleration of the recordings, rad/s².
    pub largest_acceleration: f64,
    /// The largest recorded |y - r|, rad.
    pub largest_error: f64,
    /// The largest recorded change of y minus the nominal position from one sample to the next,
    /// rad.
    pub largest_change: f64,
}

/// How far a link strays in the recorded poses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinkTracking {
    /// The joint that moves the link.
    pub joint: String,
    /// How far the axis of the link stays from where the nominal positions have it, with the
    /// factor, m.
    pub radius: f64,
    /// The factor: the largest by which the largest distance of the other motions had to grow for a
    /// motion.
    pub factor: f64,
    /// The largest recorded distance from where the command has it, m.
    pub largest_error: f64,
}

/// How the motions were used that the factor comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NeedsOfMotions {
    /// The number of motions.
    pub motions: usize,
    /// The number of recordings that neither fit nor choice have seen and that the factor comes
    /// from; `None` if each motion was left out in turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub calibrated: Option<usize>,
    /// The motion that needed the largest factor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub furthest: Option<String>,
    /// The number of motions inside sets and factor that are found without them; `None` if that
    /// was not tried.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inside: Option<usize>,
}

/// A recording that a model was made of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RunOfModel {
    /// The file.
    pub file: String,
    /// The SHA-256 of its files; of its rows, if a file has several recordings; or of the positions
    /// that a log has in messages.
    pub sha256: String,
    /// The number of its samples.
    pub samples: usize,
    /// The number of samples that were set aside.
    pub set_aside: usize,
}

impl JointTracking {
    fn factors(&self) -> [f64; TERMS] {
        [self.offset, self.speed, self.acceleration, self.direction]
    }

    /// Returns the actual position at sample `k` of a recording minus the nominal one, and the
    /// half-width of the set there.
    ///
    /// # Guarantee
    ///
    /// The position is enclosed, and the half-width a lower bound; directed rounding.
    pub(crate) fn beside(&self, recording: &TrackedRun, k: usize, joint: usize) -> (Interval, f64) {
        let at = k * recording.joint_count() + joint;
        let rates = recording.rates::<Interval>(k, joint);
        self.rest([recording.command[at], recording.actual[at]], rates)
    }

    /// Returns an actual position minus the nominal one at a commanded one, and the half-width of
    /// the set there, as [`beside`](Self::beside) does.
    pub(crate) fn rest(
        &self,
        [command, actual]: [f64; 2],
        rates: [Interval; 2],
    ) -> (Interval, f64) {
        let nominal = self.nominal(Interval::point(command), rates);
        let growth = mul_down(self.radius_per_speed, rates[0].mig());
        (Interval::point(actual) - nominal, add_down(self.radius, growth))
    }

    /// Encloses the nominal position at a commanded one, with its speed and acceleration.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(crate) fn nominal(
        &self,
        command: Interval,
        [speed, acceleration]: [Interval; 2],
    ) -> Interval {
        let direction = enclosed_direction(speed, self.largest_speed);
        let terms = [Interval::ONE, speed, acceleration, direction];
        let pairs = terms.into_iter().zip(self.factors());
        let pairs = pairs.filter(|(_, factor)| *factor != 0.0);
        pairs.fold(command, |sum, (term, factor)| sum + term * factor)
    }

    /// Returns the half-width of the set at a commanded speed \[rad/s\], rad.
    #[must_use]
    pub fn half_width(&self, speed: f64) -> f64 {
        self.radius + self.radius_per_speed * speed.abs()
    }

    /// Returns the "largest error + 20 %" that a user has without a model, rad.
    #[must_use]
    pub fn without_model(&self) -> f64 {
        1.2 * self.largest_error
    }
}

impl TrackingModel {
    /// Returns the mean over the joints of the half-widths at their highest speeds, rad.
    #[must_use]
    pub fn mean_half_width(&self) -> f64 {
        mean(self.joints.iter().map(|joint| joint.half_width(joint.largest_speed)))
    }

    /// Returns the mean over the joints of the largest error + 20 %, rad.
    #[must_use]
    pub fn mean_without_model(&self) -> f64 {
        mean(self.joints.iter().map(JointTracking::without_model))
    }

    /// Returns whether the sets are proved, say something of other motions, and are narrower than
    /// what the logs alone give.
    #[must_use]
    pub fn is_useful(&self) -> bool {
        self.verified && self.has_motions() && self.mean_half_width() < self.mean_without_model()
    }

    /// Returns whether there are enough motions to say something of others.
    #[must_use]
    pub fn has_motions(&self) -> bool {
        self.left_out.motions >= 3
    }

    /// Refuses a recording or a robot of other joints.
    ///
    /// # Errors
    ///
    /// [`Error::OtherJoints`].
    pub fn refuse_other(&self, file: &Path, joints: &[String]) -> Result<()> {
        let of_model: Vec<String> = self.joints.iter().map(|joint| joint.name.clone()).collect();
        if joints == of_model {
            return Ok(());
        }
        Err(Error::OtherJoints { file: file.into(), joints: joints.to_vec(), of_model })
    }

    /// Returns the model of recordings that were read with some columns, topics and names.
    #[must_use]
    pub fn read_with(self, columns: ColumnSettings, log: LogSettings) -> Self {
        Self { columns, log, ..self }.sealed()
    }

    /// Returns how other logs are read: as the ones of the model, for the axes of its joints.
    #[must_use]
    pub fn reading<'a>(&'a self, axes: &'a [Axis]) -> Reading<'a> {
        Reading { axes: Some(axes), columns: &self.columns, log: &self.log, until: None }
    }

    /// Returns the joints, by which the columns of other logs are found.
    #[must_use]
    pub fn axes(&self) -> Vec<Axis> {
        let axis = |joint: &JointTracking| Axis {
            name: joint.name.clone(),
            is_revolute: joint.unit == "rad",
            units: if joint.unit == "rad" { ["rad", "rad/s", "N m"] } else { ["m", "m/s", "N"] },
            position_limits: None,
            velocity_limit: None,
        };
        self.joints.iter().map(axis).collect()
    }
}

impl SealedFile for TrackingModel {
    const FORMAT: &'static str = FORMAT;
    const VERSION: u32 = VERSION;
    const COMMAND: &'static str = "model";

    fn head(&mut self) -> FileHead<'_> {
        let Self { format, version, tool, sha256, .. } = self;
        FileHead { format, version, tool, sha256 }
    }

    fn check_content(&self) -> Result<(), String> {
        let numbers = self.joints.iter().flat_map(|joint| {
            let JointTracking { radius, radius_per_speed, largest_speed, .. } = *joint;
            let sizes = [radius, radius_per_speed, largest_speed, joint.largest_change];
            joint.factors().into_iter().chain(sizes)
        });
        match self.joints.is_empty()
            || !numbers.chain([self.factor, self.step, self.delay]).all(f64::is_finite)
        {
            true => Err("it has no joints, or numbers that are not finite".into()),
            false => Ok(()),
        }
    }
}

fn is_default<T: Default + PartialEq>(settings: &T) -> bool {
    *settings == T::default()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}
