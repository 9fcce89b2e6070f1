//! Benchmarks of proved bounds of models' errors over 0.2 rad, 0.3 rad/s and 2 N m. Run with
//! `cargo bench -p reachtube-abstraction --bench bound`.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use reachtube_abstraction::{ExpansionPoint, ModelKind, OperatingBox, PolynomialModel};
use reachtube_robot::Robot;

fn main() {
    divan::main();
}

const AT: [f64; 6] = [0.3, -0.4, 0.2, -1.6, 0.5, 1.8];

/// Bounds the error of a model of the LWA 4P; items are parts of the box.
#[divan::bench(args = [(1, 1), (2, 3), (3, 2), (3, 3), (3, 4)], sample_count = 3)]
fn bound(bencher: Bencher, (kind, order): (u32, u32)) {
    let kind = ModelKind::try_from(kind).unwrap();
    let point = ExpansionPoint::from_values(&AT, 6).unwrap();
    let model = PolynomialModel::new(&Robot::lwa4p(), kind, order, &point).unwrap();
    let operating_box = OperatingBox::about(&point, &[0.2, 0.3, 2.0]).unwrap();
    let parts = model.default_max_boxes();
    let bounded = || model.bound_remainder(black_box(&operating_box), parts).unwrap();
    bencher.counter(ItemsCount::new(bounded().boxes)).bench(bounded);
}
