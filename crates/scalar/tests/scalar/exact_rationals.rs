//! Tests of arithmetic against exact rational numbers: enclosure, and distance from the tightest
//! interval in ulps.

use crate::common::*;
use num_rational::BigRational;
use proptest::prelude::*;
use reachtube_scalar::{Interval, rounding::*};

/// Fails unless [down, up] encloses the exact value within `slack` ulps of the tightest interval.
fn assert_bounds(down: f64, up: f64, value: &BigRational, slack: i32) {
    let x = Interval::new(down, up).unwrap_or_else(|| panic!("[{down}, {up}] is not an interval"));
    assert_tight_enclosure(x, value, value, slack);
}

proptest! {
    #![proptest_config(cases(4000))]

    #[test]
    fn rounded_sums((a, b) in any_pair()) {
        assert_bounds(add_down(a, b), add_up(a, b), &(exact(a) + exact(b)), 0);
        assert_bounds(sub_down(a, b), sub_up(a, b), &(exact(a) - exact(b)), 0);
    }

    #[test]
    fn exact_sums_stay_exact((a, b) in any_pair()) {
        let nearest = a + b;
        if nearest.is_finite() && exact(nearest) == exact(a) + exact(b) {
            prop_assert_eq!((add_down(a, b), add_up(a, b)), (nearest, nearest));
        }
    }

    #[test]
    fn rounded_products((a, b) in any_pair()) {
        assert_bounds(mul_down(a, b), mul_up(a, b), &(exact(a) * exact(b)), 1);
    }

    #[test]
    fn rounded_quotients((a, b) in any_pair()) {
        if b != 0.0 {
            assert_bounds(div_down(a, b), div_up(a, b), &(exact(a) / exact(b)), 1);
        }
    }

    #[test]
    fn rounded_roots(x in any_number().prop_map(f64::abs)) {
        let square = |x: f64| exact(x) * exact(x);
        let (down, up) = (sqrt_down(x), sqrt_up(x));
        prop_assert!(square(down) <= exact(x) && square(up) >= exact(x));
        if x > 0.0 {
            prop_assert!(
                square(steps_from(down, 2)) > exact(x) && square(steps_from(up, -2)) < exact(x)
            );
        }
    }

    #[test]
    fn interval_sums(x in any_interval(), y in any_interval()) {
        let ([a, b], [c, d]) = (ends(x), ends(y));
        assert_tight_enclosure(x + y, &(&a + &c), &(&b + &d), 0);
        assert_tight_enclosure(x - y, &(&a - &d), &(&b - &c), 0);
    }

    #[test]
    fn interval_products(x in any_interval(), y in any_interval()) {
        let (x_ends, y_ends) = (ends(x), ends(y));
        let products = x_ends.iter().flat_map(|a| y_ends.iter().map(move |b| a * b));
        let (lo, hi) = range(products);
        assert_tight_enclosure(x * y, &lo, &hi, 1);
    }

    #[test]
    fn interval_quotients(x in any_interval(), y in any_interval()) {
        if y.contains_zero() {
            prop_assert_eq!(x / y, Interval::ENTIRE);
            return Ok(());
        }
        let (x_ends, y_ends) = (ends(x), ends(y));
        let quotients = x_ends.iter().flat_map(|a| y_ends.iter().map(move |b| a / b));
        let (lo, hi) = range(quotients);
        assert_tight_enclosure(x / y, &lo, &hi, 1);
    }

    #[test]
    fn interval_squares(x in any_interval()) {
        let [lo, hi] = ends(x.abs());
        assert_tight_enclosure(x.sqr(), &(&lo * &lo), &(&hi * &hi), 1);
    }

    #[test]
    fn interval_powers(x in any_interval(), n in 3..=12_i32) {
        let base = if n % 2 == 0 { x.abs() } else { x };
        let [lo, hi] = ends(base).map(|a| num_traits::pow(a, n as usize));
        assert_tight_enclosure(x.powi(n), &lo, &hi, 3 * (n - 1));
        if !x.contains_zero() {
            let (lo, hi) = range([lo.recip(), hi.recip()]);
            assert_encloses(x.powi(-n), &lo, &hi);
        }
    }

    #[test]
    fn midpoint_and_radius(x in any_interval()) {
        let (mid, rad) = (x.mid(), x.rad());
        prop_assert!(x.contains(mid));
        prop_assert!(
            exact(mid) - exact(rad) <= exact(x.lo()) && exact(mid) + exact(rad) >= exact(x.hi())
        );
        prop_assert!(
            x.width() == f64::INFINITY || exact(x.width()) >= exact(x.hi()) - exact(x.lo())
        );
        prop_assert!(Interval::centred(mid, rad).encloses(&x));
    }
}

/// The ulp changes at a power of two. This tests products that round to one or beside one, at every
/// magnitude.
#[test]
fn products_beside_every_power_of_two() {
    for exponent in -1080..=1024_i32 {
        let (first, second) = (exponent / 2, exponent - exponent / 2);
        for (n, m) in (-2..=2).flat_map(|n| (-2..=2).map(move |m| (n, m))) {
            let (a, b) = (steps_from(2_f64.powi(first), n), steps_from(-2_f64.powi(second), m));
            let product = exact(a) * exact(b);
            assert_tight_enclosure(Interval::point(a) * Interval::point(b), &product, &product, 1);
        }
    }
}

/// Zeros stay exact, so that sparse matrices keep their zero entries.
#[test]
fn zeros_are_exact() {
    for x in [Interval::PI, -Interval::PI, Interval::new(-1e-310, 1e308).unwrap(), Interval::ENTIRE]
    {
        assert_eq!(x + 0.0, x);
        assert_eq!(x - 0.0, x);
        assert_eq!(x * 0.0, Interval::ZERO);
        assert_eq!(Interval::ZERO / 3.0 * x, Interval::ZERO);
    }
    assert_eq!(Interval::point(0.3) - 0.3, Interval::ZERO);
    assert!((Interval::PI - Interval::PI).width() > 0.0);
}

/// A product that underflows to zero is not zero.
#[test]
fn underflow_is_enclosed_with_its_sign() {
    let tiny = Interval::point(1e-200);
    assert_eq!(tiny * tiny, Interval::new(0.0, 5e-324).unwrap());
    assert_eq!(tiny * -tiny, Interval::new(-5e-324, 0.0).unwrap());
    assert_eq!(tiny / 1e200, Interval::new(0.0, 5e-324).unwrap());
}

#[test]
fn overflow_gives_an_infinite_end_only() {
    let huge = Interval::point(f64::MAX);
    let beyond = Interval::new(f64::MAX, f64::INFINITY).unwrap();
    assert_eq!(huge + huge, beyond);
    assert_eq!(-huge - huge, -beyond);
    assert_eq!(huge * huge, beyond);
    assert_eq!(huge * -huge, -beyond);
    assert_eq!(huge / 0.1, beyond);
    assert_eq!(huge.powi(3), beyond);
}

/// Operations on unbounded operands give the limit sets and no NaN.
#[test]
fn infinite_ends() {
    let inf = f64::INFINITY;
    let interval = |lo, hi| Interval::new(lo, hi).unwrap();
    let above = |lo| interval(lo, inf);
    assert_eq!(Interval::ENTIRE * Interval::ENTIRE, Interval::ENTIRE);
    assert_eq!(Interval::ENTIRE * Interval::ZERO, Interval::ZERO);
    assert_eq!(above(0.0) * interval(0.0, 1.0), above(0.0));
    assert_eq!(interval(-inf, -2.0) * interval(-3.0, 0.0), above(0.0));
    assert_eq!(above(1.0) - above(1.0), Interval::ENTIRE);
    assert!((Interval::ONE / above(1.0)).encloses(&interval(0.0, 1.0)));
    assert!((above(1.0) / above(1.0)).encloses(&above(0.0)));
    assert_eq!((above(0.0).powi(3), Interval::ENTIRE.powi(2)), (above(0.0), above(0.0)));
    assert_eq!(above(0.0).sqrt(), above(0.0));
    assert_eq!((Interval::ENTIRE.mid(), Interval::ENTIRE.rad()), (0.0, inf));
    assert_eq!((above(3.0).mid(), above(3.0).rad()), (f64::MAX, inf));
    assert_eq!(Interval::new(inf, inf), None);
}

/// A bound of an operation with NaN is NaN, in both directions.
#[test]
fn nan_is_never_a_bound() {
    let binary = [add_up, add_down, sub_up, sub_down, mul_up, mul_down, div_up, div_down];
    for f in binary {
        for x in [0.0, -0.0, 1.0, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            assert!(f(f64::NAN, x).is_nan() && f(x, f64::NAN).is_nan(), "{x}");
        }
    }
    let inf = f64::INFINITY;
    assert!(add_up(inf, -inf).is_nan() && sub_down(inf, inf).is_nan() && div_up(inf, inf).is_nan());
    assert!(div_up(-1.0, 0.0).is_nan() && div_down(1.0, 0.0).is_nan() && div_up(0.0, 0.0).is_nan());
    assert!(sqrt_up(-1.0).is_nan() && sqrt_down(-1.0).is_nan() && sqrt_up(f64::NAN).is_nan());
    assert_eq!((mul_up(0.0, inf), mul_down(inf, 0.0)), (0.0, 0.0));
}
