//! Tests of set properties: inclusion isotonicity, members of the operands, identities of sets.

use crate::common::*;
use proptest::prelude::*;
use reachtube_scalar::Interval;

type Unary = fn(Interval) -> Interval;
type Binary = fn(Interval, Interval) -> Interval;

const UNARY: [(&str, Unary); 12] = [
    ("neg", |x| -x),
    ("abs", Interval::abs),
    ("sqr", Interval::sqr),
    ("sqrt", |x| x.abs().sqrt()),
    ("recip", Interval::recip),
    ("cube", |x| x.powi(3)),
    ("fourth", |x| x.powi(4)),
    ("inverse cube", |x| x.powi(-3)),
    ("exp", Interval::exp),
    ("sin", Interval::sin),
    ("cos", Interval::cos),
    ("times f64", |x| x * -0.1),
];

const BINARY: [(&str, Binary); 7] = [
    ("add", |x, y| x + y),
    ("sub", |x, y| x - y),
    ("mul", |x, y| x * y),
    ("div", |x, y| x / y),
    ("min", Interval::min),
    ("max", Interval::max),
    ("hull", Interval::hull),
];

/// Generates an interval of angles in rad, up to 7 rad wide, and a subset of it.
fn angle_and_part() -> impl Strategy<Value = (Interval, Interval)> {
    (-20.0..20.0_f64, 0.0..7.0_f64, 0.0..=1.0_f64, 0.0..=1.0_f64).prop_map(|(lo, width, s, t)| {
        let whole = Interval::new(lo, lo + width).unwrap();
        let at = |t: f64| (lo + width * t).min(whole.hi());
        (whole, Interval::new(at(s.min(t)), at(s.max(t))).unwrap())
    })
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn unary_operations_are_isotonic(
        (x, part) in prop_oneof![interval_and_part(), angle_and_part()],
    ) {
        for (name, f) in UNARY {
            prop_assert!(
                f(x).encloses(&f(part)),
                "{name}: {:?} does not enclose {:?}",
                f(x),
                f(part)
            );
        }
    }

    #[test]
    fn binary_operations_are_isotonic(
        (x, a) in interval_and_part(),
        (y, b) in interval_and_part(),
    ) {
        for (name, f) in BINARY {
            prop_assert!(
                f(x, y).encloses(&f(a, b)),
                "{name}: {:?} does not enclose {:?}",
                f(x, y),
                f(a, b)
            );
        }
    }

    #[test]
    fn assigning_operators_agree_with_operators(
        x in any_interval(),
        y in any_interval(),
        z in -10.0..10.0_f64,
    ) {
        let mut all = [x; 8];
        all[0] += y;
        all[1] -= y;
        all[2] *= y;
        all[3] /= y;
        all[4] += z;
        all[5] -= z;
        all[6] *= z;
        all[7] /= z;
        let p = Interval::point(z);
        prop_assert_eq!(all, [x + y, x - y, x * y, x / y, x + p, x - p, x * p, x / p]);
        prop_assert_eq!((z + x, z - x, z * x, z / x), (p + x, p - x, p * x, p / x));
    }

    #[test]
    fn members_and_size((x, a) in interval_and_member()) {
        prop_assert!(x.contains(a) && x.mig() <= a.abs() && a.abs() <= x.mag());
        prop_assert_eq!(x.contains_zero(), x.mig() == 0.0);
    }

    #[test]
    fn hull_and_intersection(x in any_interval(), y in any_interval(), a in any_number()) {
        prop_assert!(x.hull(y).encloses(&x) && x.hull(y).encloses(&y));
        let in_both = x.intersection(y).is_some_and(|z| z.contains(a));
        prop_assert_eq!(in_both, x.contains(a) && y.contains(a));
    }

    /// sin² + cos² = 1 holds over any set of angles.
    #[test]
    fn pythagoras((x, part) in angle_and_part()) {
        let (sin, cos) = x.sin_cos();
        prop_assert_eq!((sin, cos), (x.sin(), x.cos()));
        let (sin_part, cos_part) = part.sin_cos();
        prop_assert!((sin_part.sqr() + cos_part.sqr()).contains(1.0));
    }

    /// The hull of many samples is nearly the range: an enclosure that misses an extremum or is too
    /// wide fails.
    #[test]
    fn sine_of_a_set_is_its_hull((x, _) in angle_and_part()) {
        let samples = 400;
        let at = |i: i32| {
            Interval::point((x.lo() + x.width() * f64::from(i) / f64::from(samples)).min(x.hi()))
        };
        for f in [Interval::sin, Interval::cos] {
            let hull = (0..=samples).map(|i| f(at(i))).reduce(Interval::hull).unwrap();
            prop_assert!(f(x).encloses(&hull));
            // Samples at a distance h miss an extremum by at most h²/8.
            let missed = (x.width() / f64::from(samples)).powi(2) / 8.0 + 1e-15;
            prop_assert!(Interval::centred(0.0, missed).contains(f(x).hi() - hull.hi()));
            prop_assert!(Interval::centred(0.0, missed).contains(f(x).lo() - hull.lo()));
        }
    }
}

#[test]
fn sums_and_units() {
    use num_traits::{One, Zero};
    let sum: Interval = [0.1, 0.2, 0.3].map(Interval::from).into_iter().sum();
    assert!(sum.contains(0.6) && sum.width() < 1e-15);
    assert!(Interval::zero().is_zero() && Interval::one() == Interval::ONE);
}
