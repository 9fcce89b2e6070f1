//! Mass matrix by the composite-rigid-body algorithm.

use crate::algebra::{Sym3, Vec3};
use crate::link::Link;
use crate::pose::Pose;
use crate::robot::Robot;
use crate::workspace::Workspace;
use nalgebra::DMatrix;
use reachtube_scalar::Scalar;

impl Robot {
    /// Computes the mass matrix M_m(q) = M(q) + diag(armature) of (3) \[kg m²\], n x n, row by row,
    /// both triangles.
    ///
    /// `sin` and `cos` of q have one entry per joint; `m` has n² entries. Composite-rigid-body
    /// algorithm (Walker & Orin 1982; Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 6).
    /// With independent sine and cosine the result is this algorithm's polynomial.
    ///
    /// # Guarantee
    ///
    /// Over `Interval`: an outer enclosure, entry by entry.
    ///
    /// # Panics
    ///
    /// Panics if a slice or the workspace is too short for the robot.
    pub fn crba<S: Scalar>(&self, sin: &[S], cos: &[S], ws: &mut Workspace<S>, m: &mut [S]) {
        let n = self.links.len();
        let (m, sin, cos, scratch) = (&mut m[..n * n], &sin[..n], &cos[..n], &mut ws.links[..n]);
        for i in 0..n {
            scratch[i].pose = self.links[i].pose(&sin[i], &cos[i]);
        }
        let Some(last) = self.links.last() else { return };
        let (mut first_moment, mut second_moments) = last.moments::<S>();
        for i in (0..n).rev() {
            // A unit acceleration about z takes the force z × h and the moment I z.
            let inertia = second_moments.xx.clone() + second_moments.yy.clone();
            m[i * n + i] = inertia.clone() + S::from(self.links[i].armature);
            let mut force = Vec3::new(-first_moment.y.clone(), first_moment.x.clone(), S::zero());
            let mut moment =
                Vec3::new(-second_moments.xz.clone(), -second_moments.yz.clone(), inertia);
            // Its axis components at the joints towards the base are row and column i of M.
            for j in (1..=i).rev() {
                let pose = &scratch[j].pose;
                force = pose.to_parent(&force);
                moment = pose.to_parent(&moment).plus(&pose.origin.cross(&force));
                m[i * n + j - 1] = moment.z.clone();
                m[(j - 1) * n + i] = moment.z.clone();
            }
            // The composite body grows by the next link towards the base.
            if i > 0 {
                let shifted = composite_to_parent(
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

/// Returns the moments of a link and all later ones about the parent's origin.
///
/// Let h = E h_link, p the link's origin and m the mass. The first moment is h + m p, and the
/// second moments are E Σ Eᵀ + p (h + m p / 2)ᵀ + (h + m p / 2) pᵀ.
#[inline(always)]
fn composite_to_parent<S: Scalar>(
    pose: &Pose<S>,
    link: &Link,
    h: &Vec3<S>,
    m: &Sym3<S>,
) -> (Vec3<S>, Sym3<S>) {
    let half_shift = Vec3::constant(link.half_shift);
    let middle = pose.to_parent(h).plus(&half_shift);
    let mut second_moments = pose.symmetric_to_parent(m);
    second_moments.add_symmetric_product(&pose.origin, &middle);
    (middle.plus(&half_shift), second_moments)
}
