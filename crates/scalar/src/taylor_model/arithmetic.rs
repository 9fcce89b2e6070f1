//! Sums, and the operators.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use super::TaylorModel;
use super::bounds::{LANES, inflated};
use crate::Interval;
use crate::rounding::two_sum;
use crate::taylor::Addition;

/// Adds, and sums up the rounding errors of the sums, which are known exactly.
#[derive(Default)]
struct Observed {
    errors: [f64; LANES],
    count: usize,
}

impl Addition<f64> for Observed {
    fn sum(&mut self, a: &f64, b: f64) -> f64 {
        let (sum, error) = two_sum(*a, b);
        self.errors[0] += error.abs();
        self.count += 1;
        sum
    }

    fn accumulate(&mut self, a: &mut [f64], b: &[f64], minus: bool) {
        let sign = if minus { -1.0 } else { 1.0 };
        let (a_chunks, a_rest) = a[..b.len()].as_chunks_mut::<LANES>();
        let (b_chunks, b_rest) = b.as_chunks::<LANES>();
        for (a, b) in a_chunks.iter_mut().zip(b_chunks) {
            for ((a, b), errors) in a.iter_mut().zip(b).zip(&mut self.errors) {
                let (sum, error) = two_sum(*a, sign * b);
                *errors += error.abs();
                *a = sum;
            }
        }
        self.count += a_chunks.len();
        a_rest.iter_mut().zip(b_rest).for_each(|(a, b)| *a = self.sum(a, sign * b));
    }
}

impl Observed {
    /// An upper bound of all errors; NaN where a sum overflowed.
    fn total(&self) -> f64 {
        inflated(self.errors.iter().sum(), self.count + LANES)
    }
}

impl TaylorModel {
    /// self ± other in place.
    fn accumulate(&mut self, other: &Self, minus: bool) {
        let mut sums = Observed::default();
        self.polynomial.accumulate_by(&other.polynomial, minus, &mut sums);
        self.remainder += if minus { -other.remainder } else { other.remainder };
        let error = sums.total();
        if error != 0.0 {
            self.remainder += Interval::centered(0.0, error);
        }
        if self.remainder == Interval::ENTIRE {
            *self = Self::unknown();
        }
    }

    fn sum(&self, other: &Self, minus: bool) -> Self {
        let mut sum = self.clone();
        sum.accumulate(other, minus);
        sum
    }
}

impl Neg for TaylorModel {
    type Output = Self;
    fn neg(self) -> Self {
        Self { polynomial: -self.polynomial, remainder: -self.remainder }
    }
}

macro_rules! operations {
    ($($Op:ident $op:ident $OpAssign:ident $op_assign:ident |$a:ident, $b:ident| $value:expr;)*) => {$(
        impl $Op<&TaylorModel> for &TaylorModel {
            type Output = TaylorModel;
            fn $op(self, rhs: &TaylorModel) -> TaylorModel {
                let ($a, $b) = (self, rhs);
                $value
            }
        }
        impl $Op for TaylorModel {
            type Output = TaylorModel;
            fn $op(mut self, rhs: TaylorModel) -> TaylorModel {
                self.$op_assign(rhs);
                self
            }
        }
    )*};
}
operations! {
    Add add AddAssign add_assign |a, b| a.sum(b, false);
    Sub sub SubAssign sub_assign |a, b| a.sum(b, true);
    Mul mul MulAssign mul_assign |a, b| a.product(b);
    Div div DivAssign div_assign |a, b| a.quotient(b);
}

impl AddAssign for TaylorModel {
    fn add_assign(&mut self, rhs: Self) {
        self.accumulate(&rhs, false);
    }
}

impl SubAssign for TaylorModel {
    fn sub_assign(&mut self, rhs: Self) {
        self.accumulate(&rhs, true);
    }
}

impl MulAssign for TaylorModel {
    fn mul_assign(&mut self, rhs: Self) {
        *self = self.product(&rhs);
    }
}

impl DivAssign for TaylorModel {
    /// The remainder is [`Interval::ENTIRE`] where the divisor's range holds zero.
    fn div_assign(&mut self, rhs: Self) {
        *self = self.quotient(&rhs);
    }
}

impl Zero for TaylorModel {
    fn zero() -> Self {
        Self::from(0.0)
    }

    /// Whether the model is the number zero exactly.
    fn is_zero(&self) -> bool {
        self.remainder == Interval::ZERO && self.polynomial.is_zero()
    }
}

impl One for TaylorModel {
    fn one() -> Self {
        Self::from(1.0)
    }
}
