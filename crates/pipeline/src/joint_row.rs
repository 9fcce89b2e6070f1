use schemars::JsonSchema;
use serde::Serialize;

use crate::build::Built;

/// The set of one joint's position at the horizon, beside the joint's motion.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct JointRow {
    /// The joint's name.
    pub name: String,
    /// Half the width of the set, rad (m); `None` if the reachable set was lost.
    pub half_width: Option<f64>,
    /// Displacement of the joint in a window, root mean square, and at least 5 % of its range, rad
    /// (m).
    pub displacement: f64,
    /// Half the width by the displacement; `None` if the reachable set was lost.
    pub ratio: Option<f64>,
    /// The factor by which the set would have to grow where a motion that was held out leaves it
    /// furthest; `None` if none could be compared.
    pub growth: Option<f64>,
    /// By which factor the set is narrower than without a model, both as wide as a motion needs
    /// them that was left out; `None` if none was compared.
    pub narrower: Option<f64>,
}

impl Built {
    /// Returns the set of each joint at the horizon.
    #[must_use]
    pub fn joints(&self) -> Vec<JointRow> {
        let model = &self.answer.model;
        let widths = model.usefulness.iter().flat_map(|said| &said.parts).enumerate();
        let narrower = |joint: usize| {
            let without = self.without_model.as_ref()?;
            Some(without.narrower[joint]).filter(|factor| factor.is_finite())
        };
        let row = |(joint, width): (usize, &reachtube_conform::plausibility::PartWidth)| {
            let growth = self.held_out.growth[joint];
            JointRow {
                name: model.signals.parts[joint].name.clone(),
                half_width: width.half_width,
                displacement: width.displacement,
                ratio: width.half_width.map(|_| width.ratio()),
                growth: growth.is_finite().then_some(growth),
                narrower: narrower(joint),
            }
        };
        widths.map(row).collect()
    }
}
