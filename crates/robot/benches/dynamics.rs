//! Time of one call of each algorithm over f64; sine and cosine apart.
//!
//! UR5 and the LWA 4P's geometry come from the shared oracle files where those are; `lwa4p` is embedded.

#[path = "../tests/dynamics/shared.rs"]
mod shared;

use divan::{Bencher, black_box};
use reachtube_robot::{Robot, Workspace};

const ROBOTS: [&str; 3] = ["ur5", "dh6", "lwa4p"];
const STATES: usize = 256;

fn main() {
    divan::main();
}

/// One state: sin, cos, q, q̇, q̈ and torque.
type State = [Vec<f64>; 6];

fn states(n: usize) -> Vec<State> {
    // A Weyl sequence: equidistributed and reproducible.
    let mut x = 0.0;
    let mut next = |scale: f64| {
        x = (x + 0.618_033_988_749_894_9) % 1.0;
        scale * (2.0 * x - 1.0)
    };
    let mut row = |scale: f64| (0..n).map(|_| next(scale)).collect::<Vec<_>>();
    let state = |_| {
        let q = row(3.1);
        let (sin, cos) = q.iter().map(|q| q.sin_cos()).unzip();
        [sin, cos, q, row(2.0), row(5.0), row(50.0)]
    };
    (0..STATES).map(state).collect()
}

fn each(bencher: Bencher, name: &str, mut call: impl FnMut(&Robot, &State, &mut Workspace<f64>, &mut [f64])) {
    let robot = if name == "lwa4p" { Some(Robot::lwa4p()) } else { shared::oracle_robot(name) };
    let Some(robot) = robot else { return };
    let n = robot.joint_count();
    let (states, mut ws, mut out, mut k) = (states(n), Workspace::new(&robot), vec![0.0; n * n], 0);
    bencher.bench_local(|| {
        k = (k + 1) % STATES;
        call(black_box(&robot), &states[k], &mut ws, &mut out);
        black_box(&out);
    });
}

#[divan::bench(args = ROBOTS)]
fn sin_cos(bencher: Bencher, name: &str) {
    each(bencher, name, |_, [_, _, q, ..], _, out| {
        for (q, out) in q.iter().zip(out.chunks_exact_mut(2)) {
            (out[0], out[1]) = q.sin_cos();
        }
    });
}

#[divan::bench(args = ROBOTS)]
fn rnea(bencher: Bencher, name: &str) {
    each(bencher, name, |robot, [sin, cos, _, qd, qdd, _], ws, out| robot.rnea(sin, cos, qd, qdd, ws, out));
}

#[divan::bench(args = ROBOTS)]
fn gravity(bencher: Bencher, name: &str) {
    each(bencher, name, |robot, [sin, cos, ..], ws, out| robot.gravity(sin, cos, ws, out));
}

#[divan::bench(args = ROBOTS)]
fn crba(bencher: Bencher, name: &str) {
    each(bencher, name, |robot, [sin, cos, ..], ws, out| robot.crba(sin, cos, ws, out));
}

#[divan::bench(args = ROBOTS)]
fn aba(bencher: Bencher, name: &str) {
    each(bencher, name, |robot, [sin, cos, _, qd, _, tau], ws, out| robot.aba(sin, cos, qd, tau, ws, out));
}

#[divan::bench(args = ROBOTS)]
fn forward_dynamics(bencher: Bencher, name: &str) {
    each(bencher, name, |robot, [sin, cos, _, qd, _, tau], ws, out| {
        robot.forward_dynamics(sin, cos, qd, tau, ws, out);
    });
}
