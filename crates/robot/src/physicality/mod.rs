//! Whether a robot's mass matrix is positive definite, as that of every body is.

mod cover;
mod search;

use crate::chain::Link;
use crate::{Robot, RobotError, ltdl};
use reachtube_scalar::Interval;

/// How it is known that the mass matrix M_m(q) is positive definite.
#[derive(Clone, Debug, PartialEq)]
pub enum Physicality {
    /// Proved for every position: each link's pseudo-inertia is positive semidefinite, by interval
    /// arithmetic, and no joint is without inertia of its own.
    Links {
        /// No pivot is below this at any position \[kg m²\].
        least_pivot: f64,
    },
    /// Searched, not proved: no violation among the positions that were tried.
    Searched {
        /// Number of positions, those of the descent included.
        positions: usize,
        /// Index of the joint with the smallest pivot.
        joint: usize,
        /// That pivot \[kg m²\].
        pivot: f64,
        /// Where it was found \[rad\].
        q: Vec<f64>,
    },
}

impl Robot {
    /// Whether M_m(q) is positive definite: proved from the links, else searched for a position
    /// where it is not.
    ///
    /// Pivot i of M = Lᵀ D L is the articulated inertia about joint i; M is positive definite if
    /// and only if all are positive. The search samples the position limits evenly and descends
    /// along the joints; it is reproducible.
    ///
    /// # Guarantee
    ///
    /// [`Physicality::Links`] is a proof for the links' inertias as loaded, under outward rounding,
    /// with joint rotations taken as exact. [`Physicality::Searched`] proves nothing;
    /// [`Robot::prove_positive_definite`] may.
    ///
    /// # Errors
    ///
    /// [`RobotError::NotPhysical`] with a position, the joint and its pivot of zero or less.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::{Physicality, Robot};
    ///
    /// let known = Robot::lwa4p().check_physical().unwrap();
    /// assert!(matches!(known, Physicality::Searched { joint: 5, .. }));
    /// ```
    pub fn check_physical(&self) -> Result<Physicality, RobotError> {
        if let Some(least_pivot) = self.least_pivot_of_links() {
            return Ok(Physicality::Links { least_pivot });
        }
        self.search_pivots()
    }

    /// A lower bound of all pivots where every link is a body: what hangs on a joint can only add
    /// to its own link.
    fn least_pivot_of_links(&self) -> Option<f64> {
        let own = |link: &Link| {
            let [xx, _, _, yy, ..] = link.second_moments.map(Interval::point);
            (xx + yy + Interval::point(link.armature)).lo()
        };
        let bodies = self.links.iter().all(Link::is_body);
        let least = self.links.iter().map(own).fold(f64::INFINITY, f64::min);
        (bodies && least > 0.0).then_some(least)
    }
}

impl Link {
    /// Whether the pseudo-inertia [[Σ, h], [hᵀ, m]] is certainly positive semidefinite: all zero,
    /// or with positive pivots in interval arithmetic.
    fn is_body(&self) -> bool {
        let [xx, xy, xz, yy, yz, zz] = self.second_moments;
        let [hx, hy, hz] = self.first_moment;
        let pseudo = [xx, xy, xz, hx, xy, yy, yz, hy, xz, yz, zz, hz, hx, hy, hz, self.mass];
        if pseudo.iter().all(|x| *x == 0.0) {
            return true;
        }
        let mut pseudo = pseudo.map(Interval::point);
        ltdl::factor(&mut pseudo, 4);
        (0..4).all(|i| pseudo[5 * i].lo() > 0.0)
    }
}
