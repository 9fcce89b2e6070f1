//! Descriptions in which joints are held at a position.

use super::joint_description::{GravityMoments, JointDescription, PlacementDescription};
use super::robot_description::RobotDescription;
use crate::error::RobotError;
use crate::inertia::LinkInertia;
use crate::joint_geometry::JointGeometry;
use crate::lock::{Lock, LockedJoint};
use crate::placement::Placement;

impl RobotDescription {
    /// Returns the description of the robot with joints held at positions. The link of such a joint
    /// belongs to the previous link; a link that then does not move is dropped.
    ///
    /// If a joint is locked, the other joints get placements in place of Denavit-Hartenberg
    /// parameters, and the frame of each link is its joint frame moved by q.
    ///
    /// # Errors
    ///
    /// Returns [`RobotError::Invalid`] for a joint that the robot does not have, for one that is
    /// locked twice, for a position beyond its limits, and if no joint is left.
    pub fn with_locks(&self, locks: &[Lock]) -> Result<Self, RobotError> {
        if locks.is_empty() {
            return Ok(self.clone());
        }
        self.check_locks(locks)?;
        let mut out = Self { joints: Vec::new(), ..self.clone() };
        // Placement of the present link's frame in the frame of the last link that moves.
        let mut at = Placement::identity();
        for joint in &self.joints {
            let geometry = joint.geometry(self.convention);
            at = at.then(&geometry.before);
            match locks.iter().find(|lock| lock.joint == joint.name) {
                Some(lock) => {
                    at = at.then(&joint.kind.motion(&geometry.axis, lock.position));
                    at = at.then(&geometry.after);
                    if let Some(carrier) = out.joints.last_mut() {
                        carrier.lump(joint, &at);
                    }
                    let (name, kind, position) = (joint.name.clone(), joint.kind, lock.position);
                    out.locked.push(LockedJoint { name, kind, position });
                }
                None => {
                    out.joints.push(joint.placed(&at, &geometry));
                    at = geometry.after;
                }
            }
        }
        Ok(out)
    }

    fn check_locks(&self, locks: &[Lock]) -> Result<(), RobotError> {
        let invalid = |place: String, problem: String, remedy: String| {
            Err(RobotError::Invalid { origin: self.name.clone(), place, problem, remedy })
        };
        for (i, lock) in locks.iter().enumerate() {
            let place = format!("joint `{}`: ", lock.joint);
            let Some(joint) = self.joints.iter().find(|joint| joint.name == lock.joint) else {
                let names: Vec<_> = self.joints.iter().map(|j| format!("`{}`", j.name)).collect();
                let problem = "the robot has no joint with this name to lock".into();
                return invalid(place, problem, format!("lock one of {}", names.join(", ")));
            };
            if locks[..i].iter().any(|other| other.joint == lock.joint) {
                return invalid(place, "it is locked twice".into(), "lock it once".into());
            }
            let limits = joint.position_limits.or(joint.kind.default_limits());
            if let Some(problem) = joint.kind.problem_of_lock(lock.position, limits) {
                return invalid(
                    place,
                    problem,
                    "give a position within the limits, in rad or m".into(),
                );
            }
        }
        if locks.len() == self.joints.len() {
            let (problem, remedy) = ("all joints are locked", "leave one joint free");
            return invalid(String::new(), problem.into(), remedy.into());
        }
        Ok(())
    }
}

impl JointDescription {
    /// Returns the joint with its frame at `at` in the last link that moves.
    fn placed(&self, at: &Placement, geometry: &JointGeometry) -> Self {
        let row = |i: usize| core::array::from_fn(|j| at.rotation[(i, j)]);
        let placement = PlacementDescription {
            rotation: Some(core::array::from_fn(row)),
            rpy: None,
            translation: at.translation.into(),
        };
        let mut out = Self {
            dh: None,
            placement: Some(placement),
            axis: Some(geometry.axis.into()),
            ..self.clone()
        };
        if geometry.after != Placement::identity() {
            out.set_inertial(&self.link_inertia().moved(&geometry.after).parameters());
            out.set_gravity(self.gravity_inertia().moved(&geometry.after));
        }
        out
    }

    /// Adds the link of another joint, whose frame is at `at` in this link.
    fn lump(&mut self, other: &Self, at: &Placement) {
        let whole = self.link_inertia().plus(&other.link_inertia().moved(at));
        let gravity = self.gravity_inertia().plus(&other.gravity_inertia().moved(at));
        self.set_inertial(&whole.parameters());
        self.set_gravity(gravity);
    }

    /// Sets the mass moments for gravity, if the description has them.
    fn set_gravity(&mut self, inertia: LinkInertia) {
        let moments =
            GravityMoments { mass: inertia.mass, first_moment: inertia.first_moment.into() };
        self.gravity_moments = self.gravity_moments.map(|_| moments);
    }
}
