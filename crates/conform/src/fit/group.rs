use reachtube_recordings::Torque;
use serde::{Deserialize, Serialize};

use crate::data::setup::Setup;
use crate::error::{Error, Result};

/// A group of parameters of the nominal model that a fit may move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Group {
    /// The motor inertia of each joint and the density of each link: a link that is a body stays
    /// one, and the mass matrix stays positive definite. Gravity stays what it is.
    Inertia,
    /// Viscous friction v1 of each joint.
    Viscous,
    /// Quadratic and cubic viscous friction v2 and v3 of each joint. The truncation error of the
    /// model is taken off the input along the nominal motion.
    Cubic,
    /// Coulomb friction of each joint, by quadrant where the quadrants differ, along the nominal
    /// motion.
    Coulomb,
    /// The change of viscous and Coulomb friction with the temperature of the joints, where every
    /// recording has it; else the change of viscous friction with the order of the runs in their
    /// suite.
    WarmUp,
    /// A point mass at the origin of the last link's frame.
    Payload,
}

impl Group {
    /// All groups.
    pub(crate) const ALL: [Self; 6] =
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

impl FitSettings {
    /// Refuses what cannot be fitted, whatever the recordings are.
    ///
    /// # Errors
    ///
    /// [`Error::Fit`] for a weight of the pull that is no part, for a model whose error was
    /// bounded, and for friction and link torques.
    pub fn check(&self, setup: &Setup) -> Result<()> {
        let refused = |why: &str| Err(Error::Fit(why.into()));
        if let Some(pull) = self.pull.filter(|pull| !(0.0..=1.0).contains(pull)) {
            return refused(&format!(
                "the weight of the pull is {pull}; give a number from 0 to 1"
            ));
        }
        // The fit replaces the robot.
        if setup.settings.operating_box.is_some() {
            return refused(
                "the error of the model was bounded for the identified robot, and does not hold \
                 for another one; fit without the file of the abstraction",
            );
        }
        let is_friction = |group: &Group| {
            matches!(group, Group::Viscous | Group::Cubic | Group::Coulomb | Group::WarmUp)
        };
        if setup.settings.torque == Torque::Link && self.groups.iter().any(is_friction) {
            return refused("there is no friction in link torques; fit inertia or payload");
        }
        Ok(())
    }
}
