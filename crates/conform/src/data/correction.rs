use serde::{Deserialize, Serialize};

/// What is taken off the recorded input along the nominal motion, sample by sample, beyond what the
/// model's own equations contain: friction and the weight of a payload.
///
/// At each sample the correction is evaluated at the nominal state, and the corrected input is held
/// until the next sample. The reachable set is the model's, around this nominal motion.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputCorrection {
    /// Friction of each joint, n entries.
    pub joints: Vec<JointCorrection>,
    /// A point mass at the origin of the last link's frame whose weight the recorded inputs do not
    /// carry, kg.
    #[serde(default)]
    pub payload: f64,
}

/// The friction of one joint that is taken off the input. N in place of N m, m in place of rad for
/// a prismatic joint.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointCorrection {
    /// Viscous friction quadratic in the velocity's offset from the expansion point,
    /// N m s²/rad².
    #[serde(default)]
    pub quadratic: f64,
    /// Viscous friction cubic in that offset, N m s³/rad³.
    #[serde(default)]
    pub cubic: f64,
    /// Coulomb friction beyond the robot's own, in parts of it: driving forward, driving backward,
    /// braking backward, braking forward.
    #[serde(default)]
    pub coulomb: [f64; 4],
    /// Change of viscous friction with the natural logarithm of the run's place in the order of
    /// its suite, from 1, N m s/rad.
    #[serde(default)]
    pub warm_up: f64,
}

impl InputCorrection {
    /// Returns the correction that changes nothing.
    #[must_use]
    pub(crate) fn none(joints: usize) -> Self {
        Self { joints: vec![JointCorrection::default(); joints], payload: 0.0 }
    }

    /// Returns whether runs that share their recorded input may differ in their nominal motion.
    #[must_use]
    pub(crate) fn differs_by_run(&self) -> bool {
        self.joints.iter().any(|joint| joint.warm_up != 0.0)
    }

    /// Returns whether all numbers are finite and there is one entry per joint.
    #[must_use]
    pub(crate) fn is_valid_for(&self, joints: usize) -> bool {
        let finite = |joint: &JointCorrection| {
            let JointCorrection { quadratic, cubic, coulomb, warm_up } = joint;
            [quadratic, cubic, warm_up].into_iter().chain(coulomb).all(|x| x.is_finite())
        };
        self.joints.len() == joints && self.joints.iter().all(finite) && self.payload.is_finite()
    }
}
