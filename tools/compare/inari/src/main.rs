//! Prints the least time of one multiply-add of intervals, ns.

use std::hint::black_box;
use std::time::Instant;

use inari::{Interval, interval};

fn main() {
    let number = |k: usize| 0.5 + (k as f64 * 0.618_033_988_749_894_9) % 1.0;
    let vector = |offset: usize| -> Vec<Interval> {
        let near = |x: f64| interval!(x, x + 1e-9).unwrap();
        (0..1024).map(|k| near(number(k + offset))).collect()
    };
    let (x, y) = (vector(0), vector(7));
    let dot = || {
        let (x, y) = (black_box(&x), black_box(&y));
        x.iter().zip(y).fold(interval!(0.0, 0.0).unwrap(), |sum, (x, y)| sum + *x * *y)
    };
    let once = || {
        let begin = Instant::now();
        (0..1000).for_each(|_| _ = black_box(dot()));
        begin.elapsed().as_nanos() as f64 / (1000 * x.len()) as f64
    };
    println!("{}", (0..15).map(|_| once()).fold(f64::INFINITY, f64::min));
}
