use crate::fit::JointFit;
use crate::friction::falling::FallingFriction;
use crate::friction::fit::JointFriction;
use crate::gravity::fit::GravityFit;
use crate::identification::Identification;
use crate::inertia::base::BaseParameter;
use crate::inertia::diagonal::JointInertia;
use crate::inertia::physical::PhysicalFit;
use crate::plausibility::gain::Gain;
use crate::plausibility::offset::PositionOffset;
use crate::validate::simulation::WindowErrors;
use crate::validate::torque::LogValidation;
use reachtube_robot::RobotDescription;
use schemars::JsonSchema;
use serde::Serialize;

/// The part of an identification that `reachtube identify --json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Summary<'a> {
    /// Description of the identified robot.
    pub robot: &'a RobotDescription,
    /// Changes to the recordings, one sentence each.
    pub changes: &'a [String],
    /// Speeds below which torque was not used \[rad/s\], one entry per joint.
    pub slow: &'a [f64],
    /// The gravity fit.
    pub gravity: &'a Option<GravityFit>,
    /// The fitted friction of joints with a fit.
    pub friction: Vec<&'a JointFriction>,
    /// Quality of the fit to exciting motions, one entry per joint.
    pub inertia: &'a [JointFit],
    /// The identifiable combinations of parameters.
    pub parameters: &'a [BaseParameter],
    /// Number of combinations that the recordings determine.
    pub determined: usize,
    /// Condition number of the recorded motions, relative to a motion through all positions.
    #[schemars(with = "Option<f64>")]
    pub condition: f64,
    /// The inertia that each joint feels, with its standard error.
    pub diagonal: &'a [JointInertia],
    /// Effect of the constraint that every link is physically consistent.
    pub physical: &'a Option<PhysicalFit>,
    /// Viscous friction of least squares that falls with speed and was not used, of the fit to
    /// exciting motions.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pub falling: &'a [FallingFriction],
    /// Gains of the joints' torques relative to each other.
    pub gains: &'a [Gain],
    /// Offsets of the joints' positions that explain the torque best; empty for too few samples.
    pub offsets: &'a [PositionOffset],
    /// Errors of the predicted torque in the validation recordings.
    pub validation: &'a [LogValidation],
    /// Whether there were validation recordings, to which nothing was fitted.
    pub held_out: bool,
    /// Errors of forward simulations, one entry per duration.
    pub windows: &'a [WindowErrors],
    /// Warnings about implausible results and steps that were not possible.
    pub warnings: &'a [String],
}

impl Identification {
    /// Returns what `reachtube identify --json` prints.
    #[must_use]
    pub fn summary(&self) -> Summary<'_> {
        Summary {
            robot: &self.description,
            changes: &self.changes,
            slow: &self.slow,
            gravity: &self.gravity,
            friction: self.friction.iter().map(|fit| &fit.joint).collect(),
            inertia: &self.inertia.joints,
            parameters: &self.inertia.parameters,
            determined: self.inertia.determined,
            condition: self.inertia.condition,
            diagonal: &self.inertia.diagonal,
            physical: &self.inertia.physical,
            falling: &self.inertia.falling,
            gains: &self.gains,
            offsets: &self.offsets,
            validation: &self.validation,
            held_out: self.held_out,
            windows: &self.windows,
            warnings: &self.warnings,
        }
    }

    /// Returns the identified robot as the text of a robot file that `reachtube conform` reads.
    #[must_use]
    pub fn robot_toml(&self) -> String {
        toml::to_string(&self.description).expect("the keys of a description are strings")
    }
}
