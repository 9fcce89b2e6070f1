//! Logarithm and angle against the exponential, sine and cosine in exact rational numbers, and as
//! sets.

mod common;

use std::sync::LazyLock;

use common::*;
use num_rational::BigRational;
use num_traits::Signed;
use proptest::prelude::*;
use reachtube_scalar::Interval;

static PI: LazyLock<BigRational> = LazyLock::new(pi);
static LN_2: LazyLock<BigRational> = LazyLock::new(ln_2);

/// Fails unless e^lo ≤ x ≤ e^hi: the logarithm of x is enclosed.
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

/// sin(angle of (x, y) - θ) r = y cos θ - x sin θ, which is not negative as long as θ is below the
/// angle by less than π.
fn turned(y: f64, x: f64, angle: f64) -> BigRational {
    exact(y) * reference_sin(angle, 1, &PI) - exact(x) * reference_sin(angle, 0, &PI)
}

fn assert_angle(y: f64, x: f64) {
    let angle = Interval::point(y).atan2(Interval::point(x));
    let error = reference_error() * (exact(x).abs() + exact(y).abs());
    assert!(turned(y, x, angle.lo()) >= -&error, "angle of ({x}, {y}) is below {angle:?}");
    assert!(turned(y, x, angle.hi()) <= error, "angle of ({x}, {y}) is above {angle:?}");
    // The quadrant: the sign alone could be that of the opposite angle.
    assert!(
        (angle.mid() - y.atan2(x)).abs() < 1e-14 && angle.width() < 4e-15,
        "({x}, {y}): {angle:?}"
    );
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn logarithm(x in prop_oneof![1e-3..1e3_f64, 0.999..1.001_f64, any_number().prop_map(f64::abs)]) {
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
        // Each end is right, but of two near numbers the lower one may have the higher bound.
        let (of_set, of_part) = (x.ln(), part.ln());
        prop_assert!(of_set.lo() <= of_part.hi() && of_part.lo() <= of_set.hi());
        if x.lo() > 0.0 {
            prop_assert!(x.ln().exp().encloses(&x) && x.ln().lo() == Interval::point(x.lo()).ln().lo());
        }
    }

    /// Every point of a box has its angle in the box's, whose ends are those of corners.
    #[test]
    fn angle_of_a_set((y, v) in interval_and_member(), (x, u) in interval_and_member()) {
        prop_assume!((v != 0.0 || u != 0.0) && v.abs() < 1e300 && u.abs() < 1e300);
        let (angle, of_point) = (y.atan2(x), Interval::point(v).atan2(Interval::point(u)));
        prop_assert!(angle.lo() <= of_point.hi() && of_point.lo() <= angle.hi(), "{angle:?} {of_point:?}");
        let crosses = x.lo() < 0.0 && y.lo() < 0.0 && y.hi() >= 0.0 || x.contains_zero() && y.contains_zero();
        let corners = || [x.lo(), x.hi()].into_iter().flat_map(|u| [y.lo(), y.hi()].map(|v| (v + 0.0).atan2(u)));
        if !crosses {
            let most = corners().fold(-4.0, f64::max);
            let least = corners().fold(4.0, f64::min);
            prop_assert!((angle.hi() - most).abs() < 1e-14 && (angle.lo() - least).abs() < 1e-14);
        } else {
            prop_assert_eq!(angle, Interval::new(-Interval::PI.hi(), Interval::PI.hi()).unwrap());
        }
    }
}

#[test]
fn corners_of_the_plane() {
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
