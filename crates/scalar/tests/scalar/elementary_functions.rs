//! Tests of exp, sin and cos against exact rational Taylor sums with π and ln 2 to 440 bits.

use std::sync::LazyLock;

use crate::common::*;
use num_rational::BigRational;
use proptest::prelude::*;
use reachtube_scalar::Interval;

static PI: LazyLock<BigRational> = LazyLock::new(pi);
static LN_2: LazyLock<BigRational> = LazyLock::new(ln_2);

/// Largest distance of an end from the tightest interval, in ulps.
const SLACK: i32 = 1;

fn assert_sin_cos(x: f64) {
    let (sin, cos) = Interval::point(x).sin_cos();
    for (value, quarter_turns) in [(sin, 0), (cos, 1)] {
        let reference = reference_sin(x, quarter_turns, &PI);
        let (lo, hi) = (&reference - reference_error(), &reference + reference_error());
        assert_tight_enclosure(value, &lo, &hi, SLACK);
    }
}

fn assert_exp(x: f64) {
    let (m, k) = reference_exp(x, &LN_2);
    let (lo, hi) =
        ((&m - reference_error()) * power_of_two(k), (&m + reference_error()) * power_of_two(k));
    assert_tight_enclosure(Interval::point(x).exp(), &lo, &hi, SLACK);
}

proptest! {
    #![proptest_config(cases(600))]

    #[test]
    fn sine_and_cosine(
        x in prop_oneof![-1e5..1e5_f64, -7.0..7.0_f64, -1048576.0..1048576.0_f64, -1e-3..1e-3_f64],
    ) {
        // Below 1e-40, the reference is not precise enough; see `small_angles`.
        prop_assume!(x.abs() > 1e-40);
        assert_sin_cos(x);
    }

    #[test]
    fn sine_and_cosine_beside_multiples_of_half_pi(
        k in -600_000..600_000_i64,
        steps in -3..=3_i32,
    ) {
        prop_assume!(k != 0);
        assert_sin_cos(steps_from(k as f64 * std::f64::consts::FRAC_PI_2, steps));
    }

    #[test]
    fn exponential(x in prop_oneof![-745.1..709.7_f64, -2.0..2.0_f64, -1e-8..1e-8_f64]) {
        // Only at 0 is the exponential exact, and the reference is not.
        prop_assume!(x != 0.0);
        assert_exp(x);
    }

    /// Subnormal numbers are rounded once more.
    #[test]
    fn exponential_that_is_subnormal(x in -745.1..-708.3_f64) {
        assert_exp(x);
    }

    /// sin x lies strictly between x and x - x³/6, which are equal or neighbours below 2⁻²⁷.
    #[test]
    fn small_angles(
        x in prop_oneof![
            proptest::num::f64::SUBNORMAL,
            (-1074..-27_i32).prop_map(|k| 2_f64.powi(k) * 1.1),
        ],
    ) {
        prop_assume!(x != 0.0);
        let sin = Interval::point(x).sin();
        prop_assert!(sin.contains(x) && sin.mig() < x.abs());
        prop_assert!(steps_from(sin.lo(), 3) >= x && steps_from(sin.hi(), -3) <= x);
    }
}

/// The reduction cancels most at the number nearest to a multiple of π/2, among the numbers rounded
/// from k π/2 with k < 660 000.
#[test]
fn closest_to_multiples_of_half_pi() {
    let half_pi = std::f64::consts::FRAC_PI_2;
    let mut closest = (1.0, 0.0);
    for k in 1..660_000 {
        let x = f64::from(k) * half_pi;
        let small = Interval::point(x).sin().mig().min(Interval::point(x).cos().mig());
        if small > 0.0 && small < closest.0 {
            closest = (small, x);
        }
    }
    assert!(closest.0 < 1e-16, "{closest:?}");
    for steps in -1..=1 {
        assert_sin_cos(steps_from(closest.1, steps));
    }
}

#[test]
fn constants_enclose_pi() {
    let error = power_of_two(-430);
    for (x, factor) in [(Interval::PI, 1), (Interval::TAU, 2)] {
        let value = &*PI * integer(factor);
        assert_tight_enclosure(x, &(&value - &error), &(&value + &error), 0);
    }
    let half = &*PI / integer(2);
    assert_tight_enclosure(Interval::FRAC_PI_2, &(&half - &error), &(&half + &error), 0);
}

#[test]
fn exponential_at_the_ends_of_the_range() {
    let exp = |x| Interval::point(x).exp();
    for x in [709.78, 709.782712893384, -708.3964185322641, -708.4, -740.0, -745.1332191019411] {
        assert_exp(x);
    }
    assert_eq!(exp(709.7827128933841), Interval::new(f64::MAX, f64::INFINITY).unwrap());
    assert_eq!(exp(1e300), Interval::new(f64::MAX, f64::INFINITY).unwrap());
    assert_eq!(exp(-1e300), Interval::new(0.0, 5e-324).unwrap());
    assert_eq!(Interval::ENTIRE.exp(), Interval::new(0.0, f64::INFINITY).unwrap());
    assert_eq!(Interval::ZERO.exp(), Interval::ONE);
}

#[test]
fn sine_and_cosine_of_zero_are_exact() {
    assert_eq!(Interval::ZERO.sin_cos(), (Interval::ZERO, Interval::ONE));
}

#[test]
fn angles_beyond_the_largest_give_the_whole_range() {
    let range = Interval::new(-1.0, 1.0).unwrap();
    for x in [Interval::point(1048576.5), Interval::new(0.0, 1e300).unwrap(), Interval::ENTIRE] {
        assert_eq!(x.sin_cos(), (range, range));
    }
    assert!(Interval::point(1048576.0).sin().width() < 1e-15);
}

/// An extremum beside an end is found on the correct side of it.
#[test]
fn extrema_beside_the_ends() {
    let half_pi = Interval::FRAC_PI_2;
    let before = Interval::new(1.0, half_pi.lo()).unwrap();
    let beyond = Interval::new(1.0, half_pi.hi()).unwrap();
    let after = Interval::new(half_pi.hi(), 2.0).unwrap();
    // π/2 is not an f64. The maximum of the sine and the zero of the cosine lie in `beyond` only.
    assert_eq!(beyond.sin().hi(), 1.0);
    assert!(before.cos().lo() > 0.0 && after.cos().hi() < 0.0 && beyond.cos().contains_zero());
    let turn = Interval::new(-3.0, 4.0).unwrap();
    assert_eq!(
        turn.sin_cos(),
        (Interval::new(-1.0, 1.0).unwrap(), Interval::new(-1.0, 1.0).unwrap())
    );
    let below = Interval::new(3.2, 6.2).unwrap();
    assert!(below.sin().lo() == -1.0 && below.sin().hi() < 0.0);
}
