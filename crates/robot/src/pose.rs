//! The pose of a link relative to its parent.

use crate::algebra::{Sym3, Vec3, det2, sum2};
use reachtube_scalar::Scalar;

/// The pose of a link in its parent at one joint position:
/// x_parent = Rx(twist) Rz(angle) x_link + origin.
///
/// Two plane rotations cost 8 products per vector. A full matrix costs 9, and forming it comes on
/// top.
#[derive(Clone, Debug)]
pub(crate) struct Pose<S> {
    pub sin: S,
    pub cos: S,
    pub sin_twist: S,
    pub cos_twist: S,
    /// Origin of the link's frame in the parent's frame \[m\].
    pub origin: Vec3<S>,
}

impl<S: Scalar> Pose<S> {
    /// Returns the pose of a frame that coincides with its parent.
    pub(crate) fn identity() -> Self {
        let (zero, one) = (S::zero, S::one);
        Self { sin: zero(), cos: one(), sin_twist: zero(), cos_twist: one(), origin: Vec3::zero() }
    }

    /// Rotates a free vector from link to parent coordinates.
    #[inline(always)]
    pub(crate) fn to_parent(&self, v: &Vec3<S>) -> Vec3<S> {
        let x = det2(&self.cos, &v.x, &self.sin, &v.y);
        let y = sum2(&self.sin, &v.x, &self.cos, &v.y);
        Vec3::new(
            x,
            det2(&self.cos_twist, &y, &self.sin_twist, &v.z),
            sum2(&self.sin_twist, &y, &self.cos_twist, &v.z),
        )
    }

    /// Rotates a free vector from parent to link coordinates.
    #[inline(always)]
    pub(crate) fn to_link(&self, v: &Vec3<S>) -> Vec3<S> {
        let y = sum2(&self.cos_twist, &v.y, &self.sin_twist, &v.z);
        let z = det2(&self.cos_twist, &v.z, &self.sin_twist, &v.y);
        Vec3::new(sum2(&self.cos, &v.x, &self.sin, &y), det2(&self.cos, &y, &self.sin, &v.x), z)
    }

    /// Returns E A Eᵀ, which is a symmetric A rotated from link to parent coordinates.
    #[inline(always)]
    pub(crate) fn symmetric_to_parent(&self, a: &Sym3<S>) -> Sym3<S> {
        let (s, c) = (&self.sin, &self.cos);
        let (px, py) = (det2(c, &a.xx, s, &a.xy), det2(c, &a.xy, s, &a.yy));
        let (qx, qy) = (sum2(s, &a.xx, c, &a.xy), sum2(s, &a.xy, c, &a.yy));
        let (xx, xy, yy) = (det2(c, &px, s, &py), sum2(s, &px, c, &py), sum2(s, &qx, c, &qy));
        let (xz, yz) = (det2(c, &a.xz, s, &a.yz), sum2(s, &a.xz, c, &a.yz));
        let (s, c) = (&self.sin_twist, &self.cos_twist);
        let (py, pz) = (det2(c, &yy, s, &yz), det2(c, &yz, s, &a.zz));
        let (qy, qz) = (sum2(s, &yy, c, &yz), sum2(s, &yz, c, &a.zz));
        Sym3 {
            xx,
            xy: det2(c, &xy, s, &xz),
            xz: sum2(s, &xy, c, &xz),
            yy: det2(c, &py, s, &pz),
            yz: sum2(s, &py, c, &pz),
            zz: sum2(s, &qy, c, &qz),
        }
    }

    /// Returns the rows of E H Eᵀ for a matrix H that is given by its rows.
    #[inline(always)]
    pub(crate) fn general_to_parent(&self, h: &[Vec3<S>; 3]) -> [Vec3<S>; 3] {
        let [x, y, z] = [0, 1, 2].map(|i| self.to_parent(&h[i]));
        let column =
            |a: &S, b: &S, c: &S| self.to_parent(&Vec3::new(a.clone(), b.clone(), c.clone()));
        let (a, b, c) =
            (column(&x.x, &y.x, &z.x), column(&x.y, &y.y, &z.y), column(&x.z, &y.z, &z.z));
        [Vec3::new(a.x, b.x, c.x), Vec3::new(a.y, b.y, c.y), Vec3::new(a.z, b.z, c.z)]
    }
}
