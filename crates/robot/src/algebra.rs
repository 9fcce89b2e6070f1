//! 3-vectors and symmetric 3 x 3 matrices over any [`Scalar`], limited to what rigid-body dynamics
//! needs.

use reachtube_scalar::Scalar;

/// A vector (x, y, z).
#[derive(Clone, Debug)]
pub(crate) struct Vec3<S> {
    pub x: S,
    pub y: S,
    pub z: S,
}

/// A symmetric 3 x 3 matrix, stored as its six independent entries.
#[derive(Clone, Debug)]
pub(crate) struct Sym3<S> {
    pub xx: S,
    pub xy: S,
    pub xz: S,
    pub yy: S,
    pub yz: S,
    pub zz: S,
}

#[inline(always)]
pub(crate) fn mul<S: Scalar>(a: &S, b: &S) -> S {
    a.clone() * b.clone()
}

/// Returns k a for a constant k of the robot.
#[inline(always)]
pub(crate) fn scale<S: Scalar>(k: f64, a: &S) -> S {
    S::from(k) * a.clone()
}

#[inline(always)]
pub(crate) fn sum2<S: Scalar>(a: &S, b: &S, c: &S, d: &S) -> S {
    mul(a, b) + mul(c, d)
}

#[inline(always)]
pub(crate) fn det2<S: Scalar>(a: &S, b: &S, c: &S, d: &S) -> S {
    mul(a, b) - mul(c, d)
}

impl<S: Scalar> Vec3<S> {
    #[inline(always)]
    pub(crate) fn new(x: S, y: S, z: S) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self::new(S::zero(), S::zero(), S::zero())
    }

    #[inline(always)]
    pub(crate) fn constant(v: [f64; 3]) -> Self {
        let [x, y, z] = v.map(S::from);
        Self { x, y, z }
    }

    #[inline(always)]
    pub(crate) fn cross(&self, b: &Self) -> Self {
        Self::new(
            det2(&self.y, &b.z, &self.z, &b.y),
            det2(&self.z, &b.x, &self.x, &b.z),
            det2(&self.x, &b.y, &self.y, &b.x),
        )
    }

    #[inline(always)]
    pub(crate) fn dot(&self, b: &Self) -> S {
        sum2(&self.x, &b.x, &self.y, &b.y) + mul(&self.z, &b.z)
    }

    #[inline(always)]
    pub(crate) fn scaled(&self, k: &S) -> Self {
        Self::new(mul(&self.x, k), mul(&self.y, k), mul(&self.z, k))
    }

    #[inline(always)]
    pub(crate) fn plus(self, b: &Self) -> Self {
        Self::new(self.x + b.x.clone(), self.y + b.y.clone(), self.z + b.z.clone())
    }

    #[inline(always)]
    pub(crate) fn accumulate(&mut self, b: &Self) {
        self.x += b.x.clone();
        self.y += b.y.clone();
        self.z += b.z.clone();
    }

    #[inline(always)]
    pub(crate) fn subtract(&mut self, b: &Self) {
        self.x -= b.x.clone();
        self.y -= b.y.clone();
        self.z -= b.z.clone();
    }
}

impl<S: Scalar> Sym3<S> {
    #[inline(always)]
    pub(crate) fn constant(m: [f64; 6]) -> Self {
        let [xx, xy, xz, yy, yz, zz] = m.map(S::from);
        Self { xx, xy, xz, yy, yz, zz }
    }

    #[inline(always)]
    pub(crate) fn times(&self, v: &Vec3<S>) -> Vec3<S> {
        Vec3::new(
            sum2(&self.xx, &v.x, &self.xy, &v.y) + mul(&self.xz, &v.z),
            sum2(&self.xy, &v.x, &self.yy, &v.y) + mul(&self.yz, &v.z),
            sum2(&self.xz, &v.x, &self.yz, &v.y) + mul(&self.zz, &v.z),
        )
    }

    #[inline(always)]
    pub(crate) fn accumulate(&mut self, b: &Self) {
        self.xx += b.xx.clone();
        self.xy += b.xy.clone();
        self.xz += b.xz.clone();
        self.yy += b.yy.clone();
        self.yz += b.yz.clone();
        self.zz += b.zz.clone();
    }

    #[inline(always)]
    pub(crate) fn add_symmetric_product(&mut self, a: &Vec3<S>, b: &Vec3<S>) {
        let (xx, yy, zz) = (mul(&a.x, &b.x), mul(&a.y, &b.y), mul(&a.z, &b.z));
        self.xx += xx.clone() + xx;
        self.yy += yy.clone() + yy;
        self.zz += zz.clone() + zz;
        self.xy += sum2(&a.x, &b.y, &b.x, &a.y);
        self.xz += sum2(&a.x, &b.z, &b.x, &a.z);
        self.yz += sum2(&a.y, &b.z, &b.y, &a.z);
    }

    /// Subtracts a bᵀ, which is symmetric because b is parallel to a.
    #[inline(always)]
    pub(crate) fn subtract_product(&mut self, a: &Vec3<S>, b: &Vec3<S>) {
        self.xx -= mul(&a.x, &b.x);
        self.xy -= mul(&a.x, &b.y);
        self.xz -= mul(&a.x, &b.z);
        self.yy -= mul(&a.y, &b.y);
        self.yz -= mul(&a.y, &b.z);
        self.zz -= mul(&a.z, &b.z);
    }

    /// Adds [p]× H'ᵀ - H [p]×, which is symmetric for H' = H + [p]× M; `h` and `shifted` hold the
    /// rows of H and H'.
    #[inline(always)]
    pub(crate) fn add_shift(&mut self, p: &Vec3<S>, h: &[Vec3<S>; 3], shifted: &[Vec3<S>; 3]) {
        let (x, y, z) = (p.cross(&shifted[0]), p.cross(&shifted[1]), p.cross(&shifted[2]));
        // Row i of H [p]× is h_i × p.
        let (hx, hy, hz) = (p.cross(&h[0]), p.cross(&h[1]), p.cross(&h[2]));
        self.xx += x.x + hx.x;
        self.xy += y.x.clone() + hx.y;
        self.xz += z.x.clone() + hx.z;
        self.yy += y.y + hy.y;
        self.yz += z.y + hy.z;
        self.zz += z.z + hz.z;
    }
}
