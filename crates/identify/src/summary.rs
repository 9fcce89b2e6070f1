use super::{
    BaseParameter, Gain, GravityFit, Identification, JointFit, JointFriction, LogValidation,
    PhysicalFit, WindowErrors,
};
use reachtube_robot::RobotDescription;
use serde::Serialize;

/// An identification as `--json` prints it.
#[derive(Debug, Serialize)]
pub struct Summary<'a> {
    /// The robot that was found.
    pub robot: &'a RobotDescription,
    /// How the recordings were changed.
    pub changes: &'a [String],
    /// Speeds below which torque was not used \[rad/s\].
    pub slow: &'a [f64],
    /// Gravity.
    pub gravity: &'a Option<GravityFit>,
    /// Friction.
    pub friction: Vec<&'a JointFriction>,
    /// How well the torque of exciting motions was fitted, joint by joint.
    pub inertia: &'a [JointFit],
    /// The combinations that torque shows.
    pub parameters: &'a [BaseParameter],
    /// Condition of their regression, columns scaled to unit length.
    pub condition: f64,
    /// What it costs that every link is a body.
    pub physical: &'a Option<PhysicalFit>,
    /// Gains of the joints' torque against each other.
    pub gains: &'a [Gain],
    /// Torque on recordings kept back.
    pub validation: &'a [LogValidation],
    /// Whether they were kept back.
    pub kept_back: bool,
    /// Forward simulations.
    pub windows: &'a [WindowErrors],
    /// What looks wrong or could not be done.
    pub warnings: &'a [String],
}

impl Identification {
    /// What `--json` prints.
    pub fn summary(&self) -> Summary<'_> {
        Summary {
            robot: &self.description,
            changes: &self.changes,
            slow: &self.slow,
            gravity: &self.gravity,
            friction: self.friction.iter().map(|fit| &fit.joint).collect(),
            inertia: &self.inertia.joints,
            parameters: &self.inertia.parameters,
            condition: self.inertia.condition,
            physical: &self.inertia.physical,
            gains: &self.gains,
            validation: &self.validation,
            kept_back: self.kept_back,
            windows: &self.windows,
            warnings: &self.warnings,
        }
    }

    /// The robot that was found as a file that `conform` reads.
    pub fn robot_toml(&self) -> String {
        toml::to_string(&self.description).expect("a description has string keys")
    }
}
