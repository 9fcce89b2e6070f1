//! Benchmarks of truncated Taylor polynomials: dense products, quotients and sparse products.

use std::sync::Arc;

use divan::{Bencher, black_box, counter::ItemsCount};
use reachtube_scalar::{Interval, Lanes, Lanewise, Scalar, TaylorPolynomial, TaylorSpace};

fn main() {
    divan::main();
}

/// Number of variables and order of each space.
const SPACES: [(usize, u32); 4] = [(6, 6), (12, 4), (24, 3), (24, 4)];

/// Returns the number of coefficient products in a dense product, C(2k + p, p).
fn coefficient_products(variables: usize, order: u32) -> usize {
    (1..=order as usize).fold(1, |c, i| c * (2 * variables + i) / i)
}

/// Returns a dense series without zeros.
fn dense<C: Scalar>(space: &Arc<TaylorSpace>, offset: f64) -> TaylorPolynomial<C> {
    let sum = (0..space.variables()).fold(TaylorPolynomial::<C>::from(2.0 + offset), |sum, i| {
        sum + TaylorPolynomial::variable(space, i) * TaylorPolynomial::from(0.1 + 0.01 * i as f64)
    });
    sum.recip()
}

/// Measures one product, and as many as there are lanes at once; the items are coefficient products
/// of all of them.
#[divan::bench(types = [f64, Lanes<8>], args = SPACES)]
fn product<S: Lanewise>(bencher: Bencher, (variables, order): (usize, u32)) {
    let space = TaylorSpace::new(variables, order).unwrap();
    let (a, b) = (dense::<S>(&space, 0.0), dense::<S>(&space, 0.5));
    let count = ItemsCount::new(S::LANES * coefficient_products(variables, order));
    bencher.counter(count).bench_local(|| black_box(&a) * black_box(&b));
}

#[divan::bench(args = SPACES)]
fn quotient(bencher: Bencher, (variables, order): (usize, u32)) {
    let space = TaylorSpace::new(variables, order).unwrap();
    let (a, b) = (dense::<f64>(&space, 0.0), dense::<f64>(&space, 0.5));
    let count = ItemsCount::new(coefficient_products(variables, order));
    bencher.counter(count).bench(|| black_box(&a) / black_box(&b));
}

#[divan::bench(args = [(6, 6), (12, 4)])]
fn product_of_intervals(bencher: Bencher, (variables, order): (usize, u32)) {
    let space = TaylorSpace::new(variables, order).unwrap();
    let (a, b) = (dense::<Interval>(&space, 0.0), dense::<Interval>(&space, 0.5));
    let count = ItemsCount::new(coefficient_products(variables, order));
    bencher.counter(count).bench(|| black_box(&a) * black_box(&b));
}

/// Computes (1 + Σ x_i)^4 by a sparse product, in a space too large for dense series.
#[divan::bench]
fn sparse_power(bencher: Bencher) {
    let space = TaylorSpace::new(24, 12).unwrap();
    let sum = (0..24).fold(TaylorPolynomial::<f64>::from(1.0), |sum, i| {
        sum + TaylorPolynomial::variable(&space, i)
    });
    let square = &sum * &sum;
    bencher.bench(|| black_box(&square) * black_box(&square));
}
