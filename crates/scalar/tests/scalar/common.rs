//! Shared by the tests: exact rational numbers, reference functions and strategies for operands.

use num_rational::BigRational;
use num_traits::{FromPrimitive, One, Signed};
use proptest::prelude::*;
use reachtube_scalar::Interval;

/// Returns a configuration with `count` cases and no file of failures.
pub(crate) fn cases(count: u32) -> ProptestConfig {
    ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(count) }
}

/// Converts x exactly; ±∞ becomes ±2¹⁰²⁴, the number after the largest.
pub(crate) fn exact(x: f64) -> BigRational {
    if x.is_infinite() {
        return power_of_two(1024) * BigRational::from_f64(x.signum()).unwrap();
    }
    BigRational::from_float(x).expect("x is not NaN")
}

pub(crate) fn integer(n: i64) -> BigRational {
    BigRational::from_i64(n).unwrap()
}

pub(crate) fn power_of_two(k: i32) -> BigRational {
    num_traits::pow(if k < 0 { integer(2).recip() } else { integer(2) }, k.unsigned_abs() as usize)
}

/// Returns the number `count` steps above x, or below x where `count` is negative.
pub(crate) fn steps_from(x: f64, count: i32) -> f64 {
    (0..count.abs()).fold(x, |x, _| if count > 0 { x.next_up() } else { x.next_down() })
}

/// Fails unless x encloses [lo, hi].
pub(crate) fn assert_encloses(x: Interval, lo: &BigRational, hi: &BigRational) {
    assert!(
        x.lo() == f64::NEG_INFINITY || exact(x.lo()) <= *lo,
        "lower end of {x:?} cuts off {lo}"
    );
    assert!(x.hi() == f64::INFINITY || exact(x.hi()) >= *hi, "upper end of {x:?} cuts off {hi}");
}

/// Fails unless x encloses [lo, hi] and each end is within `slack` ulps of the tightest interval.
pub(crate) fn assert_tight_enclosure(x: Interval, lo: &BigRational, hi: &BigRational, slack: i32) {
    assert_encloses(x, lo, hi);
    let (inner_lo, inner_hi) = (steps_from(x.lo(), slack + 1), steps_from(x.hi(), -slack - 1));
    assert!(
        inner_lo == f64::INFINITY || exact(inner_lo) > *lo,
        "lower end of {x:?} is too wide for {lo}"
    );
    assert!(
        inner_hi == f64::NEG_INFINITY || exact(inner_hi) < *hi,
        "upper end of {x:?} is too wide for {hi}"
    );
}

/// Returns the smallest and the largest of some numbers.
pub(crate) fn range(values: impl IntoIterator<Item = BigRational>) -> (BigRational, BigRational) {
    let values: Vec<_> = values.into_iter().collect();
    (values.iter().min().unwrap().clone(), values.iter().max().unwrap().clone())
}

pub(crate) fn ends(x: Interval) -> [BigRational; 2] {
    [exact(x.lo()), exact(x.hi())]
}

/// Generates finite numbers: any bits, subnormal, huge, near a power of two, integer, moderate,
/// zero.
pub(crate) fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL | proptest::num::f64::ZERO,
        1 => proptest::num::f64::SUBNORMAL,
        1 => (0..1000_i32, any::<bool>())
            .prop_map(|(n, s)| steps_from(f64::MAX, -n) * if s { 1.0 } else { -1.0 }),
        1 => (-1074..1023_i32, -2..=2_i32).prop_map(|(k, n)| steps_from(2_f64.powi(k), n)),
        1 => (-545..-470_i32, -1.0..1.0_f64).prop_map(|(k, m)| m * 2_f64.powi(k)),
        2 => (-50..50_i32).prop_map(f64::from),
        3 => -10.0..10.0_f64,
        1 => Just(0.0),
        1 => Just(-0.0),
    ]
}

/// Generates two numbers, often of nearly equal magnitude, so that their sum cancels.
pub(crate) fn any_pair() -> impl Strategy<Value = (f64, f64)> {
    let nearly_opposite = (any_number(), -3..=3_i32).prop_map(|(a, n)| (a, steps_from(-a, n)));
    let finite = |&(a, b): &(f64, f64)| a.is_finite() && b.is_finite();
    prop_oneof![2 => (any_number(), any_number()), 1 => nearly_opposite]
        .prop_filter("finite", finite)
}

/// Generates bounded intervals: points, narrow and wide ones, with and without zero.
pub(crate) fn any_interval() -> impl Strategy<Value = Interval> {
    let between = |a: f64, b: f64| Interval::new(a.min(b), a.max(b)).unwrap();
    prop_oneof![
        1 => any_number().prop_map(Interval::point),
        1 => (any_number(), 0..5_i32)
            .prop_map(move |(a, n)| between(a, steps_from(a, n).min(f64::MAX))),
        2 => (any_number(), any_number()).prop_map(move |(a, b)| between(a, b)),
        1 => any_number().prop_map(move |a| between(a, 0.0)),
    ]
}

/// Generates an interval and a number in it.
pub(crate) fn interval_and_member() -> impl Strategy<Value = (Interval, f64)> {
    (any_interval(), 0.0..=1.0_f64)
        .prop_map(|(x, t)| (x, (x.lo() * (1.0 - t) + x.hi() * t).clamp(x.lo(), x.hi())))
}

/// Generates an interval and a subset of it.
pub(crate) fn interval_and_part() -> impl Strategy<Value = (Interval, Interval)> {
    (interval_and_member(), 0.0..=1.0_f64).prop_map(|((x, a), t)| {
        let b = (x.lo() * (1.0 - t) + x.hi() * t).clamp(x.lo(), x.hi());
        (x, Interval::new(a.min(b), a.max(b)).unwrap())
    })
}

/// Rounds x down to a multiple of 2^-bits.
pub(crate) fn truncated(x: &BigRational, bits: i32) -> BigRational {
    (x * power_of_two(bits)).floor() * power_of_two(-bits)
}

/// Number of fractional bits of the references below.
pub(crate) const REFERENCE_BITS: i32 = 300;

/// Returns an error bound of the references below: 2³⁰ units of their last bit cover every
/// truncation.
pub(crate) fn reference_error() -> BigRational {
    power_of_two(30 - REFERENCE_BITS)
}

/// Sums 60 terms of a series: term 0 is `first`, and term n is term n - 1 times
/// `factor` / divisor(n).
fn series(first: BigRational, factor: &BigRational, divisor: impl Fn(i64) -> i64) -> BigRational {
    let mut term = first;
    let mut sum = term.clone();
    for n in 1..60 {
        term = truncated(&(term * factor / integer(divisor(n))), REFERENCE_BITS);
        sum += &term;
    }
    sum
}

/// Computes arctan(1/n) by Gregory's series, within 2⁻⁴⁵⁰.
fn arctan_of_inverse(n: i64) -> BigRational {
    let inverse = integer(n).recip();
    let mut power = inverse.clone();
    let mut sum = inverse.clone();
    for k in 1..230 {
        power = truncated(&(-power * &inverse * &inverse), 460);
        sum += truncated(&(&power / integer(2 * k + 1)), 460);
    }
    sum
}

/// Computes π by Machin's formula, within 2⁻⁴⁴⁰.
pub(crate) fn pi() -> BigRational {
    integer(16) * arctan_of_inverse(5) - integer(4) * arctan_of_inverse(239)
}

/// Computes ln 2 = Σ 1 / (k 2ᵏ), within 2⁻⁴⁴⁰.
pub(crate) fn ln_2() -> BigRational {
    (1..460).map(|k| truncated(&(power_of_two(-k) / integer(k.into())), 460)).sum()
}

/// Computes sin(x + quarter_turns · π/2) for |x| ≤ 2²⁰ rad, within [`reference_error`].
pub(crate) fn reference_sin(x: f64, quarter_turns: i64, pi: &BigRational) -> BigRational {
    let half_pi = pi / integer(2);
    let k = (exact(x) / &half_pi).round();
    let rest = truncated(&(exact(x) - &k * half_pi), REFERENCE_BITS);
    let square = truncated(&(-&rest * &rest), REFERENCE_BITS);
    let quadrant = (k.to_integer() + integer(quarter_turns).to_integer()) % integer(4).to_integer();
    let quadrant = (quadrant + integer(4).to_integer()) % integer(4).to_integer();
    let value = if quadrant == integer(0).to_integer() || quadrant == integer(2).to_integer() {
        series(rest, &square, |n| 2 * n * (2 * n + 1))
    } else {
        series(BigRational::one(), &square, |n| 2 * n * (2 * n - 1))
    };
    if quadrant >= integer(2).to_integer() { -value } else { value }
}

/// Returns (m, k) with eˣ = m · 2ᵏ for |x| ≤ 800; m is within [`reference_error`].
pub(crate) fn reference_exp(x: f64, ln_2: &BigRational) -> (BigRational, i32) {
    let k = (x / std::f64::consts::LN_2).round();
    let rest = truncated(&(exact(x) - exact(k) * ln_2), REFERENCE_BITS);
    assert!(rest.abs() < BigRational::one());
    (series(BigRational::one(), &rest, |n| n), k as i32)
}
