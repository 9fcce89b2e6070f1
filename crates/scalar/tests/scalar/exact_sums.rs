//! Sums without rounding against exact rational numbers, in any order and grouping.

use crate::common::*;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use proptest::prelude::*;
use reachtube_scalar::ExactSum;

fn total(values: &[f64]) -> BigRational {
    values.iter().fold(BigRational::zero(), |sum, x| sum + exact(*x))
}

/// Fails unless `rounded` is the double nearest to `value`, the even one of two.
fn assert_nearest(rounded: f64, value: &BigRational) {
    if value.is_zero() {
        assert_eq!(rounded, 0.0);
        return;
    }
    assert!(rounded == 0.0 || (rounded > 0.0) == value.is_positive(), "{rounded} for {value}");
    let own = (exact(rounded) - value).abs();
    for other in [rounded.next_up(), rounded.next_down()] {
        if other.is_nan() || rounded.is_infinite() && other.is_infinite() {
            continue;
        }
        let theirs = (exact(other) - value).abs();
        let is_even = rounded.to_bits() & 1 == 0;
        assert!(own < theirs || own == theirs && is_even, "{rounded}, not {other}, for {value}");
    }
}

proptest! {
    #![proptest_config(cases(4000))]

    #[test]
    fn sums_and_means_are_rounded_to_nearest(values in prop::collection::vec(any_number(), 1..12)) {
        let sum: ExactSum = values.iter().copied().collect();
        let (value, count) = (total(&values), integer(values.len() as i64));
        assert_nearest(sum.value(), &value);
        assert_nearest(sum.mean(), &(value / count));
        prop_assert_eq!(sum.count(), values.len() as u64);
    }

    #[test]
    fn neither_order_nor_grouping_is_seen(
        values in prop::collection::vec((any_number(), 0..4usize), 0..40),
        seed in any::<u64>(),
    ) {
        let whole: ExactSum = values.iter().map(|(x, _)| *x).collect();
        let mut parts = vec![ExactSum::default(); 4];
        values.iter().rev().for_each(|(x, part)| parts[*part].add(*x));
        let mut merged = ExactSum::default();
        while !parts.is_empty() {
            let next = parts.swap_remove(seed as usize % parts.len());
            // Through the words that are stored.
            merged.merge(&ExactSum::from_words(&next.to_words()).unwrap());
        }
        prop_assert_eq!(merged.to_words(), whole.to_words());
        prop_assert_eq!(merged, whole);
    }

    #[test]
    fn words_that_no_sum_has_are_refused(words in prop::collection::vec(any::<u64>(), 0..40)) {
        if let Some(sum) = ExactSum::from_words(&words) {
            prop_assert_eq!(sum.to_words(), words);
        }
    }
}

#[test]
fn ties_go_to_even_and_leave_the_range_of_doubles_at_both_ends() {
    let sum = |values: &[f64]| values.iter().copied().collect::<ExactSum>();
    let tiny = f64::from_bits(1);
    assert_eq!(sum(&[tiny, 0.0]).mean(), 0.0);
    assert_eq!(sum(&[tiny, tiny, tiny, 0.0]).mean(), tiny);
    assert_eq!(sum(&[3.0 * tiny, 0.0]).mean(), 2.0 * tiny);
    assert_eq!(sum(&[1.0, f64::EPSILON / 2.0]).value(), 1.0);
    assert_eq!(sum(&[1.0, f64::EPSILON / 2.0, tiny]).value(), 1.0 + f64::EPSILON);
    assert_eq!(sum(&[1.0 + f64::EPSILON, f64::EPSILON / 2.0]).value(), 1.0 + 2.0 * f64::EPSILON);
    let largest = sum(&[f64::MAX; 5]);
    assert_eq!((largest.value(), largest.mean()), (f64::INFINITY, f64::MAX));
    assert_eq!(sum(&[f64::MAX, f64::MAX, -f64::MAX, -f64::MAX, tiny]).value(), tiny);
}

#[test]
fn infinite_summands_and_nan_follow_ieee_754_in_any_order() {
    let infinite = f64::INFINITY;
    for (values, expected) in [
        ([1.0, infinite], infinite),
        ([-infinite, 1.0], -infinite),
        ([infinite, -infinite], f64::NAN),
        ([f64::NAN, infinite], f64::NAN),
    ] {
        for values in [values, [values[1], values[0]]] {
            let sum: ExactSum = values.into_iter().collect();
            assert_eq!(sum.value().to_bits(), expected.to_bits(), "{values:?}");
            assert_eq!(sum.mean().to_bits(), expected.to_bits(), "{values:?}");
        }
    }
    let none = ExactSum::default();
    assert!(none.mean().is_nan() && none.value() == 0.0);
}
