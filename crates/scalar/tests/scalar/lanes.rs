//! Tests of lanes against `f64`, to the last bit.

use proptest::prelude::*;
use reachtube_scalar::{Elementary, Lanes, Lanewise, Scalar};

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
        prop_assert_eq!(bits(a.sqrt().to_array()), bits(x.map(f64::sqrt)));
        prop_assert_eq!(bits(a.exp().to_array()), bits(x.map(f64::exp)));
        prop_assert_eq!(bits(a.ln().to_array()), bits(x.map(f64::ln)));
        prop_assert_eq!(
            bits(a.atan2(&b).to_array()),
            bits(core::array::from_fn(|i| x[i].atan2(y[i])))
        );
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
