//! Joints of a URDF that are locked, and joints that mimic others.

use super::document::{TreeJoint, UrdfTree, element};
use crate::error::RobotError;
use crate::joint_kind::JointKind;
use crate::lock::{Lock, LockedJoint};
use crate::placement::Placement;
use nalgebra::Vector3;

/// Number of joints that are followed where each mimics the next; it ends circles.
const MOST_LEADERS: usize = 100;

impl<'a> TreeJoint<'a> {
    pub(super) fn leader(&self) -> Option<&'a str> {
        element(self.node, "mimic").map(|mimic| mimic.attribute("joint").unwrap_or(""))
    }

    /// Returns how the joint moves, if its position is one number.
    pub(super) fn motion(&self) -> Option<JointKind> {
        match self.kind {
            "revolute" | "continuous" => Some(JointKind::Revolute),
            "prismatic" => Some(JointKind::Prismatic),
            _ => None,
        }
    }
}

impl<'a> UrdfTree<'a> {
    /// Locks joints, and the joints that mimic them.
    pub(super) fn lock(&mut self, locks: &[Lock]) -> Result<(), RobotError> {
        for lock in locks {
            let k = self.lockable(lock)?;
            self.joints[k].locked = Some(lock.position);
        }
        for k in 0..self.joints.len() {
            // A joint may mimic one that mimics another: the leaders are locked first.
            let path: Vec<_> = self.leaders(k).collect();
            for k in path.into_iter().rev() {
                self.joints[k].locked = self.mimicked_position(k)?.or(self.joints[k].locked);
            }
        }
        Ok(())
    }

    /// Returns a joint, the joint that it mimics, the one that this mimics, and so on.
    fn leaders(&self, k: usize) -> impl Iterator<Item = usize> {
        let leader = |k: &usize| self.by_name.get(self.joints[*k].leader()?).copied();
        core::iter::successors(Some(k), leader).take(MOST_LEADERS)
    }

    /// Returns the joint that a lock names.
    fn lockable(&self, lock: &Lock) -> Result<usize, RobotError> {
        let Some(&k) = self.by_name.get(lock.joint.as_str()) else {
            let free = self.joints.iter().filter(|j| j.motion().is_some() && j.leader().is_none());
            let names: Vec<_> = free.map(|joint| format!("`{}`", joint.name)).collect();
            return Err(self.error(
                self.document.root_element(),
                format!("there is no joint `{}` to lock", lock.joint),
                &format!("lock one of {}", names.join(", ")),
            ));
        };
        let joint = &self.joints[k];
        let refuse = |problem: String, remedy: &str| Err(self.error(joint.node, problem, remedy));
        let Some(motion) = joint.motion() else {
            let problem = format!("the joint is {} and cannot be locked", joint.kind);
            return refuse(problem, "lock revolute, continuous and prismatic joints only");
        };
        if let Some(leader) = joint.leader() {
            let problem = format!("the joint mimics `{leader}` and cannot be locked by itself");
            return refuse(problem, &format!("lock `{leader}`; this joint follows it"));
        }
        if joint.locked.is_some() {
            return refuse("the joint is locked twice".into(), "lock it once");
        }
        let limits = self.limits(joint)?.0;
        match motion.problem_of_lock(lock.position, limits) {
            Some(problem) => refuse(problem, "give a position within the limits, in rad or m"),
            None => Ok(k),
        }
    }

    /// Returns the position of a joint that mimics a locked or fixed one.
    fn mimicked_position(&self, k: usize) -> Result<Option<f64>, RobotError> {
        let joint = &self.joints[k];
        let (Some(mimic), None) = (element(joint.node, "mimic"), joint.locked) else {
            return Ok(None);
        };
        let leader = joint.leader().and_then(|name| self.by_name.get(name));
        let held = leader
            .map(|leader| &self.joints[*leader])
            .filter(|leader| leader.is_fixed() && joint.motion().is_some());
        let Some(held) = held else { return Ok(None) };
        let number = |name| self.number(mimic, name);
        let multiplier = number("multiplier")?.unwrap_or(1.0);
        let offset = number("offset")?.unwrap_or(0.0);
        Ok(Some(multiplier * held.locked.unwrap_or(0.0) + offset))
    }

    /// Returns the placement of the frame of a joint's child in its parent, for a joint that does
    /// not move.
    pub(super) fn placement_when_held(
        &self,
        joint: &TreeJoint<'a>,
    ) -> Result<Placement, RobotError> {
        let placement = self.placement_of(joint.node)?;
        let (Some(position), Some(motion)) = (joint.locked, joint.motion()) else {
            return Ok(placement);
        };
        let axis = Vector3::from(self.axis_of(joint)?);
        if axis.norm() == 0.0 {
            let remedy = "give a vector of positive length";
            return Err(self.error(joint.node, "the axis has no direction".into(), remedy));
        }
        Ok(placement.then(&motion.motion(&axis.normalize(), position)))
    }

    pub(super) fn axis_of(&self, joint: &TreeJoint<'a>) -> Result<[f64; 3], RobotError> {
        let axis = element(joint.node, "axis").map(|node| self.triple(node, "xyz"));
        Ok(axis.transpose()?.flatten().unwrap_or([1.0, 0.0, 0.0]))
    }

    pub(super) fn locked(&self) -> Vec<LockedJoint> {
        let record = |joint: &TreeJoint| {
            let (position, kind) = (joint.locked?, joint.motion()?);
            Some(LockedJoint { name: joint.name.into(), kind, position })
        };
        self.joints.iter().filter_map(record).collect()
    }

    /// Returns the joint that decides the position of a joint: itself, or the one that it mimics
    /// in the end.
    pub(super) fn independent(&self, k: usize) -> usize {
        self.leaders(k).last().unwrap_or(k)
    }

    /// Returns the options that lock joints, such as `--lock finger=0`: at 0, or at the limit that
    /// is nearest to it.
    pub(super) fn lock_options(&self, joints: impl IntoIterator<Item = usize>) -> String {
        let option = |k: usize| {
            let joint = &self.joints[k];
            let [low, high] = self.limits(joint).ok().and_then(|l| l.0).unwrap_or([0.0, 0.0]);
            let position = if low > 0.0 { low } else { high.min(0.0) };
            format!("--lock {}={position}", joint.name)
        };
        joints.into_iter().map(option).collect::<Vec<_>>().join(" ")
    }
}
