//! Sums, and the operators `+`, `-` and `*`.

use core::ops::{Add, AddAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use super::bounds::{PARTIAL_SUMS, inflated};
use super::model::TaylorModel;
use crate::interval::closed::Interval;
use crate::rounding::two_sum;
use crate::taylor::addition::Addition;

/// An addition that also sums the magnitudes of its rounding errors, each of which is computed
/// exactly.
#[derive(Default)]
struct ErrorTracking {
    /// Partial sums of |error|.
    errors: [f64; PARTIAL_SUMS],
    /// Upper bound of the number of additions in each partial sum.
    count: usize,
}

impl Addition<f64> for ErrorTracking {
    fn sum(&mut self, a: &f64, b: f64) -> f64 {
        let (sum, error) = two_sum(*a, b);
        self.errors[0] += error.abs();
        self.count += 1;
        sum
    }

    fn accumulate(&mut self, a: &mut [f64], b: &[f64], minus: bool) {
        let sign = if minus { -1.0 } else { 1.0 };
        let (a_chunks, a_rest) = a[..b.len()].as_chunks_mut::<PARTIAL_SUMS>();
        let (b_chunks, b_rest) = b.as_chunks::<PARTIAL_SUMS>();
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

impl ErrorTracking {
    /// Returns an upper bound of the sum of all errors; NaN if a sum overflowed.
    fn total(&self) -> f64 {
        inflated(self.errors.iter().sum(), self.count + PARTIAL_SUMS)
    }
}

impl TaylorModel {
    /// Adds `other` in place, or subtracts it where `minus`.
    fn accumulate(&mut self, other: &Self, minus: bool) {
        let mut sums = ErrorTracking::default();
        self.polynomial.accumulate_with(&other.polynomial, minus, &mut sums);
        self.remainder += if minus { -other.remainder } else { other.remainder };
        let error = sums.total();
        if error != 0.0 {
            self.remainder += Interval::centred(0.0, error);
        }
        if self.remainder == Interval::ENTIRE {
            *self = Self::entire();
        }
    }

    /// Returns self + other, or self - other where `minus`.
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
    ($(
        $Op:ident $op:ident $OpAssign:ident $op_assign:ident |$a:ident, $b:ident| $value:expr;
    )*) => {$(
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
