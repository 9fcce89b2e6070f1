//! Gravity torque.

use crate::algebra::Vec3;
use crate::link::Link;
use crate::robot::Robot;
use crate::workspace::{LinkScratch, Workspace, accumulate_to_parents};
use nalgebra::DVector;
use reachtube_scalar::{Kernel, Scalar};

/// The parameters that gravity acts on, with the base acceleration that has the same effect.
pub(crate) enum GravityLoad<S> {
    /// No gravity.
    None,
    /// Gravity acts on the inertial parameters.
    Inertial(Vec3<S>),
    /// Gravity acts on separate gravity parameters.
    Separate(Vec3<S>),
}

impl<S: Scalar> GravityLoad<S> {
    /// Returns the base acceleration for the inertial parameters, and the one for the separate
    /// gravity parameters if there are any.
    #[inline(always)]
    pub(crate) fn split(self) -> (Vec3<S>, Option<Vec3<S>>) {
        match self {
            Self::None => (Vec3::zero(), None),
            Self::Inertial(acceleration) => (acceleration, None),
            Self::Separate(acceleration) => (Vec3::zero(), Some(acceleration)),
        }
    }
}

/// The arguments of [`Robot::gravity_pass`].
struct GravityPass<'a, S> {
    robot: &'a Robot,
    sin: &'a [S],
    cos: &'a [S],
    scratch: &'a mut [LinkScratch<S>],
    g: &'a mut [S],
}

impl<S: Scalar> Kernel for GravityPass<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { robot, sin, cos, scratch, g } = self;
        if robot.slides {
            robot.gravity_pass_among::<S, true>(sin, cos, scratch, g);
        } else {
            robot.gravity_pass_among::<S, false>(sin, cos, scratch, g);
        }
    }
}

impl Robot {
    /// Computes the gravity torque g(q) of (3) \[N m\] from the gravity parameters.
    ///
    /// All slices have one entry per joint; `sin` and `cos` come from [`Robot::sin_cos`].
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure.
    pub fn gravity<S: Scalar>(&self, sin: &[S], cos: &[S], ws: &mut Workspace<S>, g: &mut [S]) {
        self.gravity_pass(sin, cos, &mut ws.links, g);
    }

    /// Returns the gravity torque g(q) \[N m\] at q \[rad\].
    pub fn gravity_torque(&self, q: &[f64]) -> DVector<f64> {
        let (sin, cos) = self.sin_cos(q);
        let mut g = DVector::zeros(q.len());
        self.gravity(&sin, &cos, &mut Workspace::new(self), g.as_mut_slice());
        g
    }

    /// Runs Newton-Euler for a robot at rest whose base accelerates against gravity.
    pub(crate) fn gravity_pass<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        scratch: &mut [LinkScratch<S>],
        g: &mut [S],
    ) {
        S::dispatch(GravityPass { robot: self, sin, cos, scratch, g });
    }

    /// Runs the pass for a robot that has prismatic joints only if `SLIDES`.
    #[inline(always)]
    fn gravity_pass_among<S: Scalar, const SLIDES: bool>(
        &self,
        sin: &[S],
        cos: &[S],
        scratch: &mut [LinkScratch<S>],
        g: &mut [S],
    ) {
        let mut acceleration = self.base_acceleration();
        for (i, (link, scratch)) in self.links.iter().zip(scratch.iter_mut()).enumerate() {
            let pose = link.pose_among::<S, SLIDES>(&sin[i], &cos[i]);
            acceleration = pose.to_link(&acceleration);
            let (force, moment) = gravity_wrench(link, &acceleration);
            *scratch = LinkScratch { pose, force, moment };
        }
        accumulate_to_parents(scratch);
        for ((g, link), s) in g.iter_mut().zip(&self.links).zip(scratch) {
            *g = link.axis_component_among::<S, SLIDES>(&s.force, &s.moment);
        }
    }

    #[inline(always)]
    pub(crate) fn gravity_load<S: Scalar>(&self) -> GravityLoad<S> {
        let acceleration = self.base_acceleration();
        if self.separate_gravity {
            GravityLoad::Separate(acceleration)
        } else {
            GravityLoad::Inertial(acceleration)
        }
    }

    /// Returns the base acceleration that acts on every mass as gravity does, in the working base
    /// frame \[m/s²\].
    #[inline(always)]
    fn base_acceleration<S: Scalar>(&self) -> Vec3<S> {
        Vec3::constant(self.working_gravity.map(|g| -g))
    }
}

/// Returns the force and moment that accelerate a link's gravity parameters.
#[inline(always)]
pub(crate) fn gravity_wrench<S: Scalar>(link: &Link, acceleration: &Vec3<S>) -> (Vec3<S>, Vec3<S>) {
    let moment = Vec3::constant(link.gravity_first_moment).cross(acceleration);
    (acceleration.scaled(&S::from(link.gravity_mass)), moment)
}
