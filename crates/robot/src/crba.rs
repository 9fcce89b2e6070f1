//! Mass matrix by the composite-rigid-body algorithm.

use crate::algebra::{Sym3, Vec3};
use crate::joint_kind::JointKind;
use crate::link::Link;
use crate::pose::Pose;
use crate::robot::Robot;
use crate::workspace::{LinkScratch, Workspace};
use nalgebra::DMatrix;
use reachtube_scalar::{Kernel, Scalar};

/// The arguments of [`Robot::crba`].
struct CompositeBodies<'a, S> {
    robot: &'a Robot,
    sin: &'a [S],
    cos: &'a [S],
    scratch: &'a mut [LinkScratch<S>],
    m: &'a mut [S],
}

impl<S: Scalar> Kernel for CompositeBodies<'_, S> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.robot.composite_bodies(self.sin, self.cos, self.scratch, self.m);
    }
}

impl Robot {
    /// Computes the mass matrix M_m(q) = M(q) + diag(armature) of (3) \[kg m²\], n x n, row by row,
    /// both triangles.
    ///
    /// `sin` and `cos` of [`Robot::sin_cos`] have one entry per joint; `m` has n² entries.
    /// Composite-rigid-body algorithm (Walker & Orin 1982; Featherstone, Rigid Body Dynamics
    /// Algorithms, 2008, ch. 6). With independent sine and cosine the result is this algorithm's
    /// polynomial.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure, entry by entry.
    ///
    /// # Panics
    ///
    /// Panics if a slice or the workspace is too short for the robot.
    pub fn crba<S: Scalar>(&self, sin: &[S], cos: &[S], ws: &mut Workspace<S>, m: &mut [S]) {
        S::dispatch(CompositeBodies { robot: self, sin, cos, scratch: &mut ws.links, m });
    }

    /// Computes the mass matrix like [`crba`](Self::crba), within a kernel.
    #[inline(always)]
    pub(crate) fn composite_bodies<S: Scalar>(
        &self,
        sin: &[S],
        cos: &[S],
        scratch: &mut [LinkScratch<S>],
        m: &mut [S],
    ) {
        if self.slides {
            self.crba_among::<S, true>(sin, cos, scratch, m);
        } else {
            self.crba_among::<S, false>(sin, cos, scratch, m);
        }
    }

    /// Computes the mass matrix of a robot that has prismatic joints only if `SLIDES`.
    #[inline(always)]
    fn crba_among<S: Scalar, const SLIDES: bool>(
        &self,
        sin: &[S],
        cos: &[S],
        scratch: &mut [LinkScratch<S>],
        m: &mut [S],
    ) {
        let n = self.links.len();
        let (m, sin, cos, scratch) = (&mut m[..n * n], &sin[..n], &cos[..n], &mut scratch[..n]);
        for i in 0..n {
            scratch[i].pose = self.links[i].pose_among::<S, SLIDES>(&sin[i], &cos[i]);
        }
        let Some(last) = self.links.last() else { return };
        let (mut first_moment, mut second_moments) = last.moments::<S>();
        for i in (0..n).rev() {
            let link = &self.links[i];
            let (mut force, mut moment) =
                unit_wrench::<S, SLIDES>(link, &first_moment, &second_moments);
            let own = link.axis_component_among::<S, SLIDES>(&force, &moment);
            m[i * n + i] = own + S::from(link.armature);
            // Its axis components at the joints towards the base are row and column i of M.
            for j in (1..=i).rev() {
                let pose = &scratch[j].pose;
                force = pose.to_parent(&force);
                moment = pose.to_parent(&moment).plus(&pose.origin.cross(&force));
                let entry = self.links[j - 1].axis_component_among::<S, SLIDES>(&force, &moment);
                m[i * n + j - 1] = entry.clone();
                m[(j - 1) * n + i] = entry;
            }
            // The composite body grows by the next link towards the base.
            if i > 0 {
                let shifted = composite_to_parent::<S, SLIDES>(
                    &scratch[i].pose,
                    &self.links[i],
                    &first_moment,
                    &second_moments,
                );
                (first_moment, second_moments) = self.links[i - 1].moments();
                first_moment.accumulate(&shifted.0);
                second_moments.accumulate(&shifted.1);
            }
        }
    }

    /// Returns the mass matrix M_m(q) with the armature \[kg m²\], n x n, for q in rad.
    ///
    /// # Examples
    ///
    /// ```
    /// let robot = reachtube_robot::Robot::lwa4p();
    /// let m = robot.mass_matrix(&[0.0; 6]);
    /// assert!((m[(0, 0)] - 1.7355).abs() < 1e-4);
    /// ```
    pub fn mass_matrix(&self, q: &[f64]) -> DMatrix<f64> {
        let n = self.joint_count();
        let (sin, cos) = self.sin_cos(q);
        let mut m = DMatrix::zeros(n, n);
        self.crba(&sin, &cos, &mut Workspace::new(self), m.as_mut_slice());
        m
    }
}

/// Returns the force and the moment that give a link and all later ones, as one body with the first
/// moment h and the second moments Σ, a unit acceleration of the link's joint.
///
/// A rotation about z takes the force z × h and the moment I z.
#[inline(always)]
fn unit_wrench<S: Scalar, const SLIDES: bool>(
    link: &Link,
    h: &Vec3<S>,
    m: &Sym3<S>,
) -> (Vec3<S>, Vec3<S>) {
    if SLIDES && link.kind == JointKind::Prismatic {
        return unit_wrench_of_slide(link, h);
    }
    let inertia = m.xx.clone() + m.yy.clone();
    let force = Vec3::new(-h.y.clone(), h.x.clone(), S::zero());
    (force, Vec3::new(-m.xz.clone(), -m.yz.clone(), inertia))
}

/// Returns the wrench for a prismatic joint: a motion along z takes the force m z and the moment
/// h × z.
#[cold]
#[inline(never)]
fn unit_wrench_of_slide<S: Scalar>(link: &Link, h: &Vec3<S>) -> (Vec3<S>, Vec3<S>) {
    let force = Vec3::new(S::zero(), S::zero(), S::from(link.composite_mass));
    (force, Vec3::new(h.y.clone(), -h.x.clone(), S::zero()))
}

/// Returns the moments of a link and all later ones about the parent's origin.
///
/// Let h = E h_link, p the link's origin and m the mass. The first moment is h + m p, and the
/// second moments are E Σ Eᵀ + p (h + m p / 2)ᵀ + (h + m p / 2) pᵀ.
#[inline(always)]
fn composite_to_parent<S: Scalar, const SLIDES: bool>(
    pose: &Pose<S>,
    link: &Link,
    h: &Vec3<S>,
    m: &Sym3<S>,
) -> (Vec3<S>, Sym3<S>) {
    let half_shift = if SLIDES && link.kind == JointKind::Prismatic {
        pose.origin.scaled(&S::from(0.5 * link.composite_mass))
    } else {
        Vec3::constant(link.half_shift)
    };
    let middle = pose.to_parent(h).plus(&half_shift);
    let mut second_moments = pose.symmetric_to_parent(m);
    second_moments.add_symmetric_product(&pose.origin, &middle);
    (middle.plus(&half_shift), second_moments)
}
