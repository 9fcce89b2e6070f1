use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A group of parameters of the nominal model that a fit may move.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Group {
    /// The motor inertia of each part and the density of each link: a link that is a body stays
    /// one, and the mass matrix stays positive definite. Gravity stays what it is.
    Inertia,
    /// Viscous friction v1 of each part.
    Viscous,
    /// Quadratic and cubic viscous friction v2 and v3 of each part. The truncation error of the
    /// model is subtracted from the input along the nominal motion.
    Cubic,
    /// Coulomb friction of each part, by quadrant where the quadrants differ, along the nominal
    /// motion.
    Coulomb,
    /// The change of viscous and Coulomb friction with the temperature of the parts, where every
    /// recording has it; else the change of viscous friction with the order of the runs in their
    /// suite.
    WarmUp,
    /// A point mass at the origin of the last link's frame.
    Payload,
}

impl Group {
    /// All groups.
    pub const ALL: [Self; 6] =
        [Self::Inertia, Self::Viscous, Self::Cubic, Self::Coulomb, Self::WarmUp, Self::Payload];

    /// Returns the name of the group, as users write it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Inertia => "inertia",
            Self::Viscous => "viscous",
            Self::Cubic => "cubic",
            Self::Coulomb => "coulomb",
            Self::WarmUp => "warm-up",
            Self::Payload => "payload",
        }
    }
}

/// What a fit may move, and how strongly it is pulled toward the identified values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitSettings {
    /// The groups of parameters.
    pub groups: Vec<Group>,
    /// The weight of the pull: part of the identified model's cost per unit of the logarithm of a
    /// factor, or of half the logarithm for inertia. It is chosen by leaving one motion out where
    /// it is `None`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pull: Option<f64>,
}
