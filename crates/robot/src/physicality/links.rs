//! Proof from the links' inertias that the mass matrix is positive definite.

use super::outcome::Physicality;
use crate::error::RobotError;
use crate::joint_kind::JointKind;
use crate::link::Link;
use crate::ltdl;
use crate::robot::Robot;
use reachtube_scalar::Interval;

impl Robot {
    /// Checks whether M_m(q) is positive definite: by a proof from the links if possible, and
    /// otherwise by a search for a position where it is not.
    ///
    /// Pivot i of M = Lᵀ D L is the articulated inertia about joint i. M is positive definite if
    /// and only if all pivots are positive. The search samples the position limits evenly and
    /// descends along the joints; it is reproducible.
    ///
    /// # Guarantee
    ///
    /// [`Physicality::Links`] is a proof for the links' inertias as loaded, under outward rounding,
    /// with joint rotations taken as exact. [`Physicality::Searched`] proves nothing.
    ///
    /// # Errors
    ///
    /// Returns [`RobotError::NotPhysical`] with a position, and the joint whose pivot is not
    /// positive there.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::{Physicality, Robot};
    ///
    /// let outcome = Robot::lwa4p().check_physical().unwrap();
    /// assert!(matches!(outcome, Physicality::Searched { joint: 5, .. }));
    /// ```
    pub fn check_physical(&self) -> Result<Physicality, RobotError> {
        if let Some(least_pivot) = self.least_pivot_of_links() {
            return Ok(Physicality::Links { least_pivot });
        }
        self.search_pivots()
    }

    /// Returns a positive lower bound of all pivots if every link is a body.
    ///
    /// The later links can only add to the inertia of a joint's own link.
    fn least_pivot_of_links(&self) -> Option<f64> {
        let own_inertia = |link: &Link| {
            let [xx, _, _, yy, ..] = link.second_moments.map(Interval::point);
            let own = match link.kind {
                JointKind::Revolute => xx + yy,
                JointKind::Prismatic => Interval::point(link.mass),
            };
            (own + Interval::point(link.armature)).lo()
        };
        let bodies = self.links.iter().all(is_body);
        let least = self.links.iter().map(own_inertia).fold(f64::INFINITY, f64::min);
        (bodies && least > 0.0).then_some(least)
    }
}

/// Returns whether the pseudo-inertia [[Σ, h], [hᵀ, m]] is proved positive semidefinite: it is
/// zero, or all its pivots are positive in interval arithmetic.
fn is_body(link: &Link) -> bool {
    let [xx, xy, xz, yy, yz, zz] = link.second_moments;
    let [hx, hy, hz] = link.first_moment;
    let pseudo = [xx, xy, xz, hx, xy, yy, yz, hy, xz, yz, zz, hz, hx, hy, hz, link.mass];
    if pseudo.iter().all(|x| *x == 0.0) {
        return true;
    }
    let mut pseudo = pseudo.map(Interval::point);
    ltdl::factor(&mut pseudo, 4);
    (0..4).all(|i| pseudo[5 * i].lo() > 0.0)
}
