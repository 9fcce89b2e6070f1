//! Enclosures of the links while the joints move within a tube.

use rayon::prelude::*;
use reachtube_reach::StepBounds;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::add_up;
use serde::Serialize;

use crate::body::body::{Body, Workspace};
use crate::body::capsule::Capsule;
use crate::kinematics::vector::Vector;

/// Smallest number of steps in one task of a thread.
const STEPS_PER_TASK: usize = 32;

/// A capsule in the base frame that contains a link's capsule at every time of a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SweptCapsule {
    /// One end of the segment \[m\].
    pub from: [f64; 3],
    /// The other end \[m\].
    pub to: [f64; 3],
    /// Radius \[m\].
    pub radius: f64,
}

impl Body {
    /// Encloses the links over each step of a tube, whose boxes are of positions (rad; m), and of
    /// velocities, which are not used. The capsules of a step are in the order of the body's.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: while the joints' positions lie in the box of a step, each link's
    /// capsule lies in the swept capsule of that step. The ends of a capsule are linearised in the
    /// joints' positions with a proved remainder, so that the joints' common effect on all
    /// coordinates is kept. The rotations between the robot's joints are taken as exact; they may
    /// differ from the loaded ones by rounding.
    ///
    /// # Panics
    ///
    /// Panics if the joints do not fit the tube.
    #[must_use]
    pub fn occupancy(&self, tube: &StepBounds) -> Vec<Vec<SweptCapsule>> {
        let sweep = |workspace: &mut Workspace, k: usize| self.swept(workspace, tube.bounds(k));
        let steps = (0..tube.len()).into_par_iter().with_min_len(STEPS_PER_TASK);
        steps.map_init(Workspace::default, sweep).collect()
    }

    /// Encloses the links while the joints lie in a box, whose first n sides are positions.
    fn swept(&self, workspace: &mut Workspace, sides: &[Interval]) -> Vec<SweptCapsule> {
        workspace.pose(self, &sides[..self.joint_count()]);
        let swept = |(capsule, ends): (&Capsule, &[Vector; 2])| {
            workspace.linearise(self, capsule, ends);
            let [from, to] = workspace.balls();
            let radius = add_up(capsule.radius, from.radius.max(to.radius));
            SweptCapsule { from: from.centre, to: to.centre, radius }
        };
        self.ends().map(swept).collect()
    }
}

impl Body {
    /// Returns the capsules in the base frame at a position (rad; m), n numbers.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding, as [`occupancy`](Self::occupancy).
    ///
    /// # Panics
    ///
    /// Panics when there are fewer positions than joints.
    #[must_use]
    pub fn placed(&self, q: &[f64]) -> Vec<SweptCapsule> {
        let positions: Vec<Interval> = q.iter().map(|q| Interval::point(*q)).collect();
        self.swept(&mut Workspace::default(), &positions)
    }
}
