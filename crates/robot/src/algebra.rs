//! Vectors of three and symmetric matrices over any [`Scalar`], no more than rigid-body dynamics
//! needs.

use reachtube_scalar::Scalar;

/// A vector (x, y, z).
#[derive(Clone, Debug)]
pub(crate) struct Vec3<S> {
    pub x: S,
    pub y: S,
    pub z: S,
}

/// A symmetric 3 x 3 matrix by its six entries.
#[derive(Clone, Debug)]
pub(crate) struct Sym3<S> {
    pub xx: S,
    pub xy: S,
    pub xz: S,
    pub yy: S,
    pub yz: S,
    pub zz: S,
}

/// A b.
#[inline(always)]
pub(crate) fn mul<S: Scalar>(a: &S, b: &S) -> S {
    a.clone() * b.clone()
}

/// k a for a constant of the robot.
#[inline(always)]
pub(crate) fn scale<S: Scalar>(k: f64, a: &S) -> S {
    S::from(k) * a.clone()
}

/// a b + c d.
#[inline(always)]
pub(crate) fn sum2<S: Scalar>(a: &S, b: &S, c: &S, d: &S) -> S {
    mul(a, b) + mul(c, d)
}

/// a b - c d.
#[inline(always)]
pub(crate) fn det2<S: Scalar>(a: &S, b: &S, c: &S, d: &S) -> S {
    mul(a, b) - mul(c, d)
}

impl<S: Scalar> Vec3<S> {
    #[inline(always)]
    pub fn new(x: S, y: S, z: S) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(S::zero(), S::zero(), S::zero())
    }

    #[inline(always)]
    pub fn constant(v: [f64; 3]) -> Self {
        let [x, y, z] = v.map(S::from);
        Self { x, y, z }
    }

    #[inline(always)]
    pub fn cross(&self, b: &Self) -> Self {
        Self::new(
            det2(&self.y, &b.z, &self.z, &b.y),
            det2(&self.z, &b.x, &self.x, &b.z),
            det2(&self.x, &b.y, &self.y, &b.x),
        )
    }

    #[inline(always)]
    pub fn dot(&self, b: &Self) -> S {
        sum2(&self.x, &b.x, &self.y, &b.y) + mul(&self.z, &b.z)
    }

    #[inline(always)]
    pub fn scaled(&self, k: &S) -> Self {
        Self::new(mul(&self.x, k), mul(&self.y, k), mul(&self.z, k))
    }

    #[inline(always)]
    pub fn plus(self, b: &Self) -> Self {
        Self::new(self.x + b.x.clone(), self.y + b.y.clone(), self.z + b.z.clone())
    }

    #[inline(always)]
    pub fn accumulate(&mut self, b: &Self) {
        self.x += b.x.clone();
        self.y += b.y.clone();
        self.z += b.z.clone();
    }
}

impl<S: Scalar> Sym3<S> {
    #[inline(always)]
    pub fn constant(m: [f64; 6]) -> Self {
        let [xx, xy, xz, yy, yz, zz] = m.map(S::from);
        Self { xx, xy, xz, yy, yz, zz }
    }

    #[inline(always)]
    pub fn times(&self, v: &Vec3<S>) -> Vec3<S> {
        Vec3::new(
            sum2(&self.xx, &v.x, &self.xy, &v.y) + mul(&self.xz, &v.z),
            sum2(&self.xy, &v.x, &self.yy, &v.y) + mul(&self.yz, &v.z),
            sum2(&self.xz, &v.x, &self.yz, &v.y) + mul(&self.zz, &v.z),
        )
    }

    #[inline(always)]
    pub fn accumulate(&mut self, b: &Self) {
        self.xx += b.xx.clone();
        self.xy += b.xy.clone();
        self.xz += b.xz.clone();
        self.yy += b.yy.clone();
        self.yz += b.yz.clone();
        self.zz += b.zz.clone();
    }

    /// Adds a bᵀ + b aᵀ.
    #[inline(always)]
    pub fn add_symmetric_product(&mut self, a: &Vec3<S>, b: &Vec3<S>) {
        let (xx, yy, zz) = (mul(&a.x, &b.x), mul(&a.y, &b.y), mul(&a.z, &b.z));
        self.xx += xx.clone() + xx;
        self.yy += yy.clone() + yy;
        self.zz += zz.clone() + zz;
        self.xy += sum2(&a.x, &b.y, &b.x, &a.y);
        self.xz += sum2(&a.x, &b.z, &b.x, &a.z);
        self.yz += sum2(&a.y, &b.z, &b.y, &a.z);
    }
}

/// The pose of a link in its parent, at the joint's angle: x_parent = Rx(twist) Rz(angle) x_link +
/// origin.
///
/// Two plane rotations cost 8 products a vector where a full matrix costs 9 and must be formed
/// first.
#[derive(Clone, Debug)]
pub(crate) struct Pose<S> {
    pub sin: S,
    pub cos: S,
    pub sin_twist: S,
    pub cos_twist: S,
    pub origin: Vec3<S>,
}

impl<S: Scalar> Pose<S> {
    /// A free vector from link to parent coordinates.
    #[inline(always)]
    pub fn to_parent(&self, v: &Vec3<S>) -> Vec3<S> {
        let x = det2(&self.cos, &v.x, &self.sin, &v.y);
        let y = sum2(&self.sin, &v.x, &self.cos, &v.y);
        Vec3::new(
            x,
            det2(&self.cos_twist, &y, &self.sin_twist, &v.z),
            sum2(&self.sin_twist, &y, &self.cos_twist, &v.z),
        )
    }

    /// A free vector from parent to link coordinates.
    #[inline(always)]
    pub fn to_link(&self, v: &Vec3<S>) -> Vec3<S> {
        let y = sum2(&self.cos_twist, &v.y, &self.sin_twist, &v.z);
        let z = det2(&self.cos_twist, &v.z, &self.sin_twist, &v.y);
        Vec3::new(sum2(&self.cos, &v.x, &self.sin, &y), det2(&self.cos, &y, &self.sin, &v.x), z)
    }

    /// E A Eᵀ for a symmetric A, from link to parent coordinates.
    #[inline(always)]
    pub fn symmetric_to_parent(&self, a: &Sym3<S>) -> Sym3<S> {
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
}
