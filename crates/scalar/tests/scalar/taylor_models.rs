//! Tests that every operation of a Taylor model encloses the exact function over its box, with a
//! remainder near the sampled error.

use core::ops::{Add, Mul, Sub};
use std::sync::Arc;

use crate::common::*;
use num_rational::BigRational;
use proptest::prelude::*;
use reachtube_scalar::{Interval, TaylorBox, TaylorModel, TaylorSpace};

/// A type with ring operations.
trait Ring: Clone + From<f64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl Ring for Interval {}
impl Ring for TaylorModel {}

/// A function that can be evaluated over any ring.
trait Function {
    const NAME: &'static str;
    fn at<S: Ring>(x: &[S]) -> S;
}

macro_rules! functions {
    ($($Name:ident |$x:ident| $value:expr;)*) => {
        $(
            struct $Name;
            impl Function for $Name {
                const NAME: &'static str = stringify!($Name);
                fn at<S: Ring>($x: &[S]) -> S {
                    $value
                }
            }
        )*
        /// Calls a generic check for every function.
        macro_rules! for_all_functions {
            ($check:ident($arguments:expr)) => { $($check::<$Name>($arguments);)* };
        }
    };
}

fn sum_of<S: Ring>(x: &[S]) -> S {
    x.iter()
        .enumerate()
        .fold(S::from(0.25), |sum, (i, x)| sum + x.clone() * S::from(0.5 - 0.2 * i as f64))
}

/// A function that is positive over the box: 2 + small linear and quadratic parts.
fn positive<S: Ring>(x: &[S]) -> S {
    S::from(2.0) + x[0].clone() * x[1].clone() * S::from(0.3) - sum_of(x) * S::from(0.2)
}

functions! {
    Sum |x| sum_of(x) + x[1].clone() * x[1].clone();
    Difference |x| x[0].clone() * x[1].clone() - sum_of(x);
    Product |x| positive(x) * sum_of(x) * x[2].clone();
    Cube |x| { let s = sum_of(x); s.clone() * s.clone() * s };
    Power |x| { let s = positive(x); let q = s.clone() * s; q.clone() * q.clone() * q };
}

fn sides(half: f64) -> [Interval; 3] {
    [0.3, -0.6, 0.9].map(|mid| Interval::centred(mid, half))
}

/// Returns points of a box: its vertices, and one van der Corput sequence per variable.
fn points(sides: &[Interval], count: u32) -> Vec<Vec<f64>> {
    let radical = |n: u32, base: u32| {
        let (mut n, mut value, mut unit) = (n, 0.0, 1.0);
        while n > 0 {
            unit /= f64::from(base);
            value += unit * f64::from(n % base);
            n /= base;
        }
        value
    };
    let inside = |side: &Interval, s: f64| {
        (side.lo() + s * (side.hi() - side.lo())).clamp(side.lo(), side.hi())
    };
    let vertices = (0..1u32 << sides.len()).map(|bits| {
        sides
            .iter()
            .enumerate()
            .map(|(i, side)| if bits >> i & 1 == 0 { side.lo() } else { side.hi() })
            .collect()
    });
    let base = [2, 3, 5, 7, 11];
    let sequence = (1..count).map(|n| {
        sides.iter().zip(base).map(|(side, base)| inside(side, radical(n, base))).collect()
    });
    vertices.chain(sequence).collect()
}

/// Returns the model of F, and the largest distance of the sampled values from its polynomial.
///
/// Each sampled value is an enclosure itself, a few roundings wide. The check is that it intersects
/// the enclosure of the model.
fn checked<F: Function>(order: u32, half: f64, count: u32) -> (TaylorModel, f64) {
    let sides = sides(half);
    let domain = TaylorBox::new(&TaylorSpace::new(3, order).unwrap(), &sides);
    let model = F::at(&domain.variables());
    let (name, range) = (F::NAME, model.range());
    let mut largest = 0.0f64;
    for at in points(&sides, count) {
        let at: Vec<Interval> = at.into_iter().map(Interval::point).collect();
        let value = F::at(&at);
        let enclosed = domain.evaluate(&model, &at);
        assert!(
            enclosed.intersection(value).is_some(),
            "{name} at {at:?}: {value:?} is not in {enclosed:?}"
        );
        assert!(
            range.intersection(value).is_some(),
            "{name} at {at:?}: {value:?} is not in {range:?}"
        );
        let polynomial = enclosed.mid() - model.remainder().mid();
        largest = largest.max((value.mid() - polynomial).abs());
    }
    (model, largest)
}

fn encloses_samples<F: Function>((order, half): (u32, f64)) {
    checked::<F>(order, half, 10_000);
}

#[test]
fn models_enclose_the_exact_values() {
    for_all_functions!(encloses_samples((3, 0.2)));
}

/// Fails where the remainder is more than `times` the sampled error. Sampling finds nearly all of
/// the error if truncation dominates it.
fn is_tight<F: Function>((order, half, times): (u32, f64, f64)) {
    let (model, largest) = checked::<F>(order, half, 3_000);
    let remainder = model.remainder().mag();
    assert!(
        remainder <= times * largest,
        "{}: remainder {remainder:e}, sampled error {largest:e}",
        F::NAME
    );
}

#[test]
fn remainders_are_tight() {
    for_all_functions!(is_tight((4, 0.1, 4.0)));
    for_all_functions!(is_tight((6, 0.05, 5.0)));
}

#[test]
fn wide_boxes_and_low_orders_enclose_too() {
    fn encloses<F: Function>((order, half): (u32, f64)) {
        checked::<F>(order, half, 1_000);
    }
    for (order, half) in [(0, 0.1), (1, 0.3), (2, 1.0), (1, 3.0), (9, 0.4)] {
        for_all_functions!(encloses((order, half)));
    }
}

/// Generates models in 3 variables to order 3, sparse and dense, at magnitudes where products
/// underflow or overflow.
fn any_model(space: Arc<TaylorSpace>) -> impl Strategy<Value = TaylorModel> {
    let coefficient =
        prop_oneof![4 => -3.0..3.0_f64, 1 => (-8..8_i32).prop_map(f64::from), 1 => any_number()];
    let term = (0..20usize, coefficient);
    let small = (-1.0..1.0_f64, 0.0..1e-3_f64).prop_map(|(mid, rad)| Interval::centred(mid, rad));
    let remainder = prop_oneof![2 => Just(Interval::ZERO), 1 => any_interval(), 2 => small];
    (proptest::collection::vec(term, 0..20), remainder).prop_map(move |(terms, remainder)| {
        let domain = TaylorBox::new(&space, &[Interval::new(-1.0, 1.0).unwrap(); 3]);
        let t = domain.variables();
        terms.into_iter().fold(TaylorModel::from(remainder), |sum, (index, c)| {
            let monomial = exponents()[index];
            let power =
                |i: usize| (0..monomial[i]).fold(TaylorModel::from(1.0), |p, _| p * t[i].clone());
            sum + power(0) * power(1) * power(2) * TaylorModel::from(c)
        })
    })
}

/// Returns the exponents of the monomials in 3 variables to degree 3.
fn exponents() -> Vec<[u8; 3]> {
    let all = (0..64u8).map(|n| [n & 3, n >> 2 & 3, n >> 4]);
    all.filter(|e| e.iter().sum::<u8>() <= 3).collect()
}

/// Returns the lowest and the highest value of a model at t, in exact rational numbers.
fn exact_values(model: &TaylorModel, t: &[BigRational]) -> [BigRational; 2] {
    let power = |x: &BigRational, e: u8| num_traits::pow(x.clone(), e.into());
    let value: BigRational = model
        .polynomial()
        .terms()
        .iter()
        .map(|term| {
            term.exponents
                .iter()
                .zip(t)
                .fold(exact(term.coefficient), |product, (e, x)| product * power(x, *e))
        })
        .sum();
    ends(model.remainder()).map(|end| &value + end)
}

/// The norms share one entry for all degrees from 31 on, so this tests orders about and above 31.
#[test]
fn high_orders() {
    for order in [30, 31, 32, 61, 62, 70] {
        let domain = TaylorBox::new(
            &TaylorSpace::new(1, order).unwrap(),
            &[Interval::new(-1.0, 1.0).unwrap()],
        );
        let power = |n: u32| (0..n).fold(TaylorModel::from(1.0), |p, _| p * domain.variable(0));
        let (low, high) = (order / 2, order / 2 + 1);
        let kept = power(low) * power(order - low);
        assert!(kept.range().encloses(&Interval::new(0.0, 1.0).unwrap()));
        let cut = (power(high) * power(high)).range();
        assert!(
            cut.encloses(&Interval::new(0.0, 1.0).unwrap()) && (order > 31 || cut.hi() < 1.001),
            "order {order}: {cut:?}"
        );
        let cut = (power(high) * power(order)).range();
        assert!(cut.contains(1.0) && (order > 31 || cut.hi() < 1.001), "order {order}: {cut:?}");
    }
}

proptest! {
    #![proptest_config(cases(400))]

    /// For all values that the operands enclose, the result encloses their sum, difference, product
    /// and quotient in exact rational numbers.
    #[test]
    fn arithmetic_encloses_exact_rationals(
        (a, b) in Just(TaylorSpace::new(3, 3).unwrap())
            .prop_flat_map(|s| (any_model(s.clone()), any_model(s))),
        t in proptest::collection::vec(-8..=8_i64, 3),
    ) {
        let t: Vec<BigRational> = t.into_iter().map(|t| integer(t) / integer(8)).collect();
        let (xs, ys) = (exact_values(&a, &t), exact_values(&b, &t));
        let pairs = || xs.iter().flat_map(|x| ys.iter().map(move |y| (x, y)));
        let check = |name: &str, model: TaylorModel, values: Vec<BigRational>| {
            let [lo, hi] = exact_values(&model, &t);
            let (lo, hi) = (
                unless_infinite(model.remainder().lo(), lo),
                unless_infinite(model.remainder().hi(), hi),
            );
            for value in values {
                assert!(
                    lo.as_ref().is_none_or(|lo| *lo <= value),
                    "{name}: {value} below {model:?}"
                );
                assert!(
                    hi.as_ref().is_none_or(|hi| *hi >= value),
                    "{name}: {value} above {model:?}"
                );
            }
        };
        check("+", &a + &b, pairs().map(|(x, y)| x + y).collect());
        check("-", &a - &b, pairs().map(|(x, y)| x - y).collect());
        check("*", &a * &b, pairs().map(|(x, y)| x * y).collect());
        check("range", TaylorModel::from(a.range()), xs.to_vec());
        check("/ 3", a.divided(3.0), xs.iter().map(|x| x / integer(3)).collect());
        check("/ 1e-300", a.divided(1e-300), xs.iter().map(|x| x / exact(1e-300)).collect());
    }
}

/// Returns the value of a bound, or `None` if the end of the remainder is infinite.
fn unless_infinite(end: f64, value: BigRational) -> Option<BigRational> {
    end.is_finite().then_some(value)
}

#[test]
fn numbers_stay_exact() {
    let space = TaylorSpace::new(2, 3).unwrap();
    let domain = TaylorBox::new(&space, &[Interval::new(1.0, 2.0).unwrap(), Interval::point(0.3)]);
    let x = domain.variable(0);
    assert_eq!((x.remainder(), domain.variable(1)), (Interval::ZERO, TaylorModel::from(0.3)));
    let number = TaylorModel::from;
    assert_eq!(x.clone() + number(0.0), x);
    assert_eq!(x.clone() * number(1.0), x);
    assert_eq!((x.clone() * number(0.0)).range(), Interval::ZERO);
    assert_eq!((x.clone() - x.clone()).range(), Interval::ZERO);
    assert_eq!(
        x.clone() * TaylorModel::from(-4.0),
        -(x.clone() + x.clone() + x.clone() + x.clone())
    );
    assert_eq!(x.divided(0.5), x.clone() + x);
    assert_eq!(TaylorModel::from(Interval::ENTIRE) * number(0.0), number(0.0));
}

/// The truncated part of a square is not negative.
#[test]
fn squares_at_first_order() {
    let space = TaylorSpace::new(4, 1).unwrap();
    let domain = TaylorBox::new(&space, &[Interval::new(-1.0, 1.0).unwrap(); 4]);
    let t = domain.variables();
    let a = t[0].clone() * 0.3.into() - t[1].clone() * 0.2.into() + t[3].clone();
    for (square, largest) in [(&a * &a, 2.25), (&a * &(a.clone() * TaylorModel::from(-7.0)), 15.75)]
    {
        let (values, sign) = (square.remainder(), square.remainder().mid().signum());
        assert!(values.mag() < largest * 1.000001 && values.mag() >= largest);
        assert!((if sign > 0.0 { values.lo() } else { -values.hi() }) > -1e-12, "{values:?}");
    }
    // A product of different variables can have both signs.
    let product = (&t[0] * &t[1]).remainder();
    assert!(product.encloses(&Interval::new(-1.0, 1.0).unwrap()) && product.width() < 2.000001);
}

#[test]
fn operations_without_bounds_give_entire() {
    let space = TaylorSpace::new(1, 4).unwrap();
    let domain = TaylorBox::new(&space, &[Interval::new(-0.5, 1.0).unwrap()]);
    let x = domain.variable(0);
    let entire = TaylorModel::from(Interval::ENTIRE);
    assert_eq!((entire.remainder(), entire.range()), (Interval::ENTIRE, Interval::ENTIRE));
    for model in [
        entire.clone() + x.clone(),
        entire.clone() * x.clone(),
        TaylorModel::from(f64::NAN),
        TaylorModel::from(f64::MAX) * TaylorModel::from(2.0) * x.clone(),
        (x.clone() + TaylorModel::from(f64::MAX)) + TaylorModel::from(f64::MAX),
        x.clone() * TaylorModel::from(1e200) * (x.clone() * TaylorModel::from(1e200)),
    ] {
        assert!(
            model.remainder().mag() == f64::INFINITY && !model.range().width().is_nan(),
            "{model:?}"
        );
        assert!(model.range().contains(1e308) || model.range().contains(-1e308), "{model:?}");
    }
    // The sum of two finite coefficients overflows.
    let pair =
        TaylorBox::new(&TaylorSpace::new(2, 4).unwrap(), &[Interval::centred(0.0, f64::MAX); 2]);
    assert_eq!((pair.variable(0) + pair.variable(1)).range(), Interval::ENTIRE);
    // A model is valid only inside the box.
    assert_eq!(domain.evaluate(&x, &[Interval::point(1.01)]), Interval::ENTIRE);
    assert_eq!(TaylorBox::new(&space, &[Interval::ENTIRE]).variable(0).range(), Interval::ENTIRE);
}
