//! Forward dynamics by mass matrix and factorisation.

use crate::gravity::GravityLoad;
use crate::ltdl;
use crate::robot::Robot;
use crate::workspace::Workspace;
use nalgebra::DVector;
use reachtube_scalar::{Kernel, Scalar};

/// The arguments of [`Robot::forward_dynamics_under`].
struct ForwardDynamics<'a, S> {
    robot: &'a Robot,
    gravity: GravityLoad<S>,
    state: [&'a [S]; 4],
    ws: &'a mut Workspace<S>,
    qdd: &'a mut [S],
}

impl<S: Scalar> Kernel for ForwardDynamics<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { robot, gravity, state: [sin, cos, qd, tau], ws, qdd } = self;
        let (n, still) = (robot.links.len(), &ws.zero_acceleration);
        robot.composite_bodies(sin, cos, &mut ws.links, &mut ws.mass_matrix);
        robot.newton_euler_passes([sin, cos, qd, still], gravity, &mut ws.links, qdd);
        ltdl::factor(&mut ws.mass_matrix, n);
        qdd.iter_mut().zip(tau).for_each(|(x, t)| *x = t.clone() - x.clone());
        ltdl::solve(&ws.mass_matrix, &mut qdd[..n]);
    }
}

impl Robot {
    /// Computes forward dynamics (4): q̈ = M_m(q)⁻¹ (tau - c(q, q̇) - g(q)) \[rad/s²\] by
    /// [`Robot::crba`] and [`ltdl`].
    ///
    /// All slices have one entry per joint: `sin`, `cos` of [`Robot::sin_cos`], `qd` \[rad/s\],
    /// link-side torque
    /// `tau` \[N m\]. It is faster than [`Robot::aba`] for up to about ten joints.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure, which is all reals if a pivot encloses 0.
    pub fn forward_dynamics<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        qd: &[S],
        tau: &[S],
        ws: &mut Workspace<S>,
        qdd: &mut [S],
    ) {
        self.forward_dynamics_under(self.gravity_load(), [sin, cos, qd, tau], ws, qdd);
    }

    /// Computes forward dynamics for [sin q, cos q, q̇, tau] under a gravity load.
    pub(crate) fn forward_dynamics_under<S: Scalar>(
        &self,
        gravity: GravityLoad<S>,
        [sin, cos, qd, tau]: [&[S]; 4],
        ws: &mut Workspace<S>,
        qdd: &mut [S],
    ) {
        S::dispatch(ForwardDynamics { robot: self, gravity, state: [sin, cos, qd, tau], ws, qdd });
    }

    /// Returns q̈ of (4) \[rad/s²\] at q \[rad\], q̇ \[rad/s\] and link-side torque \[N m\].
    pub fn forward_acceleration(&self, q: &[f64], qd: &[f64], tau_link: &[f64]) -> DVector<f64> {
        let (sin, cos) = self.sin_cos(q);
        let mut ws = Workspace::new(self);
        let mut qdd = DVector::zeros(q.len());
        self.forward_dynamics(&sin, &cos, qd, tau_link, &mut ws, qdd.as_mut_slice());
        qdd
    }
}
