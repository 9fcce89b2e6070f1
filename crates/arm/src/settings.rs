use reachtube_abstraction::{Abstraction, ExpansionPoint};
use reachtube_recordings::Torque;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Whose equations of motion the nominal motions satisfy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Equations {
    /// The model's: U covers the model error.
    #[default]
    Model,
    /// The robot's own (docs/method.md, section 3). The model, which is linear, describes the
    /// deviations from that motion only.
    Robot,
}

/// What decides how an arm drives the model of its motion along recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ArmSettings {
    /// The kind of the recorded torques.
    pub torque: Torque,
    /// Which of the paper's models.
    pub abstraction: Abstraction,
    /// Where the model is expanded.
    pub expansion_point: ExpansionPoint,
    /// Whose equations of motion nominal motions satisfy.
    #[serde(default, skip_serializing_if = "Equations::is_model")]
    pub equations: Equations,
}

impl Equations {
    fn is_model(&self) -> bool {
        *self == Self::Model
    }
}

impl ArmSettings {
    /// Returns the defaults for a robot of `joints` joints whose recordings hold `torque`.
    #[must_use]
    pub fn new(torque: Torque, joints: usize) -> Self {
        let (abstraction, equations) = Default::default();
        Self { torque, abstraction, expansion_point: ExpansionPoint::zero(joints), equations }
    }
}
