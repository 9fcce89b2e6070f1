use reachtube_abstraction::{PolynomialModel, Records, TermRecord};
use reachtube_reach::System;
use reachtube_robot::RobotDescription;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::arm::Arm;
use crate::correction::InputCorrection;
use crate::settings::ArmSettings;
use crate::system::polynomials;

/// What drives the system of a model: the robot, and what the file needs to make its model again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "the record of an arm")]
pub struct DriveRecord {
    /// The robot. What else it has seen since, [`ArmModel::robot`](crate::ArmModel::robot) adds.
    pub robot: RobotDescription,
    /// What the recorded torques are, and the model that was selected.
    pub settings: ArmSettings,
    /// What is taken off the recorded inputs along the nominal motions, where anything is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correction: Option<InputCorrection>,
    /// Names of the variables of the polynomials of a model that is not linear, as in the file of
    /// an abstraction.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) variables: Vec<String>,
    /// What the polynomials' variables are offsets from.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) origin: Vec<f64>,
    /// For each joint, the terms of its acceleration, rad/s².
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) acceleration: Vec<Vec<TermRecord>>,
}

impl DriveRecord {
    /// Writes down an arm, and the polynomials of its model where that is not linear.
    pub(crate) fn new(arm: &Arm, system: &System) -> Self {
        let records = polynomials(system).map(PolynomialModel::records).unwrap_or_default();
        let Records { variables, origin, acceleration } = records;
        let Arm { correction, settings, .. } = arm.clone();
        let robot = arm.robot().description().clone();
        Self { robot, settings, correction, variables, origin, acceleration }
    }

    /// Returns the polynomials, bit by bit; `None` for a linear model.
    pub(crate) fn polynomials(&self) -> Option<Records> {
        let Self { variables, origin, acceleration, .. } = self;
        (!acceleration.is_empty()).then(|| Records {
            variables: variables.clone(),
            origin: origin.clone(),
            acceleration: acceleration.clone(),
        })
    }
}
