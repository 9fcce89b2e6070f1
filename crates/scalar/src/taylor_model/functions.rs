//! Elementary functions, by Taylor's theorem with Lagrange's remainder.

use super::TaylorModel;
use crate::{Elementary, Interval};

impl TaylorModel {
    /// f(self), where `series(x, n)` encloses f^(i)(ξ) / i! for every ξ of x and i = 0, ..., n.
    ///
    /// With c near the middle of the values a and δ = a - c: f(a) = Σ f^(i)(c)/i! δ^i +
    /// f^(p+1)(ξ)/(p+1)! δ^(p+1), i ≤ p, where ξ is between c and a. The sum is formed by Horner's
    /// rule over models.
    fn composed(&self, series: impl Fn(Interval, u32) -> Vec<Interval>) -> Self {
        let values = |x| Self::from(series(x, 0)[0]);
        let Some(space) = self.polynomial.space() else { return values(self.range()) };
        let (order, center) = (space.order(), self.polynomial.constant_term());
        let whole = self.range().hull(Interval::point(center));
        if whole.mag() == f64::INFINITY || order == 0 {
            return values(whole);
        }
        let offset = self - &Self::from(center);
        let mut sum = Self::from(0.0);
        for coefficient in series(Interval::point(center), order).into_iter().rev() {
            sum = &(&sum * &offset) + &Self::from(coefficient);
        }
        let next = series(whole, order + 1);
        let rest = next[order as usize + 1] * offset.range().powi(order as i32 + 1);
        sum.widened(rest).or_values(next[0])
    }
}

/// e^x / i!.
fn exponential(x: Interval, n: u32) -> Vec<Interval> {
    over_factorials(n, |_| x.exp())
}

/// Derivatives by their order, over its factorial.
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

/// ln x, then -(-1/x)^i / i; x > 0.
fn logarithm(x: Interval, n: u32) -> Vec<Interval> {
    let term = |i: u32| match i {
        0 => x.ln(),
        _ if i % 2 == 1 => x.powi(-(i as i32)) / f64::from(i),
        _ => -x.powi(-(i as i32)) / f64::from(i),
    };
    (0..=n).map(term).collect()
}

/// C(1/2, i) √x^(1 - 2i); x > 0.
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

/// With θ = atan x: θ, then cos^i θ sin(i (θ + π/2)) / i.
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
/// Outer. Where a function is not smooth over the values (a root of zero, a logarithm of zero, an
/// angle at the cut or the origin) the result is the interval of its values.
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
        let sine = |shift: u32| {
            self.composed(|x, n| {
                let (sin, cos) = x.sin_cos();
                over_factorials(n, |i| [sin, cos, -sin, -cos][(i + shift) as usize % 4])
            })
        };
        (sine(0), sine(1))
    }

    /// φ + atan z for a φ within a right angle of all values, where z is the tangent of the angle
    /// that is left after turning back by φ.
    ///
    /// Both sides then differ by a multiple of 2π, and by less than π.
    fn atan2(&self, x: &Self) -> Self {
        let values = self.range().atan2(x.range());
        let number = self.polynomial.space().is_none() && x.polynomial.space().is_none();
        if number || values.width() > 3.0 {
            return Self::from(values);
        }
        let turn = values.mid();
        let (sin, cos) = Interval::point(turn).sin_cos();
        let (sin, cos) = (Self::from(sin), Self::from(cos));
        let along = &(x * &cos) + &(self * &sin);
        let across = &(self * &cos) - &(x * &sin);
        let angle = across.quotient(&along).composed(arctangent);
        (angle + Self::from(turn)).or_values(values)
    }
}
