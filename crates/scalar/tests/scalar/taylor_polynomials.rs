//! Tests of truncated polynomials against naive exact rational arithmetic, and by identities of
//! rings and of calculus.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;

use crate::common::*;
use num_rational::BigRational;
use num_traits::{One, Zero};
use proptest::prelude::*;
use reachtube_scalar::{
    Interval, PolynomialMap, Scalar, SineCosine, TaylorPolynomial, TaylorSpace, TaylorTerm,
};

const VARIABLES: usize = 3;
const ORDER: u32 = 4;

/// A naive truncated polynomial: a map from exponents to exact coefficients.
#[derive(Clone, Debug, PartialEq)]
struct Naive(BTreeMap<Vec<u8>, BigRational>);

impl Naive {
    fn number(x: BigRational) -> Self {
        Self([(vec![0; VARIABLES], x)].into())
    }

    fn of<C: Scalar>(p: &TaylorPolynomial<C>, value: impl Fn(&C) -> BigRational) -> Self {
        let padded = |mut exponents: Vec<u8>| {
            exponents.resize(VARIABLES, 0);
            exponents
        };
        Self(p.terms().into_iter().map(|t| (padded(t.exponents), value(&t.coefficient))).collect())
    }

    fn plus(&self, other: &Self, factor: &BigRational) -> Self {
        let mut sum = self.0.clone();
        for (m, c) in &other.0 {
            *sum.entry(m.clone()).or_insert_with(BigRational::zero) += c * factor;
        }
        Self(sum)
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = BTreeMap::new();
        for ((m, a), (n, b)) in self.0.iter().flat_map(|x| other.0.iter().map(move |y| (x, y))) {
            let exponents: Vec<u8> = m.iter().zip(n).map(|(e, f)| e + f).collect();
            if exponents.iter().map(|e| u32::from(*e)).sum::<u32>() <= ORDER {
                *product.entry(exponents).or_insert_with(BigRational::zero) += a * b;
            }
        }
        Self(product)
    }

    fn constant(&self) -> BigRational {
        self.0.get(&vec![0; VARIABLES]).cloned().unwrap_or_else(BigRational::zero)
    }

    /// Returns Σ f_i (self - constant)^i for the coefficients f_i of a series.
    fn composed(&self, series: impl Fn(i64) -> BigRational) -> Self {
        let offset = self.plus(&Self::number(self.constant()), &integer(-1));
        (0..=i64::from(ORDER)).rev().fold(Self(BTreeMap::new()), |sum, i| {
            sum.times(&offset).plus(&Self::number(series(i)), &integer(1))
        })
    }

    fn recip(&self) -> Self {
        let constant = self.constant();
        self.composed(|i| num_traits::pow(-constant.recip(), i as usize) / &constant)
    }
}

fn factorial(i: i64) -> BigRational {
    (1..=i).map(integer).fold(BigRational::one(), |p, k| p * k)
}

fn space() -> Arc<TaylorSpace> {
    TaylorSpace::new(VARIABLES, ORDER).unwrap()
}

/// Fails unless every coefficient of p encloses the exact one and is at most `width` wide.
fn assert_coefficients(p: &TaylorPolynomial<Interval>, reference: &Naive, width: f64) {
    for exponents in reference.0.keys().cloned().chain(p.terms().into_iter().map(|t| t.exponents)) {
        if exponents.is_empty() {
            continue; // the term of a constant, which the reference also has
        }
        let value = reference.0.get(&exponents).cloned().unwrap_or_else(BigRational::zero);
        let coefficient = p.coefficient(&exponents);
        assert_encloses(coefficient, &value, &value);
        assert!(coefficient.width() <= width, "{exponents:?}: {coefficient:?}");
    }
}

/// Generates polynomials with few or many terms and coefficients n/8, every third one in dense
/// form.
fn any_polynomial() -> impl Strategy<Value = TaylorPolynomial<f64>> {
    let exponents = proptest::collection::vec(0..=ORDER as u8, VARIABLES);
    let term = (exponents, -24..=24_i32)
        .prop_map(|(exponents, n)| TaylorTerm { exponents, coefficient: f64::from(n) / 8.0 });
    (proptest::collection::vec(term, 0..60), 0..3).prop_map(|(terms, form)| {
        let space = space();
        let p = TaylorPolynomial::from_terms(&space, terms);
        if form == 0 { densely(&p, &space) } else { p }
    })
}

/// Returns the same polynomial in dense form, by adding a dense zero.
fn densely<C: Scalar>(p: &TaylorPolynomial<C>, space: &Arc<TaylorSpace>) -> TaylorPolynomial<C> {
    let series = (TaylorPolynomial::from(1.0) + TaylorPolynomial::variable(space, 0)).recip();
    p.clone() + (series.clone() - series)
}

/// Returns the polynomial with another constant term.
fn with_constant(p: &TaylorPolynomial<f64>, constant: f64) -> TaylorPolynomial<f64> {
    p.clone() + TaylorPolynomial::from(constant - p.constant_term())
}

fn enclosed(p: &TaylorPolynomial<f64>) -> TaylorPolynomial<Interval> {
    p.map_coefficients(|c| Interval::point(*c))
}

fn naive(p: &TaylorPolynomial<f64>) -> Naive {
    Naive::of(p, |c| exact(*c))
}

fn largest(p: &TaylorPolynomial<f64>) -> f64 {
    p.terms().iter().fold(0.0, |m, t| m.max(t.coefficient.abs()))
}

/// Fails unless all coefficients agree within 1e-12 of the largest.
fn assert_close(a: &TaylorPolynomial<f64>, b: &TaylorPolynomial<f64>) {
    let difference = largest(&(a - b));
    let scale = 1.0 + largest(a).max(largest(b));
    assert!(difference <= 1e-12 * scale, "{difference:e} for {scale:e}\n{a:?}\n{b:?}");
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn arithmetic_of_intervals_encloses_exact_coefficients(
        a in any_polynomial(),
        b in any_polynomial(),
    ) {
        let ((x, y), (p, q)) = ((enclosed(&a), enclosed(&b)), (naive(&a), naive(&b)));
        assert_coefficients(&(&x + &y), &p.plus(&q, &integer(1)), 0.0);
        assert_coefficients(&(&x - &y), &p.plus(&q, &integer(-1)), 0.0);
        assert_coefficients(&(&x * &y), &p.times(&q), 1e-9);
        assert_coefficients(
            &x.scaled(&Interval::point(0.3)),
            &p.times(&Naive::number(exact(0.3))),
            1e-14,
        );
        assert_coefficients(&x.powi(3), &p.times(&p).times(&p), 1e-6);
        for divisor in [with_constant(&b, 3.0), with_constant(&b, -0.5)] {
            let quotient = p.times(&naive(&divisor).recip());
            assert_coefficients(&(&x / &enclosed(&divisor)), &quotient, 1.0);
            // The f64 coefficients agree with the interval coefficients up to rounding.
            let rounded = &a / &divisor;
            let middle = (&x / &enclosed(&divisor)).map_coefficients(|c| c.mid());
            prop_assert!(largest(&(&rounded - &middle)) <= 1e-11 * (1.0 + largest(&middle)));
        }
    }

    /// The coefficients are rational where the value at the constant is.
    #[test]
    fn sine_and_cosine_of_intervals_enclose_exact_coefficients(a in any_polynomial()) {
        let sign = |i: i64| integer(if i % 4 < 2 { 1 } else { -1 });
        let zero = with_constant(&a, 0.0);
        let (sin, cos) = enclosed(&zero).sin_cos();
        let odd = |i: i64| if i % 2 == 1 { sign(i) / factorial(i) } else { BigRational::zero() };
        let even = |i: i64| if i % 2 == 0 { sign(i) / factorial(i) } else { BigRational::zero() };
        assert_coefficients(&sin, &naive(&zero).composed(odd), 1e-6);
        assert_coefficients(&cos, &naive(&zero).composed(even), 1e-6);
    }

    #[test]
    fn ring((a, b, c) in (any_polynomial(), any_polynomial(), any_polynomial())) {
        // With coefficients n/8, sums and products of two polynomials are exact.
        prop_assert_eq!((&a + &b) + c.clone(), &a + &(&b + &c));
        prop_assert_eq!(&a * &b, &b * &a);
        prop_assert_eq!(&a * &(&b + &c), &(&a * &b) + &(&a * &c));
        prop_assert_eq!(&(&a * &b) * &c, &a * &(&b * &c));
        prop_assert_eq!(&a - &b, -(&b - &a));
        prop_assert!((&a - &a).is_zero());
        let mut assigned = a.clone();
        assigned += b.clone();
        assigned -= c.clone();
        assigned *= b.clone();
        prop_assert_eq!(assigned, &(&(&a + &b) - &c) * &b);
    }

    /// A derivative is exact to one order less, so products are compared to that order.
    #[test]
    fn calculus(a in any_polynomial(), b in any_polynomial(), i in 0..VARIABLES) {
        let (product, d) = (&a * &b, |p: &TaylorPolynomial<f64>| p.derivative(i));
        let rule = &(&d(&a) * &b) + &(&a * &d(&b));
        prop_assert_eq!(d(&product).truncated(ORDER - 1), rule.truncated(ORDER - 1));
        let (sin, cos) = with_constant(&a, 0.5).sin_cos();
        assert_close(&d(&sin).truncated(ORDER - 1), &(&cos * &d(&a)).truncated(ORDER - 1));
        prop_assert_eq!(d(&d(&a)), a.derivative(i).derivative(i));
        let j = (i + 1) % VARIABLES;
        prop_assert_eq!(a.derivative(i).derivative(j), a.derivative(j).derivative(i));
    }

    #[test]
    fn quotients_cancel_and_turns_exchange_sine_and_cosine(
        a in any_polynomial(),
        b in any_polynomial(),
        constant in 0.3..2.0_f64,
    ) {
        let a = with_constant(&(a * TaylorPolynomial::from(0.25)), constant);
        let (sin, cos) = a.sin_cos();
        assert_close(&(&(&sin * &sin) + &(&cos * &cos)), &TaylorPolynomial::from(1.0));
        // sin(a + π/2) = cos a and cos(a + π/2) = -sin a.
        let turned = (a.clone() + TaylorPolynomial::from(PI / 2.0)).sin_cos();
        assert_close(&turned.0, &cos);
        assert_close(&turned.1, &-sin.clone());
        assert_close(&(&a * &a.recip()), &TaylorPolynomial::from(1.0));
        assert_close(&(&(&b / &a) * &a), &b);
    }

    #[test]
    fn forms_agree(a in any_polynomial(), b in any_polynomial(), i in 0..VARIABLES) {
        let space = space();
        let dense = densely(&a, &space);
        prop_assert_eq!(&dense, &a);
        prop_assert_eq!(&dense * &b, &a * &b);
        prop_assert_eq!(&b * &dense, &b * &a);
        prop_assert_eq!(&dense - &b, &a - &b);
        prop_assert_eq!(&b - &dense, &b - &a);
        prop_assert_eq!(dense.derivative(i), a.derivative(i));
        prop_assert_eq!(dense.scaled(&0.3), a.scaled(&0.3));
        prop_assert_eq!((dense.degree(), dense.term_count()), (a.degree(), a.term_count()));
        prop_assert_eq!(dense.depends_on(i), a.depends_on(i));
        prop_assert_eq!(TaylorPolynomial::from_terms(&space, dense.terms()), a);
    }

    #[test]
    fn evaluation_and_substitution(
        f in any_polynomial(),
        g in proptest::collection::vec(any_polynomial(), VARIABLES),
        h in proptest::collection::vec(-8..=8_i32, VARIABLES),
    ) {
        let h: Vec<f64> = h.into_iter().map(|n| f64::from(n) / 8.0).collect();
        let at: Vec<BigRational> = h.iter().map(|x| exact(*x)).collect();
        let power = |x: &BigRational, e: u8| num_traits::pow(x.clone(), e.into());
        let term = |(m, c): (&Vec<u8>, &BigRational)| {
            m.iter().zip(&at).fold(c.clone(), |p, (e, x)| p * power(x, *e))
        };
        let reference: BigRational = naive(&f).0.iter().map(term).sum();
        // Coefficients and arguments have few bits, so the evaluation is exact.
        prop_assert_eq!(exact(f.evaluate(&h)), reference.clone());
        let value = f.evaluate(&h.iter().map(|x| Interval::point(*x)).collect::<Vec<_>>());
        assert_encloses(value, &reference, &reference);
        prop_assert_eq!(
            exact(PolynomialMap::new(VARIABLES, &[g[0].clone(), f.clone()]).evaluate(&h)[1]),
            reference.clone()
        );

        // A shift by h and back.
        let back: Vec<f64> = h.iter().map(|x| -x).collect();
        assert_close(&f.shifted(&h).shifted(&back), &f);
        prop_assert_eq!(exact(f.shifted(&h).constant_term()), reference);

        // f(g(h)) for f and g of degree 2 is exact in a space of order 4.
        let f = f.truncated(2);
        let g: Vec<_> = g.iter().map(|g| g.truncated(2)).collect();
        let inner: Vec<f64> = g.iter().map(|g| g.evaluate(&h)).collect();
        let scale = 1.0 + f.evaluate(&inner.iter().map(|x| x.abs()).collect::<Vec<_>>()).abs();
        let composed: TaylorPolynomial<f64> = f.evaluate(&g);
        prop_assert!((composed.evaluate(&h) - f.evaluate(&inner)).abs() <= 1e-9 * scale);
    }

    #[test]
    fn embedding_renames_variables(
        a in any_polynomial(),
        at in proptest::collection::vec(-2.0..2.0_f64, 5),
    ) {
        let wide = TaylorSpace::new(5, 6).unwrap();
        let there = a.embedded(&wide, &[4, 0, 2]);
        let (x, y) = (there.evaluate(&at), a.evaluate(&[at[4], at[0], at[2]]));
        prop_assert!((x - y).abs() <= 1e-9 * (1.0 + y.abs()), "{x} {y}");
    }
}

/// A robot with seven joints needs 28 variables.
#[test]
fn twenty_eight_variables() {
    let space = TaylorSpace::new(28, 15).unwrap();
    let sum = (0..28).fold(TaylorPolynomial::<f64>::zero(), |sum, i| {
        sum + TaylorPolynomial::variable(&space, i)
    });
    let cube = sum.powi(3);
    // The cube has C(30, 3) monomials with the multinomial coefficients 1, 3 and 6.
    assert_eq!(cube.term_count(), 4060);
    assert_eq!(cube.evaluate(&[1.0; 28]), 28f64.powi(3));
    assert_eq!(cube.terms().iter().filter(|t| t.coefficient == 6.0).count(), 28 * 27 * 26 / 6);
    assert_eq!(cube.derivative(27), sum.powi(2).scaled(&3.0));
    let map = PolynomialMap::new(28, &[cube.clone(), sum.clone()]);
    let at: Vec<f64> = (0..28).map(|i| f64::from(i) / 4.0 - 3.0).collect();
    assert_eq!(map.evaluate(&at), [cube.evaluate(&at), sum.evaluate(&at)]);
    assert_eq!(TaylorPolynomial::<f64>::variable(&space, 27).powi(15).degree(), 15);
    assert!(TaylorPolynomial::<f64>::variable(&space, 27).powi(16).is_zero());

    let small = TaylorSpace::new(28, 3).unwrap();
    let one = (0..28).fold(TaylorPolynomial::<f64>::from(1.0), |sum, i| {
        sum + TaylorPolynomial::variable(&small, i)
    });
    // 1 / (1 + s) = 1 - s + s² - s³.
    let inverse = one.recip();
    assert_eq!(inverse.coefficient(&exponents_of(28, &[0, 5, 27])), -6.0);
    assert_eq!(inverse.coefficient(&exponents_of(28, &[3, 3])), 1.0);
    assert_eq!(&inverse * &one, TaylorPolynomial::from(1.0));
}

fn exponents_of(variables: usize, factors: &[usize]) -> Vec<u8> {
    let mut exponents = vec![0; variables];
    factors.iter().for_each(|i| exponents[*i] += 1);
    exponents
}

/// Terms that cancel are not stored.
#[test]
fn structural_zeros_are_kept() {
    let space = space();
    let x = TaylorPolynomial::<Interval>::variable(&space, 0);
    assert!((x.clone() * TaylorPolynomial::zero()).is_zero());
    assert_eq!((x.clone() - x.clone()).term_count(), 0);
    assert_eq!(
        TaylorPolynomial::<f64>::zero().sin_cos(),
        (TaylorPolynomial::zero(), TaylorPolynomial::one())
    );
    assert_eq!((&x * &x).term_count(), 1);
}

#[test]
#[should_panic(expected = "do not mix")]
fn different_spaces_do_not_mix() {
    let other = TaylorSpace::new(2, 4).unwrap();
    let _ = TaylorPolynomial::<f64>::variable(&space(), 0) + TaylorPolynomial::variable(&other, 0);
}
