//! Logarithm and the angle of a point: the inverses of functions that are known to be enclosed.

use super::Interval;

impl Interval {
    /// {ln x} over the positive x of the interval; [`ENTIRE`](Self::ENTIRE) where there is none.
    ///
    /// # Guarantee
    /// Outer; each end within 1e-15 (relative where |ln x| > 1, else absolute). The platform's `ln`
    /// is a guess that [`exp`](Self::exp) corrects.
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

    /// The angles of the points (x, self), in [-π, π]; all of that where the box holds the origin
    /// or crosses the negative x axis.
    ///
    /// # Guarantee
    /// Outer; each end within 1e-15. The platform's `atan2` is a guess that
    /// [`sin_cos`](Self::sin_cos) corrects.
    ///
    /// ```
    /// use reachtube_scalar::Interval;
    ///
    /// let angle = Interval::ONE.atan2(Interval::new(-1.0, 1.0).unwrap());
    /// assert!(angle.contains(std::f64::consts::FRAC_PI_4) && angle.contains(2.35) && angle.width() < 1.571);
    /// ```
    #[must_use]
    pub fn atan2(self, x: Interval) -> Interval {
        let y = self;
        let on_cut = x.lo < 0.0 && y.lo < 0.0 && y.hi >= 0.0;
        let unbounded = [x.lo, x.hi, y.lo, y.hi].iter().any(|end| end.is_infinite());
        if on_cut || x.contains_zero() && y.contains_zero() || unbounded {
            return Interval { lo: -Interval::PI.hi, hi: Interval::PI.hi };
        }
        // Away from the origin and the cut the angle is monotone along each edge, and extreme in a
        // corner.
        let corner = |y: f64, x: f64| angle_of(y + 0.0, x);
        let [a, b, c, d] =
            [(y.lo, x.lo), (y.lo, x.hi), (y.hi, x.lo), (y.hi, x.hi)].map(|(y, x)| corner(y, x));
        a.hull(b).hull(c.hull(d))
    }
}

/// ln x = y + ln(1 + t) for 1 + t = x e^(-y), where t / (1 + t) ≤ ln(1 + t) ≤ t.
fn ln_of(x: f64) -> Interval {
    let y = x.ln();
    // x and e^-y may be beyond 2^±1022 each; halves are not.
    let root = Interval::point(-0.5 * y).exp();
    let t = Interval::point(x) * root * root - 1.0;
    Interval::point(y) + (t / (t + 1.0)).hull(t)
}

/// The angle of (x, y) is a guess plus that of the point turned back by the guess, where z - z³/3 ≤
/// atan z ≤ z for z ≥ 0.
fn angle_of(y: f64, x: f64) -> Interval {
    // A point scaled by a power of two has the same angle, and its products neither overflow nor
    // vanish.
    let scale = 2f64.powi(-(x.abs().max(y.abs()).log2().floor() as i32).clamp(-1000, 1000));
    let (x, y) = (Interval::point(x) * scale, Interval::point(y) * scale);
    let guess = y.mid().atan2(x.mid());
    let (s, c) = Interval::point(guess).sin_cos();
    let z = (y * c - x * s) / (x * c + y * s);
    Interval::point(guess) + z * (Interval::ONE - z.sqr()).hull(Interval::ONE)
}
