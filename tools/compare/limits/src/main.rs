//! Prints what this machine can do at most, and the operations of the dynamics of six joints, as
//! lines of a name and a number.

mod counted;

use std::hint::black_box;
use std::time::Instant;

use counted::{Counted, operations_of};
use reachtube_robot::{Robot, Workspace};

/// Sums that are independent of each other, so that no product waits for the one before.
const SUMS: usize = 80;

fn main() {
    println!("operations_per_second {:e}", operations_per_second());
    println!("copied_bytes_per_second {:e}", copied_bytes_per_second());
    for (name, count) in dynamics() {
        println!("{name} {count}");
    }
}

/// Returns the least time of `call` among many, s.
fn least(rounds: usize, mut call: impl FnMut()) -> f64 {
    let time = |_| {
        let begin = Instant::now();
        call();
        begin.elapsed().as_secs_f64()
    };
    (0..rounds).map(time).fold(f64::INFINITY, f64::min)
}

/// Returns the operations per second of one core, where a fused product and sum are two.
fn operations_per_second() -> f64 {
    const COUNT: usize = 100_000;
    let (x, y) = (black_box(1.0 - 1e-9), black_box(1e-9));
    let time = least(200, || {
        let mut sums = [0.0f64; SUMS];
        for _ in 0..COUNT {
            sums.iter_mut().for_each(|sum| *sum = sum.mul_add(x, y));
        }
        black_box(sums);
    });
    (2 * SUMS * COUNT) as f64 / time
}

/// Returns the bytes per second that one core copies from memory to memory.
fn copied_bytes_per_second() -> f64 {
    let (from, mut to) = (vec![1u8; 64 << 20], vec![0u8; 64 << 20]);
    let time = least(40, || {
        to.copy_from_slice(black_box(&from));
        black_box(&to);
    });
    from.len() as f64 / time
}

/// Returns the operations of each algorithm for six joints.
fn dynamics() -> [(&'static str, usize); 3] {
    let robot = Robot::lwa4p();
    let vector = |scale: f64| -> Vec<Counted> {
        (0..6).map(|k| Counted(scale * (1.0 + 0.1 * f64::from(k)))).collect()
    };
    let (sin, cos, qd, qdd, tau) =
        (vector(0.3), vector(0.6), vector(0.5), vector(2.0), vector(9.0));
    let (mut ws, mut out) = (Workspace::new(&robot), vec![Counted(0.0); 36]);
    [
        ("rnea", operations_of(|| robot.rnea(&sin, &cos, &qd, &qdd, &mut ws, &mut out[..6]))),
        (
            "forward_dynamics",
            operations_of(|| {
                robot.forward_dynamics(&sin, &cos, &qd, &tau, &mut ws, &mut out[..6]);
            }),
        ),
        ("crba", operations_of(|| robot.crba(&sin, &cos, &mut ws, &mut out))),
    ]
}
