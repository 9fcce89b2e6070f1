//! Sums, and the operators.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use super::TaylorModel;
use super::bounds::inflated;
use crate::Interval;
use crate::rounding::two_sum;

impl TaylorModel {
    /// self ± other in place.
    ///
    /// The rounding error of a sum of two coefficients is known exactly; errors are non-negative numbers that are summed up.
    fn accumulate(&mut self, other: &Self, minus: bool) {
        let (mut errors, mut count) = (0.0, 0);
        let mut add = |a: &f64, b: f64| {
            let (sum, error) = two_sum(*a, b);
            errors += error.abs();
            count += 1;
            sum
        };
        let mut remainder = other.remainder;
        if minus {
            remainder = -remainder;
        }
        self.polynomial.accumulate_by(&other.polynomial, minus, &mut add);
        self.remainder += remainder;
        // NaN where a sum overflowed.
        if errors != 0.0 {
            self.remainder += Interval::centered(0.0, inflated(errors, count));
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
