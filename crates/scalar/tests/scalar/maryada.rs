//! Tests against an independent interval library, maryada 0.2.
//!
//! It computes + - * / √ exactly and rounds once (its mode "tightest"), exp within 1 ulp, and sin
//! and cos by series with directed rounding.

use crate::common::*;
use maryada::{EnclosureOps, Interval as Other, IntervalOps};
use proptest::prelude::*;
use reachtube_scalar::Interval;

/// Fails unless both enclosures intersect, and each end of ours is at most `slack` ulps outside.
fn assert_agree(name: &str, ours: Interval, other: Other, slack: i32) {
    let (lo, hi) = other.bounds();
    let theirs = Interval::new(lo, hi).unwrap();
    assert!(ours.intersection(theirs).is_some(), "{name}: {ours:?} and {theirs:?} are disjoint");
    assert!(steps_from(ours.lo(), slack) >= lo, "{name}: {ours:?} is too wide for {theirs:?}");
    assert!(steps_from(ours.hi(), -slack) <= hi, "{name}: {ours:?} is too wide for {theirs:?}");
}

fn other(x: Interval) -> Other {
    Other::new(x.lo(), x.hi())
}

proptest! {
    #![proptest_config(cases(4000))]

    /// The ends of maryada are the tightest, so that ours must enclose them.
    #[test]
    fn arithmetic(x in any_interval(), y in any_interval()) {
        let (a, b) = (other(x), other(y));
        let mut cases = vec![("+", x + y, a + b), ("-", x - y, a - b), ("*", x * y, a * b)];
        cases.push(("sqrt", x.abs().sqrt(), other(x.abs()).sqrt()));
        if !y.contains_zero() {
            cases.push(("/", x / y, a / b));
        }
        for (name, ours, tightest) in cases {
            let (lo, hi) = tightest.bounds();
            prop_assert!(ours.lo() <= lo && hi <= ours.hi(), "{} {:?} {:?}", name, ours, tightest);
            assert_agree(name, ours, tightest, 1);
        }
    }

    #[test]
    fn elementary_functions(
        lo in -1e5..1e5_f64,
        width in prop_oneof![Just(0.0), 0.0..1e-9_f64, 0.0..7.0_f64],
    ) {
        let x = Interval::new(lo, lo + width).unwrap();
        assert_agree("sin", x.sin(), other(x).sin(), 1);
        assert_agree("cos", x.cos(), other(x).cos(), 1);
    }

    #[test]
    fn exponential(
        lo in -745.0..709.0_f64,
        width in prop_oneof![Just(0.0), 0.0..1e-9_f64, 0.0..7.0_f64],
    ) {
        let x = Interval::new(lo, lo + width).unwrap();
        assert_agree("exp", x.exp(), other(x).exp(), 1);
    }
}
