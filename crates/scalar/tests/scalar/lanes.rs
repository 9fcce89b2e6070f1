//! Tests of lanes against `f64`, to the last bit.

use std::sync::Arc;

use proptest::prelude::*;
use reachtube_scalar::{
    Lanes, Lanewise, PolynomialMap, Scalar, SineCosine, TaylorPolynomial, TaylorSpace,
};

fn polynomial<S: Scalar>(x: S, y: S) -> S {
    let mut z = (x.clone() + S::from(0.1)) * y.clone() - x.clone() / y.clone();
    z += x.clone();
    z *= y.clone();
    z -= S::one();
    z /= -x + S::zero();
    z
}

proptest! {
    #[test]
    fn each_lane_has_the_bits_of_an_f64(x: [f64; 8], y: [f64; 8]) {
        let bits = |x: [f64; 8]| x.map(|x| if x.is_nan() { u64::MAX } else { x.to_bits() });
        let (a, b) = (Lanes::new(x), Lanes::new(y));
        let alone = core::array::from_fn(|i| polynomial(x[i], y[i]));
        prop_assert_eq!(bits(polynomial(a, b).to_array()), bits(alone));
        prop_assert_eq!(
            bits(a.zip(b, f64::max).to_array()),
            bits(core::array::from_fn(|i| x[i].max(y[i])))
        );
        let (sin, cos) = a.sin_cos();
        prop_assert_eq!(bits(sin.to_array()), bits(x.map(f64::sin)));
        prop_assert_eq!(bits(cos.to_array()), bits(x.map(f64::cos)));
        prop_assert_eq!(bits(core::array::from_fn(|i| a.lane(i))), bits(x));
    }
}

/// Returns x / (2 + Σ aᵢ xᵢ) and its square, dense series without zeros.
fn series<S: Scalar>(space: &Arc<TaylorSpace>, a: &[S]) -> [TaylorPolynomial<S>; 2] {
    let sum = a.iter().enumerate().fold(TaylorPolynomial::from(2.0), |sum, (i, a)| {
        sum + TaylorPolynomial::variable(space, i) * TaylorPolynomial::constant(a.clone())
    });
    let quotient = TaylorPolynomial::variable(space, 0) / sum;
    [&quotient * &quotient, quotient]
}

/// Kernels over lanes may have other instructions than those over `f64`.
#[test]
fn polynomials_over_lanes_have_the_bits_of_those_over_f64() {
    let space = TaylorSpace::new(4, 5).unwrap();
    let a: Vec<Lanes<8>> = (0..4_u32)
        .map(|i| Lanes::from_lanes(|k| 0.1 + 0.3 * (f64::from(i) + 1.7 * k as f64).sin()))
        .collect();
    let together = series(&space, &a);
    let map = PolynomialMap::new(4, &series(&space, &[0.3, -0.2, 0.1, 0.7]));
    let values = map.evaluate(&a);
    for k in 0..8 {
        let alone: Vec<f64> = a.iter().map(|a| a.lane(k)).collect();
        for (together, alone) in together.iter().zip(&series(&space, &alone)) {
            assert_eq!(together.terms().len(), alone.terms().len());
            for (x, y) in together.terms().iter().zip(alone.terms()) {
                assert_eq!(x.exponents, y.exponents);
                assert_eq!(x.coefficient.lane(k).to_bits(), y.coefficient.to_bits());
            }
        }
        for (value, alone) in values.iter().zip(map.evaluate(&alone)) {
            assert_eq!(value.lane(k).to_bits(), alone.to_bits());
        }
    }
}

#[test]
fn zero_is_zero_in_every_lane() {
    use num_traits::{One, Zero};
    assert!(Lanes::<3>::zero().is_zero() && Lanes::new([0.0, -0.0]).is_zero());
    assert!(!Lanes::new([0.0, 1e-300]).is_zero());
    assert_eq!(Lanes::one(), Lanes::new([1.0; 5]));
}

#[test]
#[should_panic(expected = "an f64 has one lane")]
fn an_f64_has_no_second_lane() {
    let _ = 1.0.lane(1);
}
