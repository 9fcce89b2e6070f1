//! Benchmarks of models of the LWA 4P: their construction, their evaluation compared with the full
//! dynamics (sines and cosines given), and their reachable sets. Run with `cargo bench -p
//! reachtube-abstraction --bench abstraction`.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use reachtube_abstraction::{ExpansionPoint, ModelKind, PolynomialModel};
use reachtube_reach::{
    Flowpipe, FlowpipeSettings, Hyperrectangle, Nonlinear, TimeGrid, UncertainInput,
};
use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::{Lanes, Lanewise, Powers};

fn main() {
    divan::main();
}

fn model(kind: u32, order: u32) -> PolynomialModel {
    let kind = ModelKind::try_from(kind).unwrap();
    PolynomialModel::new(&Robot::lwa4p(), kind, order, &ExpansionPoint::zero(6)).unwrap()
}

/// Builds M_m and c as exact polynomials in (q̇, sin q, cos q).
#[divan::bench(sample_count = 20)]
fn build_mass_matrix_and_coriolis_terms() -> usize {
    let dynamics = Robot::lwa4p().polynomial_dynamics::<f64>().unwrap();
    dynamics.christoffel().iter().flatten().map(|c| c.term_count()).sum()
}

#[divan::bench(args = [(1, 3), (2, 5), (2, 12), (3, 3), (3, 5)], sample_count = 10)]
fn build((kind, order): (u32, u32)) -> PolynomialModel {
    model(kind, order)
}

/// Evaluates models; items are terms, counted once per lane.
#[divan::bench(
    types = [f64, Lanes<8>],
    args = [(1, 1), (1, 3), (2, 3), (2, 5), (2, 7), (2, 12), (3, 3), (3, 5)],
)]
fn evaluate<S: Lanewise + Powers>(bencher: Bencher, (kind, order): (u32, u32)) {
    let model = model(kind, order);
    let x: Vec<S> = model.state(&[0.3; 6], &[0.5; 6]).into_iter().map(S::from).collect();
    let (u, mut ws, mut rate) =
        ([S::from(2.0); 6], model.workspace(), vec![S::zero(); model.states()]);
    bencher.counter(ItemsCount::new(model.term_count() * S::LANES)).bench_local(|| {
        model.rate_into(black_box(&x), black_box(&u), &mut ws, &mut rate);
        black_box(&rate);
    });
}

/// A robot and a state at which its forward dynamics is evaluated.
struct Truth<S> {
    robot: Robot,
    /// sin q, cos q, q̇ (rad/s) and torque (N m), 6 each.
    state: [Vec<S>; 4],
    ws: Workspace<S>,
    qdd: Vec<S>,
}

impl<S: Lanewise> Truth<S> {
    fn new() -> Self {
        let robot = Robot::lwa4p();
        let state = [0.3_f64.sin(), 0.3_f64.cos(), 0.5, 2.0].map(|value| vec![S::from(value); 6]);
        Self { ws: Workspace::new(&robot), robot, state, qdd: vec![S::zero(); 6] }
    }
}

/// Evaluates the forward dynamics by composite bodies, Newton-Euler and a factorisation.
#[divan::bench(types = [f64, Lanes<8>])]
fn forward_dynamics<S: Lanewise>(bencher: Bencher) {
    let mut t = Truth::<S>::new();
    bencher.counter(ItemsCount::new(S::LANES)).bench_local(|| {
        let [sin, cos, qd, tau] = black_box(&t.state);
        t.robot.forward_dynamics(sin, cos, qd, tau, &mut t.ws, &mut t.qdd);
        black_box(&t.qdd);
    });
}

/// Evaluates the forward dynamics by articulated bodies.
#[divan::bench(types = [f64, Lanes<8>])]
fn aba<S: Lanewise>(bencher: Bencher) {
    let mut t = Truth::<S>::new();
    bencher.counter(ItemsCount::new(S::LANES)).bench_local(|| {
        let [sin, cos, qd, tau] = black_box(&t.state);
        t.robot.aba(sin, cos, qd, tau, &mut t.ws, &mut t.qdd);
        black_box(&t.qdd);
    });
}

/// Radii of U, N m: about what the linear model needs for the recordings of the paper.
const INPUT: [f64; 6] = [1.2, 2.2, 2.5, 0.7, 0.16, 0.5];
/// Radii of the initial set, rad and rad/s.
const STATE: [f64; 2] = [0.005, 0.03];

/// Computes the flowpipe of a model from rest at samples of 250 Hz, with all generators; items are
/// the samples that it reached.
#[divan::bench(
    args = [(1, 3, 1251), (2, 5, 1251), (2, 5, 251), (2, 12, 251), (3, 3, 251)],
    sample_count = 10,
)]
fn flowpipe(bencher: Bencher, (kind, order, samples): (u32, u32, usize)) {
    let model = model(kind, order);
    let system = model.polynomial_system().unwrap();
    let radius = [[STATE[0]; 6], [STATE[1]; 6]].concat();
    let initial = Hyperrectangle { centre: vec![0.0; 12], radius };
    let set = Hyperrectangle { centre: vec![0.0; 6], radius: INPUT.to_vec() };
    let (grid, held) = (TimeGrid::uniform(0.004, samples), vec![0.0; 6 * samples]);
    let input = UncertainInput { measured: &held, set: &set };
    let follow = || {
        Flowpipe::new(
            black_box(system),
            &grid,
            &[0.0; 12],
            &initial,
            &input,
            &FlowpipeSettings::default(),
        )
        .unwrap()
    };
    bencher.counter(ItemsCount::new(follow().len())).bench(follow);
}
