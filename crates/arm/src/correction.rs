use reachtube_conform::data::Condition;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Torque subtracted from the recorded input along the nominal motion, sample by sample, beyond
/// what the model's own equations contain: friction and the weight of a payload.
///
/// At each sample the correction is evaluated at the nominal state, and the corrected input is held
/// until the next sample. The reachable set is the model's, around this nominal motion.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InputCorrection {
    /// Friction of each joint, n entries.
    pub joints: Vec<JointCorrection>,
    /// A point mass at the origin of the last link's frame whose weight the recorded inputs do not
    /// carry, kg.
    #[serde(default)]
    pub payload: f64,
    /// The temperatures above which warm-up counts, n, °C: the warmth of a joint is its temperature
    /// less this one, K. If it is `None`, the warmth is the natural logarithm of the run's place in
    /// the order of its suite, from 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_temperatures: Option<Vec<f64>>,
}

/// The friction of one joint that is subtracted from the input. N in place of N m, m in place of
/// rad for a prismatic joint.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
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
    /// Change of viscous friction per unit of warmth, N m s/rad; per K for temperatures.
    #[serde(default)]
    pub warm_up: f64,
    /// Change of Coulomb friction per unit of warmth, in parts of the robot's own; per K for
    /// temperatures.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub warm_up_coulomb: f64,
}

impl InputCorrection {
    /// Returns the correction that changes nothing.
    #[must_use]
    pub(crate) fn none(joints: usize) -> Self {
        Self { joints: vec![JointCorrection::default(); joints], ..Self::default() }
    }

    /// Returns whether runs that share their recorded input may differ in their nominal motion.
    #[must_use]
    pub fn differs_by_run(&self) -> bool {
        self.joints.iter().any(|joint| joint.warm_up != 0.0 || joint.warm_up_coulomb != 0.0)
    }

    /// Returns the warmth of each joint in a condition, n: 0 if a temperature is needed and was not
    /// recorded.
    #[must_use]
    pub(crate) fn warmth(&self, condition: &Condition) -> Vec<f64> {
        let n = self.joints.len();
        match (&self.reference_temperatures, &condition.temperatures) {
            (None, _) => vec![(condition.place as f64).ln(); n],
            (Some(_), None) => vec![0.0; n],
            (Some(reference), Some(own)) => own.iter().zip(reference).map(|(t, r)| t - r).collect(),
        }
    }

    /// Returns whether all numbers are finite and there is one entry per joint.
    #[must_use]
    pub(crate) fn is_valid_for(&self, joints: usize) -> bool {
        let finite = |joint: &JointCorrection| {
            let JointCorrection { quadratic, cubic, coulomb, warm_up, warm_up_coulomb } = joint;
            [quadratic, cubic, warm_up, warm_up_coulomb]
                .into_iter()
                .chain(coulomb)
                .all(|x| x.is_finite())
        };
        let fits = |reference: &Vec<f64>| {
            reference.len() == joints && reference.iter().all(|x| x.is_finite())
        };
        self.joints.len() == joints
            && self.joints.iter().all(finite)
            && self.payload.is_finite()
            && self.reference_temperatures.as_ref().is_none_or(fits)
    }
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
