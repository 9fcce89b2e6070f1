//! Computations that are compiled for several sets of instructions, one of which is chosen at run
//! time.

use pulp::{Arch, Simd, WithSimd};

/// A computation that a scalar may run with other instructions than the rest of the program.
pub trait Kernel {
    /// The result.
    type Output;

    /// Runs the computation.
    ///
    /// It gains from other instructions only where it and everything that it calls is
    /// `#[inline(always)]`: a function that stays a function of its own has the instructions of
    /// the rest of the program.
    fn run(self) -> Self::Output;
}

/// A type that chooses the instructions of the kernels over it.
///
/// # Guarantee
///
/// The choice does not change a bit of the result: each operation is rounded once, as IEEE 754
/// defines it, with any instructions. A product and a sum are never fused.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::{Dispatch, Kernel, Lanes};
///
/// struct Square<S>(S);
/// impl<S: Copy + core::ops::Mul<Output = S>> Kernel for Square<S> {
///     type Output = S;
///     #[inline(always)]
///     fn run(self) -> S {
///         self.0 * self.0
///     }
/// }
/// let x = Lanes::<4>::from(3.0);
/// assert_eq!(Lanes::<4>::dispatch(Square(x)), Lanes::from(9.0));
/// ```
pub trait Dispatch {
    /// Runs a kernel over this type; by default, with the instructions of the rest of the program.
    #[inline(always)]
    fn dispatch<K: Kernel>(kernel: K) -> K::Output {
        kernel.run()
    }
}

impl Dispatch for f64 {}

/// Runs a kernel with AVX2 if the processor is an x86-64 that has it.
#[inline(always)]
pub(crate) fn vectorised<K: Kernel>(kernel: K) -> K::Output {
    Arch::new().dispatch(Vectorised(kernel))
}

/// A kernel in the form that `pulp` compiles for each set of instructions.
struct Vectorised<K>(K);

impl<K: Kernel> WithSimd for Vectorised<K> {
    type Output = K::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> K::Output {
        self.0.run()
    }
}
