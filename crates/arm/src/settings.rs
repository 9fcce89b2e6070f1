use reachtube_abstraction::{Abstraction, ExpansionPoint};
use reachtube_recordings::Torque;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Time in which an acceleration dies out to 1/e, s.
const DECAY: f64 = 0.2;

/// Which equations the nominal motions satisfy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Equations {
    /// The model's: U covers the model error.
    #[default]
    Model,
    /// The robot's own (docs/method.md, section 3). The model, which is linear, describes the
    /// deviations from that motion only.
    Robot,
    /// None: the velocity stays what it was at the start. Positions alone drive such a model, and
    /// U is a set of accelerations.
    Velocity,
    /// None: the acceleration at the start, which is known from the motion before, dies out with a
    /// time constant of 0.2 s.
    Decaying,
    /// None: the acceleration at the start stays.
    Held,
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
    /// The equations without a robot and its torque.
    pub const KINEMATIC: [Self; 3] = [Self::Velocity, Self::Decaying, Self::Held];

    /// Returns whether they know neither the robot nor its torque.
    #[must_use]
    pub fn is_kinematic(self) -> bool {
        Self::KINEMATIC.contains(&self)
    }

    /// Returns what is left of the acceleration at the start at a time \[s\] after it, as a part.
    pub(crate) fn part_left(self, time: f64) -> f64 {
        match self {
            Self::Decaying => (-time / DECAY).exp(),
            Self::Held => 1.0,
            Self::Model | Self::Robot | Self::Velocity => 0.0,
        }
    }

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
