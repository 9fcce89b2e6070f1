//! Limits of velocity and acceleration that the motions reach.

use reachtube_conform::SuiteReach;
use reachtube_files::{MARK, TOOL};
use reachtube_robot::Robot;

use super::file::{ShieldFile, marked};
use super::yaml::Yaml;
use crate::export::text::{comment, harmless, number};
use crate::export::{ExportError, ExportFile};

/// A joint below this speed \[rad/s\] or acceleration \[rad/s²\] rests.
const REST: f64 = 1e-6;

/// The largest velocities and accelerations of the nominal motions, by which a model was judged.
#[derive(Debug, Clone, PartialEq)]
pub struct Covered {
    /// Largest speed of each joint \[rad/s\], n, rounded down.
    pub velocity: Vec<f64>,
    /// Largest acceleration of each joint \[rad/s²\], n, between two samples, rounded down.
    pub acceleration: Vec<f64>,
}

impl Covered {
    /// Takes what the nominal motions reach.
    pub(super) fn new(robot: &Robot, reached: &[SuiteReach]) -> Self {
        let n = robot.joint_count();
        let (mut velocity, mut acceleration) = (vec![0.0_f64; n], vec![0.0_f64; n]);
        for reach in reached {
            let rows: Vec<&[f64]> =
                reach.nominal.chunks_exact(2 * n).map(|row| &row[n..]).collect();
            for (k, row) in rows.iter().enumerate() {
                for j in 0..n {
                    velocity[j] = velocity[j].max(row[j].abs());
                    if k > 0 {
                        let change = (row[j] - rows[k - 1][j]).abs();
                        let step = reach.times[k] - reach.times[k - 1];
                        acceleration[j] = acceleration[j].max(change / step);
                    }
                }
            }
        }
        let down = |values: Vec<f64>| values.iter().map(|x| (x * 1e6).floor() / 1e6).collect();
        Self { velocity: down(velocity), acceleration: down(acceleration) }
    }

    /// Returns the shield's file of trajectories, in which no limit is above what is covered.
    ///
    /// # Errors
    ///
    /// [`ExportError::Refused`] for a file without the limits, and for a joint that rests.
    pub(super) fn file(&self, robot: &Robot, file: &ShieldFile) -> Result<ExportFile, ExportError> {
        for (j, joint) in robot.joints().iter().enumerate() {
            if self.velocity[j] < REST || self.acceleration[j] < REST {
                return Err(ExportError::Refused {
                    place: format!("{}: joint {}", file.name, joint.name),
                    problem: "it rests in these recordings, so no limit of its motion is covered"
                        .into(),
                    remedy: "add suites in which it moves, or leave this file out".into(),
                });
            }
        }
        let mut changed = file.clone();
        let limits = [
            ("v_max_allowed", &self.velocity),
            ("a_max_allowed", &self.acceleration),
            ("a_max_ltt", &self.acceleration),
        ];
        for (key, covered) in limits {
            let yaml = Yaml::new(&changed);
            let old = yaml.numbers(key, robot.joint_count())?;
            let new: Vec<String> =
                old.iter().zip(covered).map(|(old, covered)| number(old.min(*covered))).collect();
            changed.text = yaml.with_numbers(key, &new.join(", "))?;
        }
        let lines = [
            format!("{MARK} ({TOOL}): limits of {}.", harmless(robot.name())),
            "No entry of v_max_allowed, a_max_allowed and a_max_ltt is above what the nominal \
             motions reach for which secure_radius is proved; all else is as it was."
                .into(),
        ];
        Ok(ExportFile::new(&file.name, marked(&comment("#", &lines), &changed.text)))
    }
}
