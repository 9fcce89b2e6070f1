//! A number that counts the operations on it.

use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};
use reachtube_scalar::Dispatch;

thread_local! {
    static OPERATIONS: Cell<usize> = const { Cell::new(0) };
}

/// Returns the sums, differences, products and quotients of a computation.
pub fn operations_of(computation: impl FnOnce()) -> usize {
    OPERATIONS.set(0);
    computation();
    OPERATIONS.get()
}

/// A number whose operations are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted(pub f64);

macro_rules! operations {
    ($($name:ident $function:ident $assign:ident $assigned:ident $of:tt;)*) => {$(
        impl $name for Counted {
            type Output = Self;
            fn $function(self, other: Self) -> Self {
                OPERATIONS.set(OPERATIONS.get() + 1);
                Self(self.0 $of other.0)
            }
        }

        impl $assign for Counted {
            fn $assigned(&mut self, other: Self) {
                *self = *self $of other;
            }
        }
    )*};
}

operations! {
    Add add AddAssign add_assign +;
    Sub sub SubAssign sub_assign -;
    Mul mul MulAssign mul_assign *;
    Div div DivAssign div_assign /;
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl From<f64> for Counted {
    fn from(value: f64) -> Self {
        Self(value)
    }
}

impl Zero for Counted {
    fn zero() -> Self {
        Self(0.0)
    }

    fn is_zero(&self) -> bool {
        self.0 == 0.0
    }
}

impl One for Counted {
    fn one() -> Self {
        Self(1.0)
    }
}

impl Dispatch for Counted {}
