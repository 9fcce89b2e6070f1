//! Forward dynamics by mass matrix and factorisation.

use crate::rnea::Weight;
use crate::{Robot, Workspace, ltdl};
use nalgebra::DVector;
use reachtube_scalar::Scalar;

impl Robot {
    /// Forward dynamics (4): q̈ = M_m(q)⁻¹ (tau - c(q, q̇) - g(q)) \[rad/s²\] by [`Robot::crba`]
    /// and [`ltdl`].
    ///
    /// Slices have one entry a joint: `sin`, `cos` of q, `qd` \[rad/s\], link-side torque `tau` \[N
    /// m\]. Faster than [`Robot::aba`] up to about ten joints.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure; all reals where a pivot encloses 0.
    pub fn forward_dynamics<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        qd: &[S],
        tau: &[S],
        ws: &mut Workspace<S>,
        qdd: &mut [S],
    ) {
        self.accelerate([sin, cos, qd, tau], self.weight(), ws, qdd);
    }

    /// Forward dynamics over [sin q, cos q, q̇, tau] under a weight.
    pub(crate) fn accelerate<S: Scalar>(
        &self,
        [sin, cos, qd, tau]: [&[S]; 4],
        weight: Weight<S>,
        ws: &mut Workspace<S>,
        qdd: &mut [S],
    ) {
        let n = self.links.len();
        let mut mass_matrix = core::mem::take(&mut ws.mass_matrix);
        self.crba(sin, cos, ws, &mut mass_matrix);
        self.newton_euler([sin, cos, qd, &ws.rest], weight, &mut ws.links, qdd);
        ltdl::factor(&mut mass_matrix, n);
        qdd.iter_mut().zip(tau).for_each(|(x, t)| *x = t.clone() - x.clone());
        ltdl::solve(&mass_matrix, &mut qdd[..n]);
        ws.mass_matrix = mass_matrix;
    }

    /// Coriolis and gravity torque c(q, q̇) + g(q) of (3) \[N m\].
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure.
    pub fn bias_torque<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        qd: &[S],
        ws: &mut Workspace<S>,
        out: &mut [S],
    ) {
        let Workspace { links, rest, .. } = ws;
        self.newton_euler([sin, cos, qd, rest], self.weight(), links, out);
    }

    /// q̈ of (4) \[rad/s²\] at q \[rad\], q̇ \[rad/s\] and link-side torque \[N m\].
    pub fn forward_acceleration(&self, q: &[f64], qd: &[f64], tau_link: &[f64]) -> DVector<f64> {
        let (sin, cos) = self.sin_cos(q);
        let mut qdd = DVector::zeros(q.len());
        self.forward_dynamics(
            &sin,
            &cos,
            qd,
            tau_link,
            &mut Workspace::new(self),
            qdd.as_mut_slice(),
        );
        qdd
    }

    /// Link-side torque of (3) \[N m\] at q \[rad\], q̇ \[rad/s\], q̈ \[rad/s²\].
    pub fn inverse_dynamics(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> DVector<f64> {
        let (sin, cos) = self.sin_cos(q);
        let mut tau = DVector::zeros(q.len());
        self.rnea(&sin, &cos, qd, qdd, &mut Workspace::new(self), tau.as_mut_slice());
        tau
    }

    /// Coriolis and centripetal torque c(q, q̇) \[N m\] at q \[rad\], q̇ \[rad/s\].
    pub fn coriolis_torque(&self, q: &[f64], qd: &[f64]) -> DVector<f64> {
        let (sin, cos) = self.sin_cos(q);
        let mut c = DVector::zeros(q.len());
        self.coriolis(&sin, &cos, qd, &mut Workspace::new(self), c.as_mut_slice());
        c
    }

    /// Gravity torque g(q) \[N m\] at q \[rad\].
    pub fn gravity_torque(&self, q: &[f64]) -> DVector<f64> {
        let (sin, cos) = self.sin_cos(q);
        let mut g = DVector::zeros(q.len());
        self.gravity(&sin, &cos, &mut Workspace::new(self), g.as_mut_slice());
        g
    }
}
