//! Time per motion of the LWA 4P: the swept capsules of 5 s at 250 Hz. Items are steps.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use reachtube_reach::StepBounds;
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_verify::{Body, Capsules};

const STEPS: usize = 1250;

fn main() {
    divan::main();
}

#[divan::bench]
fn swept_capsules(bencher: Bencher) {
    let robot = Robot::lwa4p();
    let body = Body::new(&robot, &Capsules::embedded(&robot).unwrap());
    let side = |k: usize, i: usize| Interval::centred((0.01 * k as f64 + i as f64).sin(), 0.01);
    let boxes = (0..STEPS).flat_map(|k| (0..12).map(move |i| side(k, i))).collect();
    let tube = StepBounds::from_boxes(12, boxes);
    let bencher = bencher.counter(ItemsCount::new(STEPS));
    bencher.bench(|| body.occupancy(black_box(&tube)));
}
