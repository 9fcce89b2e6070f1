use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Serialize;

use super::assignment::{Assignment, TorqueKind};
use super::dialect::Dialect;
use super::recognise::Units;
use crate::run::Run;

/// The interpretation of a log.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
pub struct Understood {
    /// Paths of its files.
    pub files: Vec<String>,
    /// The separator of columns: commas, semicolons, tabs or blanks.
    pub separator: &'static str,
    /// Number of samples.
    pub samples: usize,
    /// Duration, s.
    pub duration: f64,
    /// Names of the joints, in the order of the columns.
    pub joints: Vec<String>,
    /// Column of the time.
    pub time: String,
    /// Columns of the positions.
    pub q: Vec<String>,
    /// Columns of the commanded positions, where they were asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub command: Vec<String>,
    /// Columns of the velocities; empty if they were differentiated.
    pub qd: Vec<String>,
    /// Columns of the torques; empty if there is none.
    pub tau: Vec<String>,
    /// The kind of the torques: `measured`, `demanded`, `current` or `none`.
    pub torque: &'static str,
    /// Columns of the temperatures.
    pub temperature: Vec<String>,
    /// Columns that are not used.
    pub unused: Vec<String>,
    /// Unit of the time as written: s, ms, us or ns.
    pub time_unit: &'static str,
    /// Units of positions and velocities as written: rad or deg, and these per second.
    pub angle_units: [&'static str; 2],
    /// Motion per integral of the velocity in these units, near 1, where joints move.
    pub ratio: Option<f64>,
}

impl Understood {
    pub(super) fn new(
        files: &[PathBuf],
        dialect: &Dialect,
        assignment: &Assignment,
        units: Units,
        run: &Run,
    ) -> Self {
        let [q, command, qd, tau, temperature] = assignment
            .lists()
            .map(|(_, columns)| columns.iter().map(|column| column.text.clone()).collect());
        Self {
            files: files.iter().map(|file| file.display().to_string()).collect(),
            separator: dialect.separator_name(),
            samples: run.len(),
            duration: run.duration(),
            joints: assignment.joints.clone(),
            time: assignment.time[0].name.clone(),
            q,
            command,
            qd,
            tau,
            torque: match assignment.tau {
                None => "none",
                Some((_, TorqueKind::Measured)) => "measured",
                Some((_, TorqueKind::Demanded)) => "demanded",
                Some((_, TorqueKind::Current)) => "current",
            },
            temperature,
            unused: assignment.unused.clone(),
            time_unit: units.time.name(),
            angle_units: [units.q.name(), units.qd.name()],
            ratio: units.ratio,
        }
    }
}

impl Units {
    /// Describes what was recognised, where it is not the usual.
    pub(super) fn notes(&self, with_velocity: bool) -> impl Iterator<Item = String> {
        let time = (self.time.per_second() != 1)
            .then(|| format!("the times are in {}; they were changed to s", self.time.name()));
        let q = (self.q.per_radian() != 1.0)
            .then(|| "the positions are in degrees; they were changed to rad".to_string());
        let qd = (with_velocity && self.qd.per_radian() != 1.0)
            .then(|| "the velocities are in degrees/s; they were changed to rad/s".to_string());
        let contradiction = self.contradiction.map(|ratio| {
            format!(
                "with times in {} and angles in {}, the positions move {ratio:.3e} times as far as \
                 the integrals of the velocities; check these units and both columns",
                self.time.name(),
                self.q.name()
            )
        });
        let differentiated = (!with_velocity)
            .then(|| "there is no velocity; it is the derivative of the position".to_string());
        [time, q, qd, contradiction, differentiated].into_iter().flatten()
    }
}
