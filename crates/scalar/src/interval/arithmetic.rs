//! Sums, differences, products, quotients and their operators.

use core::iter::Sum;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use super::closed::Interval;
use super::ends;
use crate::dispatch::{Dispatch, Kernel, vectorised};
use crate::rounding::{div_down, div_up, mul_down, mul_up};

impl Neg for Interval {
    type Output = Interval;
    /// Returns the set of -x, exactly.
    #[inline]
    fn neg(self) -> Interval {
        Interval { lo: -self.hi, hi: -self.lo }
    }
}

impl Add for Interval {
    type Output = Interval;
    #[inline(always)]
    fn add(self, rhs: Interval) -> Interval {
        ends::sum(self, rhs)
    }
}

impl Sub for Interval {
    type Output = Interval;
    #[inline]
    fn sub(self, rhs: Interval) -> Interval {
        self + -rhs
    }
}

impl Mul for Interval {
    type Output = Interval;
    #[inline(always)]
    fn mul(self, rhs: Interval) -> Interval {
        match ends::product(self, rhs) {
            Some(product) => product,
            None => self.mul_with_zero_or_infinity(rhs),
        }
    }
}

impl Interval {
    /// Encloses the product if an end is zero or infinite, or if a product may underflow.
    pub(super) fn mul_with_zero_or_infinity(self, rhs: Interval) -> Interval {
        // Exact zeros abound in the geometry of robots; 0 · ∞ is left to the general case.
        let zero = |x: Interval| x.lo == 0.0 && x.hi == 0.0;
        let finite = |x: Interval| (x.hi - x.lo) < f64::INFINITY;
        if (zero(self) && finite(rhs)) || (zero(rhs) && finite(self)) {
            return Interval { lo: 0.0, hi: 0.0 };
        }
        // Products of such factors are far from underflow and overflow, so that 0 is exact.
        let is_moderate = |x: f64| x == 0.0 || (1e-140..1e140).contains(&x.abs());
        if [self.lo, self.hi, rhs.lo, rhs.hi].into_iter().all(is_moderate) {
            return ends::product_of_moderate(self, rhs);
        }
        let pairs = [(self.lo, rhs.lo), (self.lo, rhs.hi), (self.hi, rhs.lo), (self.hi, rhs.hi)];
        let lo = pairs.iter().fold(f64::INFINITY, |m, &(a, b)| m.min(mul_down(a, b)));
        let hi = pairs.iter().fold(f64::NEG_INFINITY, |m, &(a, b)| m.max(mul_up(a, b)));
        Interval { lo, hi }
    }

    /// Encloses the quotient by an interval of positive numbers.
    #[inline]
    fn div_by_positive(self, rhs: Interval) -> Interval {
        let lo = div_down(self.lo, if self.lo < 0.0 { rhs.lo } else { rhs.hi });
        let hi = div_up(self.hi, if self.hi < 0.0 { rhs.hi } else { rhs.lo });
        Interval { lo, hi }
    }
}

impl Div for Interval {
    type Output = Interval;
    /// Encloses the quotient; it is [`Interval::ENTIRE`] if the divisor contains zero.
    #[inline]
    fn div(self, rhs: Interval) -> Interval {
        if rhs.lo > 0.0 {
            self.div_by_positive(rhs)
        } else if rhs.hi < 0.0 {
            (-self).div_by_positive(-rhs)
        } else {
            Interval::ENTIRE
        }
    }
}

macro_rules! with_f64_and_assign {
    ($($Op:ident $op:ident $OpAssign:ident $op_assign:ident)*) => {$(
        impl $Op<f64> for Interval {
            type Output = Interval;
            #[inline]
            fn $op(self, rhs: f64) -> Interval {
                self.$op(Interval::point(rhs))
            }
        }
        impl $Op<Interval> for f64 {
            type Output = Interval;
            #[inline]
            fn $op(self, rhs: Interval) -> Interval {
                Interval::point(self).$op(rhs)
            }
        }
        impl $OpAssign for Interval {
            #[inline]
            fn $op_assign(&mut self, rhs: Interval) {
                *self = self.$op(rhs);
            }
        }
        impl $OpAssign<f64> for Interval {
            #[inline]
            fn $op_assign(&mut self, rhs: f64) {
                *self = self.$op(rhs);
            }
        }
    )*};
}
with_f64_and_assign! {
    Add add AddAssign add_assign
    Sub sub SubAssign sub_assign
    Mul mul MulAssign mul_assign
    Div div DivAssign div_assign
}

impl Zero for Interval {
    fn zero() -> Interval {
        Interval::ZERO
    }

    fn is_zero(&self) -> bool {
        *self == Interval::ZERO
    }
}

impl One for Interval {
    fn one() -> Interval {
        Interval::ONE
    }
}

/// On x86-64, kernels over intervals take AVX2 if the processor has it.
impl Dispatch for Interval {
    #[inline(always)]
    fn dispatch<K: Kernel>(kernel: K) -> K::Output {
        vectorised(kernel)
    }
}

impl Sum for Interval {
    fn sum<I: Iterator<Item = Interval>>(terms: I) -> Interval {
        terms.fold(Interval::ZERO, Add::add)
    }
}
