//! Coriolis and centripetal torque.

use crate::rnea::Weight;
use crate::{Robot, Workspace};
use reachtube_scalar::Scalar;

impl Robot {
    /// Coriolis and centripetal torque c(q, q̇) of (3) \[N m\], without gravity.
    ///
    /// Slices have one entry a joint: `sin`, `cos` of q and `qd` \[rad/s\]. Evaluated by
    /// Newton-Euler at zero acceleration; with independent sine and cosine it is that algorithm's
    /// polynomial, of higher degree than the Christoffel form (12), which it equals on s² + c² = 1.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure.
    pub fn coriolis<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        qd: &[S],
        ws: &mut Workspace<S>,
        c: &mut [S],
    ) {
        let Workspace { links, rest, .. } = ws;
        self.newton_euler([sin, cos, qd, rest], Weight::None, links, c);
    }
}
