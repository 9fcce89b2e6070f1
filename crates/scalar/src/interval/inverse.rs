//! The logarithm and the angle of a point, from enclosures of their inverse functions.

use super::closed::Interval;

impl Interval {
    /// Encloses {ln x} over the positive x of the interval; it is [`ENTIRE`](Self::ENTIRE) if there
    /// are none.
    ///
    /// It corrects the guess of the platform's `ln` by [`exp`](Self::exp).
    ///
    /// # Guarantee
    /// Outer. For a point, the width is at most 4e-15 in every test: absolute where |ln x| ≤ 1,
    /// relative elsewhere.
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// let x = Interval::new(1.0, 10.0).unwrap().ln();
    /// assert!(x.contains(0.0) && x.contains(10f64.ln()) && x.hi() < 2.30258509299405);
    /// ```
    #[must_use]
    pub fn ln(self) -> Interval {
        if self.hi <= 0.0 {
            return Interval::ENTIRE;
        }
        let lo = if self.lo <= 0.0 { f64::NEG_INFINITY } else { ln_of(self.lo).lo };
        let hi = if self.hi == f64::INFINITY { f64::INFINITY } else { ln_of(self.hi).hi };
        Interval { lo, hi }
    }

    /// Encloses the angles of the points (x, self), in rad within [-π, π].
    ///
    /// The result is [-π, π], rounded outwards, where the box contains the origin, crosses the
    /// negative x axis or is unbounded. Elsewhere it corrects the guess of the platform's `atan2`
    /// by [`sin_cos`](Self::sin_cos).
    ///
    /// # Guarantee
    /// Outer. For a point, the width is below 4e-15 rad in every test.
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// let angle = Interval::ONE.atan2(Interval::new(-1.0, 1.0).unwrap());
    /// assert!(angle.contains(std::f64::consts::FRAC_PI_4) && angle.contains(2.35));
    /// assert!(angle.width() < 1.571);
    /// ```
    #[must_use]
    pub fn atan2(self, x: Interval) -> Interval {
        let y = self;
        let on_cut = x.lo < 0.0 && y.lo < 0.0 && y.hi >= 0.0;
        let unbounded = [x.lo, x.hi, y.lo, y.hi].iter().any(|end| end.is_infinite());
        if on_cut || x.contains_zero() && y.contains_zero() || unbounded {
            return Interval { lo: -Interval::PI.hi, hi: Interval::PI.hi };
        }
        // Away from the origin and the cut, the angle is monotone along each edge, so its extremes
        // are at vertices.
        let [a, b, c, d] = [(y.lo, x.lo), (y.lo, x.hi), (y.hi, x.lo), (y.hi, x.hi)]
            .map(|(y, x)| angle_of(y + 0.0, x));
        a.hull(b).hull(c.hull(d))
    }
}

/// Encloses ln x = y + ln(1 + t) for 1 + t = x e^(-y), by t / (1 + t) ≤ ln(1 + t) ≤ t.
fn ln_of(x: f64) -> Interval {
    let y = x.ln();
    // x and e^(-y) can each leave [2^-1022, 2^1022], but e^(-y/2) cannot.
    let root = Interval::point(-0.5 * y).exp();
    let t = Interval::point(x) * root * root - 1.0;
    Interval::point(y) + (t / (t + 1.0)).hull(t)
}

/// Encloses the angle of (x, y): a guess plus the angle of the point rotated back by the guess.
///
/// The rotated point has the slope z, and the angle atan z lies between z (1 - z²) and z.
fn angle_of(y: f64, x: f64) -> Interval {
    // Scaling by a power of two keeps the angle and prevents overflow and underflow of products.
    let scale = 2f64.powi(-(x.abs().max(y.abs()).log2().floor() as i32).clamp(-1000, 1000));
    let (x, y) = (Interval::point(x) * scale, Interval::point(y) * scale);
    let guess = y.mid().atan2(x.mid());
    let (s, c) = Interval::point(guess).sin_cos();
    let z = (y * c - x * s) / (x * c + y * s);
    Interval::point(guess) + z * (Interval::ONE - z.sqr()).hull(Interval::ONE)
}
