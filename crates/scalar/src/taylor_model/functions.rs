//! Elementary functions by Taylor's theorem with Lagrange's remainder.

use super::model::TaylorModel;
use crate::elementary::Elementary;
use crate::interval::closed::Interval;

impl TaylorModel {
    /// Returns f(self), where `series(x, n)` encloses f^(i)(ξ) / i! for every ξ of x and i = 0 to
    /// n.
    ///
    /// Let c be the constant term, near the midpoint of the range, a a value of the model and δ the
    /// difference a - c. Then f(a) = Σ f^(i)(c)/i! δ^i + f^(p+1)(ξ)/(p+1)! δ^(p+1) with i ≤ p and ξ
    /// between c and a. The sum is evaluated by Horner's rule over models.
    fn composed(&self, series: impl Fn(Interval, u32) -> Vec<Interval>) -> Self {
        let values = |x| Self::from(series(x, 0)[0]);
        let Some(space) = self.polynomial.space() else { return values(self.range()) };
        let (order, centre) = (space.order(), self.polynomial.constant_term());
        let whole = self.range().hull(Interval::point(centre));
        if whole.mag() == f64::INFINITY || order == 0 {
            return values(whole);
        }
        // The sum over i ≤ p.
        let offset = self - &Self::from(centre);
        let mut sum = Self::from(0.0);
        for coefficient in series(Interval::point(centre), order).into_iter().rev() {
            sum = &(&sum * &offset) + &Self::from(coefficient);
        }
        // Lagrange's remainder over the whole range.
        let next = series(whole, order + 1);
        let rest = next[order as usize + 1] * offset.range().powi(order as i32 + 1);
        sum.widened(rest).or_enclosure(next[0])
    }
}

/// Encloses e^x / i! for i = 0 to n.
fn exponential(x: Interval, n: u32) -> Vec<Interval> {
    over_factorials(n, |_| x.exp())
}

/// Encloses the derivatives of order i = 0 to n, each over i!.
fn over_factorials(n: u32, derivative: impl Fn(u32) -> Interval) -> Vec<Interval> {
    let mut factorial = Interval::ONE;
    let term = |i: u32| {
        if i < 2 {
            return derivative(i);
        }
        factorial *= f64::from(i);
        derivative(i) / factorial
    };
    (0..=n).map(term).collect()
}

/// Encloses ln x for i = 0, then -(-1/x)^i / i for i = 1 to n; x > 0.
fn logarithm(x: Interval, n: u32) -> Vec<Interval> {
    let term = |i: u32| match i {
        0 => x.ln(),
        _ if i % 2 == 1 => x.powi(-(i as i32)) / f64::from(i),
        _ => -x.powi(-(i as i32)) / f64::from(i),
    };
    (0..=n).map(term).collect()
}

/// Encloses C(1/2, i) √x^(1 - 2i) for i = 0 to n; x > 0.
fn square_root(x: Interval, n: u32) -> Vec<Interval> {
    let root = x.sqrt();
    let mut binomial = Interval::ONE;
    let term = |i: u32| {
        if i > 0 {
            binomial = binomial * (1.5 - f64::from(i)) / f64::from(i);
        }
        binomial * root.powi(1 - 2 * i as i32)
    };
    (0..=n).map(term).collect()
}

/// Encloses θ = atan x for i = 0, then cos^i θ sin(i (θ + π/2)) / i for i = 1 to n.
fn arctangent(x: Interval, n: u32) -> Vec<Interval> {
    let angle = x.atan2(Interval::ONE);
    let cos = angle.cos();
    let term = |i: u32| match i {
        0 => angle,
        _ => {
            cos.powi(i as i32) * ((angle + Interval::FRAC_PI_2) * f64::from(i)).sin() / f64::from(i)
        }
    };
    (0..=n).map(term).collect()
}

/// Elementary functions over the box.
///
/// # Guarantee
///
/// Outer. Where a function is not smooth over the range of the operand, the result is an interval
/// alone. This concerns the root and the logarithm at zero, and angles at the cut or the origin.
impl Elementary for TaylorModel {
    fn sqrt(&self) -> Self {
        let values = self.range();
        if values.lo() > 0.0 && self.polynomial.constant_term() > 0.0 {
            self.composed(square_root)
        } else {
            Self::from(values.sqrt())
        }
    }

    fn exp(&self) -> Self {
        self.composed(exponential)
    }

    fn ln(&self) -> Self {
        let values = self.range();
        if values.lo() > 0.0 && self.polynomial.constant_term() > 0.0 {
            self.composed(logarithm)
        } else {
            Self::from(values.ln())
        }
    }

    fn sin_cos(&self) -> (Self, Self) {
        let sine = |quarter_turns: u32| {
            self.composed(|x, n| {
                let (sin, cos) = x.sin_cos();
                over_factorials(n, |i| [sin, cos, -sin, -cos][(i + quarter_turns) as usize % 4])
            })
        };
        (sine(0), sine(1))
    }

    /// Returns the angle φ + atan z.
    ///
    /// φ is within a right angle of all angles of the range, and z is the slope of the point
    /// rotated back by φ. The sum is the angle itself: both differ by a multiple of 2π, and by less
    /// than π.
    fn atan2(&self, x: &Self) -> Self {
        let values = self.range().atan2(x.range());
        let number = self.polynomial.space().is_none() && x.polynomial.space().is_none();
        if number || values.width() > 3.0 {
            return Self::from(values);
        }
        let rotation = values.mid();
        let (sin, cos) = Interval::point(rotation).sin_cos();
        let (sin, cos) = (Self::from(sin), Self::from(cos));
        let along = &(x * &cos) + &(self * &sin);
        let across = &(self * &cos) - &(x * &sin);
        let angle = across.quotient(&along).composed(arctangent);
        (angle + Self::from(rotation)).or_enclosure(values)
    }
}
