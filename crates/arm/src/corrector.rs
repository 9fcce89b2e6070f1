//! The correction of the input, evaluated at one state after another without allocation.

use std::sync::Arc;

use reachtube_conform::data::Condition;
use reachtube_conform::{Error, Result};
use reachtube_recordings::Torque;
use reachtube_robot::{InertiaPoint, ParameterSet, Robot, RobotDescription, Workspace};

use crate::arm::Arm;
use crate::correction::{InputCorrection, JointCorrection};
use crate::loads::LoadsNear;

/// Evaluates a correction for one robot.
#[derive(Debug, Clone)]
pub(super) struct Corrector {
    robot: Arc<Robot>,
    correction: InputCorrection,
    /// The velocities of the expansion point, n.
    origin: Vec<f64>,
    /// The warmth of each joint as the correction counts it, n.
    warmth: Vec<f64>,
    /// Coulomb friction of each joint beyond the robot's own, in parts of it, n.
    coulomb: Vec<[f64; 4]>,
    /// The robot as warm as it is in this run, where its own friction changes.
    warm: Option<Robot>,
    /// Whether the recorded input is free of the dry friction of a cold robot.
    is_compensated: bool,
    has_coulomb: bool,
    /// A robot that only has a mass of 1 kg at its tip.
    unit_payload: Option<Robot>,
    workspace: Workspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    torque: Vec<f64>,
}

impl Corrector {
    /// Prepares a correction of an arm in one condition.
    ///
    /// # Errors
    ///
    /// When no robot can be made with a payload only.
    pub(super) fn new(
        arm: &Arm,
        correction: &InputCorrection,
        condition: &Condition,
    ) -> Result<Self> {
        let (robot, n) = (arm.robot(), arm.robot().joint_count());
        let warmth = correction.warmth(condition);
        let warm_parts = |(joint, warmth): (&JointCorrection, &f64)| {
            joint.coulomb.map(|part| part + joint.warm_up_coulomb * warmth)
        };
        let coulomb: Vec<_> = correction.joints.iter().zip(&warmth).map(warm_parts).collect();
        let has_coulomb = coulomb.iter().any(|parts| *parts != [0.0; 4]);
        let unit_payload = match correction.payload {
            0.0 => None,
            _ => Some(
                Robot::from_description(&only_payload(robot.description()))
                    .map_err(Error::other)?,
            ),
        };
        let zeros = || vec![0.0; n];
        Ok(Self {
            robot: Arc::clone(&arm.robot),
            correction: correction.clone(),
            origin: arm.settings.expansion_point.qd.clone(),
            warmth,
            coulomb,
            warm: arm.warm(condition),
            is_compensated: arm.settings.torque == Torque::Compensated,
            has_coulomb,
            unit_payload,
            workspace: Workspace::new(robot),
            sin: zeros(),
            cos: zeros(),
            torque: zeros(),
        })
    }

    /// Takes the correction at the state (q, q̇) off the input `u` (n, N m); with the loads of
    /// gravity near a sample of a motion, if they are given.
    pub(super) fn take_off(
        &mut self,
        near: Option<(&LoadsNear, usize)>,
        q: &[f64],
        qd: &[f64],
        u: &mut [f64],
    ) {
        let joints = self.correction.joints.iter().enumerate();
        for (j, joint) in joints {
            let offset = qd[j] - self.origin[j];
            let viscous = (joint.quadratic + joint.cubic * offset) * offset * offset;
            u[j] -= viscous + joint.warm_up * self.warmth[j] * qd[j];
        }
        if let Some(warm) = &self.warm {
            let joints = warm.joints().iter().zip(self.robot.joints()).enumerate();
            for (j, (warm, cold)) in joints {
                let [warm, cold] = [warm, cold].map(|joint| joint.friction.viscous.torque(&qd[j]));
                u[j] -= warm - cold;
            }
        }
        let changes_coulomb = self.warm.is_some() && self.is_compensated;
        if !self.has_coulomb && !changes_coulomb && self.unit_payload.is_none() {
            return;
        }
        if near.is_none() || self.unit_payload.is_some() {
            for (j, joint) in self.robot.joints().iter().enumerate() {
                (self.sin[j], self.cos[j]) = joint.kind.sin_cos(&q[j]);
            }
        }
        if self.has_coulomb || changes_coulomb {
            match near {
                Some((loads, sample)) => loads.at(sample, q, &mut self.torque),
                None => {
                    let (sin, cos) = (&self.sin, &self.cos);
                    self.robot.gravity(sin, cos, &mut self.workspace, &mut self.torque);
                }
            }
            let joints = self.robot.joints().iter().zip(&self.coulomb);
            for (j, (joint, parts)) in joints.enumerate() {
                let (load, qd) = (self.torque[j], qd[j]);
                u[j] -= joint.friction.coulomb.softened_torque(load, qd, *parts);
                if let Some(warm) = self.warm.as_ref().filter(|_| changes_coulomb) {
                    let of =
                        |robot: &Robot| robot.joints()[j].friction.softened_dry_torque(load, qd);
                    u[j] -= of(warm) - of(&self.robot);
                }
            }
        }
        if let Some(payload) = &self.unit_payload {
            payload.gravity(&self.sin, &self.cos, &mut self.workspace, &mut self.torque);
            let weights = u.iter_mut().zip(&self.torque);
            weights.for_each(|(u, unit)| *u -= self.correction.payload * unit);
        }
    }
}

/// The description of a robot without any mass but 1 kg at the origin of its last link's frame.
pub(super) fn only_payload(description: &RobotDescription) -> RobotDescription {
    let mut only = description.clone();
    only.parameters = ParameterSet::Base;
    let last = only.joints.len() - 1;
    for (j, joint) in only.joints.iter_mut().enumerate() {
        joint.gravity_moments = None;
        joint.com = None;
        joint.first_moment = Some([0.0; 3]);
        joint.about = InertiaPoint::Origin;
        joint.inertia = [0.0; 6];
        joint.mass = if j == last { 1.0 } else { 0.0 };
    }
    only
}
