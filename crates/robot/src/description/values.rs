//! Descriptions with other parameter values.

use super::robot_description::RobotDescription;
use crate::error::RobotError;
use crate::inertia::INERTIAL;
use crate::parameter::{Parameter, ParameterKind};
use crate::robot::Robot;

impl RobotDescription {
    /// Returns the description with other values of these parameters, each in its SI unit. All
    /// other parameters keep their values.
    ///
    /// Links that change get a first moment and an inertia about the origin of their frame. Coulomb
    /// friction that changes loses its dependence on the load, and friction its standard errors.
    /// The new values are not checked; [`Robot::from_description`] does that. Links that are no
    /// bodies need [`ParameterSet::Base`](crate::ParameterSet::Base).
    ///
    /// # Errors
    ///
    /// Returns the error of [`Robot::from_description`] for the description before the change.
    ///
    /// # Panics
    ///
    /// Panics if there are fewer values than parameters, or if the joint of a parameter does not
    /// exist.
    pub fn with_values(
        &self,
        parameters: &[Parameter],
        values: &[f64],
    ) -> Result<Self, RobotError> {
        let robot = Robot::from_description(self)?;
        let kinds = [ParameterKind::Coulomb, ParameterKind::Offset];
        let all = Parameter::of_joints(self.joints.len(), &kinds);
        let mut coulomb = robot.parameter_values(&all);
        let mut inertial = robot.inertial_parameters();
        let mut out = self.clone();
        for (p, &value) in parameters.iter().zip(&values[..parameters.len()]) {
            let joint = &mut out.joints[p.joint];
            match p.kind {
                ParameterKind::MotorInertia => joint.set_armature(value),
                ParameterKind::Viscous1 => joint.friction.viscous[0] = value,
                ParameterKind::Viscous2 => joint.friction.viscous[1] = value,
                ParameterKind::Viscous3 => joint.friction.viscous[2] = value,
                ParameterKind::Coulomb => coulomb[2 * p.joint] = value,
                ParameterKind::Offset => coulomb[2 * p.joint + 1] = value,
                kind => inertial[INERTIAL * p.joint + kind as usize] = value,
            }
            if p.kind.is_inertial() {
                joint.set_inertial(&inertial[INERTIAL * p.joint..]);
            } else if matches!(p.kind, ParameterKind::Coulomb | ParameterKind::Offset) {
                let (f, o) = (coulomb[2 * p.joint], coulomb[2 * p.joint + 1]);
                joint.friction.coulomb = [o + f, 0.0, o - f, 0.0, o - f, 0.0, o + f, 0.0];
            }
            if joint.friction != self.joints[p.joint].friction {
                joint.friction.standard_errors = None;
            }
        }
        Ok(out)
    }
}
