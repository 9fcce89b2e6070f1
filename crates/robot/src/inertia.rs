//! The inertial parameters of one link.

use crate::placement::Placement;
use nalgebra::{Matrix3, Matrix4, SymmetricEigen, Vector3};

/// Number of inertial parameters of one link: m, m c_x, m c_y, m c_z, Ixx, Ixy, Iyy, Ixz, Iyz, Izz.
pub(crate) const INERTIAL: usize = 10;

/// The ten inertial parameters of one link, as moments of its mass distribution about a frame's
/// origin.
///
/// The second moments Σ = ∫ r rᵀ dm replace the inertia tensor I = tr(Σ) 1 - Σ. In another frame
/// they are R Σ Rᵀ + p hᵀ + h pᵀ + m p pᵀ. The link is physical if and only if the pseudo-inertia
/// [[Σ, h], [hᵀ, m]] is positive semidefinite (Wensing, Kim & Slotine, RA-L 2018).
#[derive(Clone, Debug, PartialEq)]
pub struct LinkInertia {
    /// Mass m \[kg\].
    pub mass: f64,
    /// First moment h = m c \[kg m\], with c the centre of mass.
    pub first_moment: Vector3<f64>,
    /// Second moments Σ = ∫ r rᵀ dm about the frame's origin \[kg m²\], symmetric.
    pub second_moments: Matrix3<f64>,
}

impl LinkInertia {
    /// Makes a link from its inertia tensor about the frame's origin \[kg m²\].
    pub(crate) fn about_origin(
        mass: f64,
        first_moment: Vector3<f64>,
        inertia: &Matrix3<f64>,
    ) -> Self {
        let second_moments = Matrix3::identity() * (0.5 * inertia.trace()) - inertia;
        Self { mass, first_moment, second_moments }
    }

    /// Makes a link from its centre of mass \[m\] and its inertia tensor about that point
    /// \[kg m²\], in the frame's axes.
    pub(crate) fn about_com(mass: f64, com: Vector3<f64>, inertia: &Matrix3<f64>) -> Self {
        let h = mass * com;
        let mut link = Self::about_origin(mass, h, inertia);
        link.second_moments += h * com.transpose();
        link
    }

    /// Returns the inertia tensor about the frame's origin \[kg m²\].
    pub(crate) fn tensor(&self) -> Matrix3<f64> {
        Matrix3::identity() * self.second_moments.trace() - self.second_moments
    }

    /// Returns mass \[kg\], centre of mass \[m\], and ixx, ixy, ixz, iyy, iyz, izz about it
    /// \[kg m²\].
    ///
    /// A link without mass has its centre of mass at the origin.
    pub fn about_own_com(&self) -> (f64, [f64; 3], [f64; 6]) {
        let c = if self.mass == 0.0 { Vector3::zeros() } else { self.first_moment / self.mass };
        let t = self.tensor()
            - self.mass * (Matrix3::identity() * c.norm_squared() - c * c.transpose());
        (self.mass, c.into(), [t[(0, 0)], t[(0, 1)], t[(0, 2)], t[(1, 1)], t[(1, 2)], t[(2, 2)]])
    }

    /// Returns the smallest eigenvalue of the pseudo-inertia [[Σ, h], [hᵀ, m]], relative to the
    /// eigenvalue of largest magnitude.
    ///
    /// Up to rounding, it is zero or more if and only if some distribution of positive mass has
    /// these ten parameters.
    pub(crate) fn smallest_relative_eigenvalue(&self) -> f64 {
        let mut pseudo = Matrix4::zeros();
        pseudo.fixed_view_mut::<3, 3>(0, 0).copy_from(&self.second_moments);
        pseudo.fixed_view_mut::<3, 1>(0, 3).copy_from(&self.first_moment);
        pseudo.fixed_view_mut::<1, 3>(3, 0).copy_from(&self.first_moment.transpose());
        pseudo[(3, 3)] = self.mass;
        let eigenvalues = SymmetricEigen::new(pseudo).eigenvalues;
        let scale = eigenvalues.amax();
        if scale == 0.0 { 0.0 } else { eigenvalues.min() / scale }
    }

    /// Returns the same link about another frame, in which the present frame has the placement
    /// `to`.
    pub fn moved(&self, to: &Placement) -> Self {
        let (r, p) = (&to.rotation, &to.translation);
        let h = r * self.first_moment;
        let shift = p * h.transpose();
        Self {
            mass: self.mass,
            first_moment: h + self.mass * p,
            second_moments: r * self.second_moments * r.transpose()
                + shift
                + shift.transpose()
                + self.mass * p * p.transpose(),
        }
    }

    /// Returns the two links as one; both are about the same frame.
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            mass: self.mass + other.mass,
            first_moment: self.first_moment + other.first_moment,
            second_moments: self.second_moments + other.second_moments,
        }
    }

    /// Returns m, m c_x, m c_y, m c_z, Ixx, Ixy, Iyy, Ixz, Iyz, Izz about the frame's origin.
    pub(crate) fn parameters(&self) -> [f64; INERTIAL] {
        let (h, i) = (&self.first_moment, self.tensor());
        let [xx, xy, yy, xz, yz, zz] =
            [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)].map(|k| i[k]);
        [self.mass, h.x, h.y, h.z, xx, xy, yy, xz, yz, zz]
    }

    /// Makes a link from m, m c_x, m c_y, m c_z, Ixx, Ixy, Iyy, Ixz, Iyz, Izz about the frame's
    /// origin.
    pub fn from_parameters(p: &[f64; INERTIAL]) -> Self {
        let tensor = Matrix3::new(p[4], p[5], p[7], p[5], p[6], p[8], p[7], p[8], p[9]);
        Self::about_origin(p[0], Vector3::new(p[1], p[2], p[3]), &tensor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_mass_has_its_moment_about_the_origin() {
        // 2 kg at 0.5 m.
        let link = LinkInertia::about_com(2.0, Vector3::new(0.5, 0.0, 0.0), &Matrix3::zeros());
        assert_eq!(link.tensor()[(2, 2)], 0.5);
    }
}
