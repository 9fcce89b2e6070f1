//! Time per state of each algorithm over `f64` and over lanes, without sine and cosine unless
//! stated otherwise.
//!
//! The robots `ur5` and `dh6` need the shared oracle files and are skipped without them; `lwa4p` is
//! embedded. Lanes take AVX2 if the processor has it, in a build for every x86-64 too.

#[path = "../tests/dynamics/shared.rs"]
mod shared;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use reachtube_robot::{
    BaseParameters, Parameter, ParameterKind, RegressorWorkspace, Robot, Workspace,
};
use reachtube_scalar::{Lanes, Lanewise};

const ROBOTS: [&str; 3] = ["ur5", "dh6", "lwa4p"];
const STATES: usize = 256;

fn main() {
    divan::main();
}

/// One state per lane: sin, cos, q, q̇, q̈ and torque.
type State<S> = [Vec<S>; 6];

fn states<S: Lanewise>(n: usize) -> Vec<State<S>> {
    // A Weyl sequence is equidistributed and reproducible.
    let mut x = 0.0;
    let mut next = |scale: f64| {
        x = (x + 0.618_033_988_749_894_9) % 1.0;
        scale * (2.0 * x - 1.0)
    };
    let mut row = |scale: f64| (0..n).map(|_| S::from_lanes(|_| next(scale))).collect::<Vec<_>>();
    let state = |_| {
        let q = row(3.1);
        let (sin, cos) = q.iter().map(|q| q.sin_cos()).unzip();
        [sin, cos, q, row(2.0), row(5.0), row(50.0)]
    };
    (0..STATES / S::LANES).map(state).collect()
}

/// Measures calls for one state after another.
fn each<S: Lanewise>(
    bencher: Bencher,
    name: &str,
    mut call: impl FnMut(&Robot, &State<S>, &mut Workspace<S>, &mut [S]),
) {
    let robot = match name {
        "lwa4p" => Robot::lwa4p(),
        _ if std::path::Path::new(shared::FOLDER).exists() => shared::oracle_robot(name),
        _ => return,
    };
    let n = robot.joint_count();
    let (states, mut ws, mut out, mut k) =
        (states(n), Workspace::new(&robot), vec![S::zero(); n * n], 0);
    bencher.counter(ItemsCount::new(S::LANES)).bench_local(|| {
        k = (k + 1) % states.len();
        call(black_box(&robot), &states[k], &mut ws, &mut out);
        black_box(&out);
    });
}

#[divan::bench(types = [f64, Lanes<4>, Lanes<8>], args = ROBOTS)]
fn sin_cos<S: Lanewise>(bencher: Bencher, name: &str) {
    each::<S>(bencher, name, |_, [_, _, q, ..], _, out| {
        for (q, out) in q.iter().zip(out.chunks_exact_mut(2)) {
            (out[0], out[1]) = q.sin_cos();
        }
    });
}

#[divan::bench(types = [f64, Lanes<4>, Lanes<8>], args = ROBOTS)]
fn rnea<S: Lanewise>(bencher: Bencher, name: &str) {
    each::<S>(bencher, name, |robot, [sin, cos, _, qd, qdd, _], ws, out| {
        robot.rnea(sin, cos, qd, qdd, ws, out)
    });
}

#[divan::bench(types = [f64, Lanes<4>, Lanes<8>], args = ROBOTS)]
fn gravity<S: Lanewise>(bencher: Bencher, name: &str) {
    each::<S>(bencher, name, |robot, [sin, cos, ..], ws, out| robot.gravity(sin, cos, ws, out));
}

#[divan::bench(types = [f64, Lanes<4>, Lanes<8>], args = ROBOTS)]
fn crba<S: Lanewise>(bencher: Bencher, name: &str) {
    each::<S>(bencher, name, |robot, [sin, cos, ..], ws, out| robot.crba(sin, cos, ws, out));
}

#[divan::bench(types = [f64, Lanes<4>, Lanes<8>], args = ROBOTS)]
fn aba<S: Lanewise>(bencher: Bencher, name: &str) {
    each::<S>(bencher, name, |robot, [sin, cos, _, qd, _, tau], ws, out| {
        robot.aba(sin, cos, qd, tau, ws, out)
    });
}

#[divan::bench(types = [f64, Lanes<4>, Lanes<8>], args = ROBOTS)]
fn forward_dynamics<S: Lanewise>(bencher: Bencher, name: &str) {
    each::<S>(bencher, name, |robot, [sin, cos, _, qd, _, tau], ws, out| {
        robot.forward_dynamics(sin, cos, qd, tau, ws, out);
    });
}

/// The time includes sine and cosine, as in Pinocchio's `computeJointTorqueRegressor`.
#[divan::bench(types = [f64, Lanes<4>, Lanes<8>], args = ROBOTS)]
fn inertial_regressor<S: Lanewise>(bencher: Bencher, name: &str) {
    let mut scratch: Option<RegressorWorkspace<S>> = None;
    let (mut y, mut sin, mut cos) = (vec![S::zero(); 360], vec![S::zero(); 6], vec![S::zero(); 6]);
    each::<S>(bencher, name, |robot, [_, _, q, qd, qdd, _], _, _| {
        let ws = scratch.get_or_insert_with(|| RegressorWorkspace::new(robot));
        for (i, q) in q.iter().enumerate() {
            (sin[i], cos[i]) = q.sin_cos();
        }
        robot.inertial_regressor(&sin, &cos, qd, qdd, ws, &mut y);
        black_box(&y);
    });
}

/// The base parameters of all inertial parameters and motor inertias, from 200 states.
#[divan::bench(args = ROBOTS)]
fn base_parameters(bencher: Bencher, name: &str) {
    let kinds = [&ParameterKind::INERTIAL[..], &[ParameterKind::MotorInertia]].concat();
    let parameters = Parameter::of_joints(6, &kinds);
    each::<f64>(bencher, name, |robot, _, _, _| {
        black_box(BaseParameters::of_robot(robot, &parameters));
    });
}
