//! Gravity torque.

use crate::rnea::hand_down;
use crate::workspace::LinkScratch;
use crate::{Robot, Workspace};
use reachtube_scalar::Scalar;

impl Robot {
    /// Gravity torque g(q) of (3) \[N m\], from the gravity parameters.
    ///
    /// Slices have one entry a joint: `sin` and `cos` of q.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure.
    pub fn gravity<S: Scalar>(&self, sin: &[S], cos: &[S], ws: &mut Workspace<S>, g: &mut [S]) {
        self.gravity_pass(sin, cos, &mut ws.links, g);
    }

    /// Newton-Euler of a robot at rest whose base accelerates against gravity.
    pub(crate) fn gravity_pass<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        scratch: &mut [LinkScratch<S>],
        g: &mut [S],
    ) {
        let mut acceleration = self.base_acceleration();
        for (i, (link, scratch)) in self.links.iter().zip(scratch.iter_mut()).enumerate() {
            let pose = link.pose(&sin[i], &cos[i]);
            acceleration = pose.to_link(&acceleration);
            let (force, moment) = link.lifted(&acceleration);
            *scratch = LinkScratch { pose, force, moment };
        }
        hand_down(scratch);
        g.iter_mut().zip(scratch).for_each(|(g, s)| *g = s.moment.z.clone());
    }
}
