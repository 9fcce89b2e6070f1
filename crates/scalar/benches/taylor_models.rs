//! Benchmarks of Taylor models of low order in 18 variables, beside benchmarks of their
//! polynomials.

use divan::{Bencher, black_box};
use reachtube_scalar::{Interval, TaylorBox, TaylorModel, TaylorPolynomial, TaylorSpace};

fn main() {
    divan::main();
}

const VARIABLES: usize = 18;
const ORDERS: [u32; 3] = [1, 2, 3];

/// Returns a model in `used` variables with a remainder. It is a dense series where `used` is the
/// number of all variables, else a list of terms.
fn model(order: u32, used: usize, constant: f64) -> TaylorModel {
    let domain = TaylorBox::new(
        &TaylorSpace::new(VARIABLES, order).unwrap(),
        &[Interval::centred(0.3, 0.1); VARIABLES],
    );
    let number = |x: f64| TaylorModel::from(x);
    let sum = (0..used)
        .fold(number(constant), |sum, i| sum + domain.variable(i) * number(0.1 + 0.01 * i as f64));
    let sum = sum + TaylorModel::from(Interval::centred(0.0, 1e-3));
    if used < VARIABLES {
        return sum;
    }
    let series = &TaylorPolynomial::from(1.0) / sum.polynomial();
    TaylorModel::from(series) + TaylorModel::from(sum.remainder())
}

#[divan::bench(args = ORDERS, consts = [2, VARIABLES])]
fn product<const USED: usize>(bencher: Bencher, order: u32) {
    let (a, b) = (model(order, USED, 2.0), model(order, USED, 3.0));
    bencher.bench(|| black_box(&a) * black_box(&b));
}

#[divan::bench(args = ORDERS, consts = [2, VARIABLES])]
fn product_of_polynomials<const USED: usize>(bencher: Bencher, order: u32) {
    let polynomial =
        |constant| -> TaylorPolynomial { model(order, USED, constant).polynomial().clone() };
    let (a, b) = (polynomial(2.0), polynomial(3.0));
    bencher.bench(|| black_box(&a) * black_box(&b));
}

#[divan::bench(args = ORDERS, consts = [2, VARIABLES])]
fn sum<const USED: usize>(bencher: Bencher, order: u32) {
    let (a, b) = (model(order, USED, 2.0), model(order, USED, 3.0));
    bencher.bench(|| black_box(&a) + black_box(&b));
}

#[divan::bench(args = ORDERS, consts = [2, VARIABLES])]
fn sum_of_polynomials<const USED: usize>(bencher: Bencher, order: u32) {
    let polynomial =
        |constant| -> TaylorPolynomial { model(order, USED, constant).polynomial().clone() };
    let (a, b) = (polynomial(2.0), polynomial(3.0));
    bencher.bench(|| black_box(&a) + black_box(&b));
}

#[divan::bench(args = ORDERS, consts = [2, VARIABLES])]
fn multiple<const USED: usize>(bencher: Bencher, order: u32) {
    let (a, k) = (model(order, USED, 2.0), TaylorModel::from(0.3));
    bencher.bench(|| black_box(&a) * black_box(&k));
}
