//! Coriolis and centripetal torque.

use crate::gravity::GravityLoad;
use crate::robot::Robot;
use crate::workspace::Workspace;
use nalgebra::DVector;
use reachtube_scalar::Scalar;

impl Robot {
    /// Computes the Coriolis and centripetal torque c(q, q̇) of (3) \[N m\], without gravity.
    ///
    /// All slices have one entry per joint: `sin`, `cos` of [`Robot::sin_cos`] and `qd` \[rad/s\].
    /// The torque equals Newton-Euler's at zero acceleration. With independent sine and cosine it
    /// is that algorithm's polynomial, which has a higher degree than the Christoffel form (12); on
    /// s² + c² = 1 both are equal.
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
        let Workspace { links, zero_acceleration, .. } = ws;
        self.newton_euler([sin, cos, qd, zero_acceleration], GravityLoad::None, links, c);
    }

    /// Returns the torque M(q) q̈ + c(q, q̇) \[N m\] that a motion takes without gravity and
    /// friction, at q \[rad\], q̇ \[rad/s\] and q̈ \[rad/s²\].
    pub fn motion_torque(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> DVector<f64> {
        let (sin, cos) = self.sin_cos(q);
        let mut torque = DVector::zeros(q.len());
        let mut workspace = Workspace::new(self);
        let motion = [&sin[..], &cos[..], qd, qdd];
        self.newton_euler(motion, GravityLoad::None, &mut workspace.links, torque.as_mut_slice());
        torque
    }
}
