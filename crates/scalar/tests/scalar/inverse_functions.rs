//! Tests of logarithm and angle against exp, sin and cos in exact rational numbers, and as sets.

use std::sync::LazyLock;

use crate::common::*;
use num_rational::BigRational;
use num_traits::Signed;
use proptest::prelude::*;
use reachtube_scalar::Interval;

static PI: LazyLock<BigRational> = LazyLock::new(pi);
static LN_2: LazyLock<BigRational> = LazyLock::new(ln_2);

/// Fails unless e^lo ≤ x ≤ e^hi, so that [lo, hi] encloses ln x, and [lo, hi] is narrow.
fn assert_ln(x: f64) {
    let ln = Interval::point(x).ln();
    let power = |y: f64, error: BigRational| {
        let (m, k) = reference_exp(y, &LN_2);
        (m + error) * power_of_two(k)
    };
    assert!(power(ln.lo(), -reference_error()) <= exact(x), "ln {x} is below {ln:?}");
    assert!(power(ln.hi(), reference_error()) >= exact(x), "ln {x} is above {ln:?}");
    assert!(ln.width() <= 4e-15 * ln.mag().max(1.0), "ln {x}: {ln:?} is too wide");
}

/// Computes r sin(φ - θ) = y cos θ - x sin θ for the angle φ of (x, y), at distance r from 0.
///
/// It is not negative if θ is below φ by less than π.
fn rotated(y: f64, x: f64, angle: f64) -> BigRational {
    exact(y) * reference_sin(angle, 1, &PI) - exact(x) * reference_sin(angle, 0, &PI)
}

/// Fails unless the angle of (x, y) is enclosed, within 4e-15 rad.
fn assert_angle(y: f64, x: f64) {
    let angle = Interval::point(y).atan2(Interval::point(x));
    let error = reference_error() * (exact(x).abs() + exact(y).abs());
    assert!(rotated(y, x, angle.lo()) >= -&error, "angle of ({x}, {y}) is below {angle:?}");
    assert!(rotated(y, x, angle.hi()) <= error, "angle of ({x}, {y}) is above {angle:?}");
    // The signs above also hold for the opposite angle, so the quadrant is checked as well.
    assert!(
        (angle.mid() - y.atan2(x)).abs() < 1e-14 && angle.width() < 4e-15,
        "({x}, {y}): {angle:?}"
    );
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn logarithm(
        x in prop_oneof![1e-3..1e3_f64, 0.999..1.001_f64, any_number().prop_map(f64::abs)],
    ) {
        prop_assume!(x > 0.0 && x.is_finite());
        assert_ln(x);
    }

    #[test]
    fn angle(y in -2.0..2.0_f64, x in -2.0..2.0_f64, k in -400..400_i32, steep in -60..60_i32) {
        let scale = 2f64.powi(k);
        assert_angle(y * scale, x * scale);
        prop_assume!(x * 2f64.powi(steep) != 0.0);
        assert_angle(y, x * 2f64.powi(steep));
    }

    #[test]
    fn logarithm_of_a_set((x, part) in interval_and_part()) {
        // Each end is a bound, but the lower of two near numbers can have the higher bound.
        let (of_set, of_part) = (x.ln(), part.ln());
        prop_assert!(of_set.lo() <= of_part.hi() && of_part.lo() <= of_set.hi());
        if x.lo() > 0.0 {
            prop_assert!(
                x.ln().exp().encloses(&x) && x.ln().lo() == Interval::point(x.lo()).ln().lo()
            );
        }
    }

    /// The angles of a box contain the angle of each point, and their ends are attained at
    /// vertices.
    #[test]
    fn angle_of_a_set((y, v) in interval_and_member(), (x, u) in interval_and_member()) {
        prop_assume!((v != 0.0 || u != 0.0) && v.abs() < 1e300 && u.abs() < 1e300);
        let (angle, of_point) = (y.atan2(x), Interval::point(v).atan2(Interval::point(u)));
        prop_assert!(
            angle.lo() <= of_point.hi() && of_point.lo() <= angle.hi(),
            "{angle:?} {of_point:?}"
        );
        let crosses =
            x.lo() < 0.0 && y.lo() < 0.0 && y.hi() >= 0.0 || x.contains_zero() && y.contains_zero();
        let vertices = || {
            [x.lo(), x.hi()].into_iter().flat_map(|u| [y.lo(), y.hi()].map(|v| (v + 0.0).atan2(u)))
        };
        if !crosses {
            let highest = vertices().fold(-4.0, f64::max);
            let lowest = vertices().fold(4.0, f64::min);
            prop_assert!(
                (angle.hi() - highest).abs() < 1e-14 && (angle.lo() - lowest).abs() < 1e-14
            );
        } else {
            prop_assert_eq!(angle, Interval::new(-Interval::PI.hi(), Interval::PI.hi()).unwrap());
        }
    }
}

#[test]
fn angles_at_axes_and_extreme_magnitudes() {
    for (y, x) in [
        (0.0, 1.0),
        (1.0, 0.0),
        (-1.0, 0.0),
        (0.0, -1.0),
        (1.0, 1.0),
        (-1.0, -1.0),
        (5e-324, 1.0),
        (1e-300, -1e300),
    ] {
        let angle = Interval::point(y).atan2(Interval::point(x));
        assert!(angle.contains(y.atan2(x)) && angle.width() < 4e-15, "({x}, {y}): {angle:?}");
    }
    for (y, x) in [(1.0, 1e-300), (f64::MAX, f64::MAX), (5e-324, 5e-324), (-3.0, -4.0)] {
        assert_angle(y, x);
    }
    assert!(Interval::ENTIRE.atan2(Interval::ONE).encloses(&Interval::FRAC_PI_2));
}

#[test]
fn ends_of_the_logarithm() {
    for x in [5e-324, f64::MIN_POSITIVE, 1.0, 1f64.next_up(), 1f64.next_down(), f64::MAX] {
        assert_ln(x);
    }
    assert_eq!(Interval::new(-2.0, 0.0).unwrap().ln(), Interval::ENTIRE);
    assert_eq!(Interval::new(0.0, 1.0).unwrap().ln().lo(), f64::NEG_INFINITY);
    assert_eq!(Interval::new(1.0, f64::INFINITY).unwrap().ln().hi(), f64::INFINITY);
}
