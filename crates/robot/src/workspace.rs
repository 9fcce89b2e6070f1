//! Scratch memory of the algorithms.

use crate::algebra::Vec3;
use crate::articulated_body::ArticulatedScratch;
use crate::pose::Pose;
use crate::robot::Robot;
use reachtube_scalar::Scalar;

/// Scratch memory of the algorithms for one robot and one scalar. It is made once and reused, so
/// that no call allocates.
///
/// A workspace fits robots with the number of joints that it was made for; with another number the
/// algorithms may panic.
#[derive(Clone, Debug)]
pub struct Workspace<S> {
    pub(crate) links: Vec<LinkScratch<S>>,
    pub(crate) articulated: Vec<ArticulatedScratch<S>>,
    /// The acceleration of a robot at rest: n zeros.
    pub(crate) zero_acceleration: Vec<S>,
    /// Joint torques, n entries.
    pub(crate) torque: Vec<S>,
    /// Mass matrix, n x n, row by row.
    pub(crate) mass_matrix: Vec<S>,
}

/// Values of one link that the Newton-Euler and composite-body algorithms keep between their
/// passes.
#[derive(Clone, Debug)]
pub(crate) struct LinkScratch<S> {
    pub pose: Pose<S>,
    pub force: Vec3<S>,
    /// Moment about the origin of the link's frame.
    pub moment: Vec3<S>,
}

impl<S: Scalar> Workspace<S> {
    /// Allocates scratch memory for a robot.
    pub fn new(robot: &Robot) -> Self {
        let n = robot.joint_count();
        Self {
            links: vec![LinkScratch::blank(); n],
            articulated: vec![ArticulatedScratch::blank(); n],
            zero_acceleration: vec![S::zero(); n],
            torque: vec![S::zero(); n],
            mass_matrix: vec![S::zero(); n * n],
        }
    }
}

impl<S: Scalar> LinkScratch<S> {
    fn blank() -> Self {
        Self { pose: Pose::identity(), force: Vec3::zero(), moment: Vec3::zero() }
    }

    /// Adds this link's force and moment to its parent's.
    #[inline(always)]
    fn accumulate_to_parent(&self, parent: &mut Self) {
        let force = self.pose.to_parent(&self.force);
        parent.moment.accumulate(&self.pose.to_parent(&self.moment));
        parent.moment.accumulate(&self.pose.origin.cross(&force));
        parent.force.accumulate(&force);
    }
}

/// Adds each link's force and moment to its parent's, from the tip to the base.
#[inline(always)]
pub(crate) fn accumulate_to_parents<S: Scalar>(scratch: &mut [LinkScratch<S>]) {
    for i in (1..scratch.len()).rev() {
        let (before, after) = scratch.split_at_mut(i);
        after[0].accumulate_to_parent(&mut before[i - 1]);
    }
}
