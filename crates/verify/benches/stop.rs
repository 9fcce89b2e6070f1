//! Time per stop of the LWA 4P, from one box of states.

use divan::{Bencher, black_box};
use reachtube_reach::Hyperrectangle;
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_verify::{Brakes, Category, Path};

fn main() {
    divan::main();
}

fn bench(bencher: Bencher, category: &Category) {
    let robot = Robot::lwa4p();
    let brakes = Brakes::new(vec![[45.0, 60.0]; 6], [0.01, 0.03]);
    let (q, qd) = ([0.3, 0.8, -0.5, 0.4, 0.9, 0.1], [0.8, -0.6, 0.9, -0.5, 1.0, -1.1]);
    let state: Vec<Interval> = q.iter().chain(&qd).map(|x| Interval::centred(*x, 1e-3)).collect();
    let path = Path::straight(&q, &qd, 1.0);
    bencher.bench(|| {
        category.stop(black_box(&robot), &brakes, (&path, 0.0), black_box(&state)).unwrap()
    });
}

#[divan::bench]
fn category_0(bencher: Bencher) {
    bench(bencher, &Category::Zero);
}

#[divan::bench]
fn category_1(bencher: Bencher) {
    let input_set = Hyperrectangle { centre: vec![0.0; 6], radius: vec![1.0; 6] };
    bench(bencher, &Category::One { limits: vec![4.0; 6], input_set });
}
